// SPDX-License-Identifier: BSD-3-Clause
// Frames, conventions and optical elements.
#include "mmbrdf/polarization/mueller.hpp"

#include <pybind11/stl.h>

#include <stdexcept>

#include "bindings.hpp"
#include "mmbrdf/polarization/elements.hpp"

namespace mmbrdf::python {

namespace {

py::object changed_frame(const Given& mueller, const Given& theta_i, const Given& phi_i, const Given& theta_r,
                         const Given& phi_r, const std::string& from, const std::string& to) {
  const Frame before = frame_from(from), after = frame_from(to);
  std::vector<Operand> operands = direction_operands(theta_i, phi_i, theta_r, phi_r);
  operands.push_back({"mueller", mueller, {4, 4}});
  const Broadcast broadcast(operands);
  const std::vector<Geometry> at = without_gil([&] { return geometries(broadcast); });
  return map(broadcast, [&](std::size_t i) { return change_frame(broadcast.mueller(4, i), at[i], before, after); });
}

py::object converted(const Given& mueller, const std::string& from, const std::string& to) {
  const StokesConvention before = convention_from(from), after = convention_from(to);
  return over_matrices(mueller, [&](const Mueller& m) { return convert(m, before, after); });
}

/// f(numbers at one position) → Mueller.
template <class F>
py::object over_numbers(std::vector<Operand> operands, F f) {
  const Broadcast broadcast(std::move(operands));
  return map(broadcast, [&](std::size_t i) { return f(broadcast, i); });
}

void bind_elements(py::module_& m) {
  m.def(
      "rotator",
      [](const Given& angle) {
        return over_numbers({{"angle_deg", angle}},
                            [](const Broadcast& b, std::size_t i) { return rotator(radians(b.number(0, i))); });
      },
      py::arg("angle_deg"),
      "The same light in axes turned by an angle from e1 towards e2: (..., 4, 4). rotator(45) @ [1, 1, 0, 0] is\n"
      "[1, 0, -1, 0].");
  m.def(
      "polarizer",
      [](const Given& azimuth, const Given& extinction) {
        return over_numbers(
            {{"azimuth_deg", azimuth}, {"extinction", extinction}},
            [](const Broadcast& b, std::size_t i) { return polarizer(radians(b.number(0, i)), b.number(1, i)); });
      },
      py::arg("azimuth_deg"), py::arg("extinction") = 0.0,
      "Passes light along the azimuth and the part `extinction` of that across it: (..., 4, 4).");
  m.def(
      "retarder",
      [](const Given& retardance, const Given& azimuth) {
        return over_numbers({{"retardance_deg", retardance}, {"azimuth_deg", azimuth}},
                            [](const Broadcast& b, std::size_t i) {
                              return retarder(radians(b.number(0, i)), radians(b.number(1, i)));
                            });
      },
      py::arg("retardance_deg"), py::arg("azimuth_deg") = 0.0,
      "A lossless retarder, its axis at the azimuth: multiplies the field across the axis by exp(i retardance).");
}

}  // namespace

void bind_mueller(py::module_& m) {
  bind_elements(m);
  m.def("change_frame", changed_frame, py::arg("mueller"), py::arg("theta_i_deg"), py::arg("phi_i_deg"),
        py::arg("theta_r_deg"), py::arg("phi_r_deg"), py::arg("from_frame"), py::arg("to_frame"),
        "The same matrices (..., 4, 4) in another frame: 'xy', 'sp' or 'scattering_plane'. All arguments broadcast.");
  m.def("convert", converted, py::arg("mueller"), py::arg("from_convention"), py::arg("to_convention"),
        "The same matrices as other communities write them: 'germer2017' (s first, S4 = left - right),\n"
        "'s_first_right', 'p_first_left', 'p_first_right', … (docs/conventions.md).");
  m.def(
      "normalized",
      [](const Given& mueller) { return over_matrices(mueller, [](const Mueller& f) { return normalized(f); }); },
      py::arg("mueller"), "M / M11: element 11 is 1. Raises ValueError where M11 is 0, or too small for the others.");
  m.def(
      "exchanged",
      [](const Given& mueller) { return over_matrices(mueller, [](const Mueller& f) { return exchanged(f); }); },
      py::arg("mueller"), "The matrices measured when source and detector change places (Eq. 12).");
  m.def(
      "mirrored",
      [](const Given& mueller) { return over_matrices(mueller, [](const Mueller& f) { return mirrored(f); }); },
      py::arg("mueller"), "Those of the mirror image, at the mirrored geometry.");
}

}  // namespace mmbrdf::python
