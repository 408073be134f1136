// SPDX-License-Identifier: BSD-3-Clause
// Directions that are drawn.
#include "mmbrdf/model/sampling.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "question.hpp"

namespace mmbrdf::python {
namespace {

/// A sampler as Python holds it.
struct SamplerObject {
  SamplerObject(const ModelPointer& its_model, const std::optional<double>& wavelength_nm)
      : model(its_model),
        wavelength(wavelength_nm),
        sampler(prepare(model->model(), model->wavelength(wavelength_nm))) {}
  ModelPointer model;
  std::optional<double> wavelength;  // nm, as it was asked for
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
    const Direction incident = direction_at(broadcast, 0, i);
    const double polar = std::abs(broadcast.number(2, i));
    const bool below = polar > 90 && polar <= 180;
    return o.sampler.pdf(
        incident, below ? Direction{radians(polar), radians(broadcast.number(3, i))} : direction_at(broadcast, 2, i));
  });
}

/// Weights from position `begin` on.
void weigh(const SamplerObject& o, const Broadcast& broadcast, std::size_t begin, Frame frame, std::span<Mueller> out,
           Range& range) {
  std::vector<Geometry> asked(out.size());
  gather(broadcast, 0, begin, begin + out.size(), asked.data());
  range.count(o.sampler.model().wavelength(), asked);
  std::vector<double> pdf(out.size());
  broadcast.gather(4, begin, begin + out.size(), pdf.data());
  std::vector<Direction> incident(out.size());
  std::vector<SampledDirection> drawn(out.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    incident[i] = asked[i].incident;
    drawn[i] = {asked[i].reflected, pdf[i]};
  }
  try {
    o.sampler.weights(incident, drawn, frame, out);
  } catch (const std::invalid_argument&) {  // once more, to find its place
    for (std::size_t i = 0; i < out.size(); ++i) {
      try {
        out[i] = o.sampler.weight(incident[i], drawn[i], frame);
      } catch (const std::invalid_argument& error) {
        throw broadcast.at_place(error, begin + i);
      }
    }
  }
}

py::object weight(const SamplerObject& o, const Given& theta_i, const Given& phi_i, const Given& theta_r,
                  const Given& phi_r, const Given& pdf, const std::string& frame) {
  std::vector<Operand> operands = direction_operands(theta_i, phi_i, theta_r, phi_r);
  operands.push_back({"pdf", pdf});
  const Broadcast broadcast(std::move(operands));
  const Frame in = frame_from(frame);
  auto result = new_array<double>(broadcast, {4, 4});
  auto* const out = reinterpret_cast<Mueller*>(result.mutable_data());  // sixteen doubles each
  Range range(*o.model);
  without_gil([&] {
    in_parts(broadcast.size(), 0, 2048, [&](std::size_t begin, std::size_t end) {
      constexpr std::size_t most = 512;  // stay in the cache
      for (; begin < end; begin += std::min(most, end - begin))
        weigh(o, broadcast, begin, in, {out + begin, std::min(most, end - begin)}, range);
    });
  });
  range.warn(broadcast.size());
  return result;
}

}  // namespace

void bind_sampling(py::module_& m) {
  py::class_<SamplerObject>(m, "DirectionSampler",
                            "Draws scattered directions nearly as often as light goes there, by |f11| cos theta_r, "
                            "from tables that are made once.\n"
                            "Raises ValueError for a model whose f11 is positive nowhere.")
      .def(py::init([](const ModelPointer& model, const std::optional<double>& wavelength_nm) {
             const py::gil_scoped_release release;
             return SamplerObject(model, wavelength_nm);
           }),
           py::arg("model").none(false), py::arg("wavelength_nm") = py::none())
      .def("sample", sample, py::arg("theta_i_deg"), py::arg("phi_i_deg"), py::arg("u1"), py::arg("u2"),
           "SampledDirections(theta_r_deg, phi_r_deg, pdf) of your own numbers u1 and u2 in [0, 1), random or of a "
           "sequence.\n"
           "theta_r_deg rises with u1, phi_r_deg - phi_i_deg from -180 to 180 with u2; pdf is per solid angle, sr^-1.")
      .def("pdf", pdf, py::arg("theta_i_deg"), py::arg("phi_i_deg"), py::arg("theta_r_deg"), py::arg("phi_r_deg"),
           "With which sample() comes upon these directions, sr^-1; 0 below the horizon, 90 < |theta_r_deg| <= 180.")
      .def("weight", weight, py::arg("theta_i_deg"), py::arg("phi_i_deg"), py::arg("theta_r_deg"), py::arg("phi_r_deg"),
           py::arg("pdf"), py::kw_only(), py::arg("frame") = "xy",
           "M cos theta_r / pdf, (..., 4, 4): its mean over uniform u1, u2 is the reflectance, for any Stokes vector.\n"
           "nan in elements that the model does not know: without polarization take [..., 0, 0], which is always "
           "known.\n"
           "Warns (ExtrapolationWarning) as Model.evaluate() does, also of the wavelength.")
      .def(py::pickle([](const SamplerObject& o) { return py::make_tuple(o.model, o.wavelength); },
                      [](const py::tuple& t) {
                        return SamplerObject(t[0].cast<ModelPointer>(), t[1].cast<std::optional<double>>());
                      }));
}

}  // namespace mmbrdf::python
