// SPDX-License-Identifier: BSD-3-Clause
// Directions that are drawn.
#include "mmbrdf/model/sampling.hpp"

#include "bindings.hpp"

namespace mmbrdf::python {
namespace {

/// A sampler as Python holds it.
struct SamplerObject {
  SamplerObject(const ModelObject& model, const std::optional<double>& wavelength_nm)
      : sampler(prepare(model.model(), model.wavelength(wavelength_nm))) {}
  DirectionSampler sampler;
};

Direction direction_at(const Broadcast& broadcast, std::size_t first, std::size_t i) {
  return direction_from_degrees(broadcast.number(first, i), broadcast.number(first + 1, i));
}

py::object sample(const SamplerObject& o, const Given& theta, const Given& phi, const Given& u1, const Given& u2) {
  const Broadcast broadcast({{"theta_i_deg", theta}, {"phi_i_deg", phi}, {"u1", u1}, {"u2", u2}});
  const py::object drawn = map(broadcast, [&](std::size_t i) {
    const SampledDirection one =
        o.sampler.sample(direction_at(broadcast, 0, i), {broadcast.number(2, i), broadcast.number(3, i)});
    return std::array{degrees(one.reflected.theta), degrees(one.reflected.phi), one.pdf};
  });
  const auto column = [&](int c) { return unwrapped(drawn.attr("__getitem__")(py::make_tuple(py::ellipsis(), c))); };
  return record("SampledDirections", column(0), column(1), column(2));
}

py::object pdf(const SamplerObject& o, const Given& theta_i, const Given& phi_i, const Given& theta_r,
               const Given& phi_r) {
  const Broadcast broadcast(direction_operands(theta_i, phi_i, theta_r, phi_r));
  return map(broadcast, [&](std::size_t i) {
    const Geometry asked = geometry(broadcast, 0, i);
    return o.sampler.pdf(asked.incident, asked.reflected);
  });
}

py::object weight(const SamplerObject& o, const Given& theta_i, const Given& phi_i, const Given& theta_r,
                  const Given& phi_r, const Given& pdf, const std::string& frame) {
  std::vector<Operand> operands = direction_operands(theta_i, phi_i, theta_r, phi_r);
  operands.push_back({"pdf", pdf});
  const Broadcast broadcast(std::move(operands));
  const Frame in = frame_from(frame);
  return map(broadcast, [&](std::size_t i) {
    const Geometry asked = geometry(broadcast, 0, i);
    return o.sampler.weight(asked.incident, {asked.reflected, broadcast.number(4, i)}, in);
  });
}

}  // namespace

void bind_sampling(py::module_& m) {
  py::class_<SamplerObject>(m, "DirectionSampler",
                            "Draws scattered directions nearly as often as light goes there, by f11 cos theta_r, from "
                            "tables that are made once.\n"
                            "Raises ValueError for a model whose f11 is positive nowhere.")
      .def(py::init([](const ModelObject& model, const std::optional<double>& wavelength_nm) {
             const py::gil_scoped_release release;
             return SamplerObject(model, wavelength_nm);
           }),
           py::arg("model"), py::arg("wavelength_nm") = py::none())
      .def("sample", sample, py::arg("theta_i_deg"), py::arg("phi_i_deg"), py::arg("u1"), py::arg("u2"),
           "SampledDirections(theta_r_deg, phi_r_deg, pdf) of your own numbers u1 and u2 in [0, 1), random or of a "
           "sequence.\n"
           "theta_r_deg rises with u1, phi_r_deg - phi_i_deg from -180 to 180 with u2; pdf is per solid angle, sr^-1.")
      .def("pdf", pdf, py::arg("theta_i_deg"), py::arg("phi_i_deg"), py::arg("theta_r_deg"), py::arg("phi_r_deg"),
           "With which sample() comes upon these directions, sr^-1.")
      .def("weight", weight, py::arg("theta_i_deg"), py::arg("phi_i_deg"), py::arg("theta_r_deg"), py::arg("phi_r_deg"),
           py::arg("pdf"), py::kw_only(), py::arg("frame") = "xy",
           "M cos theta_r / pdf, (..., 4, 4): its mean over uniform u1, u2 is the reflectance, for any Stokes vector.");
}

}  // namespace mmbrdf::python
