// SPDX-License-Identifier: BSD-3-Clause
// Reflectances, and means over apertures.
#include "mmbrdf/radiometry.hpp"

#include <pybind11/stl.h>

#include "bindings.hpp"
#include "dataset.hpp"
#include "mmbrdf/reflectance_uncertainty.hpp"
#include "mmbrdf/subsets.hpp"

namespace mmbrdf::python {

namespace {

using Wavelength = std::optional<Doubles>;

Operand wavelength_operand(const ModelObject& model, const Wavelength& wavelength_nm) {
  if (wavelength_nm) return {"wavelength_nm", *wavelength_nm};
  Doubles own(std::vector<py::ssize_t>{});
  own.mutable_data()[0] = 1000 * only_wavelength(model.model());
  return {"wavelength_nm", own};
}

/// f(wavelength in micrometres, direction, Stokes vector) over arrays.
template <class F>
py::object over_directions(const ModelObject& model, const Wavelength& nm, const char* theta_name, const Doubles& theta,
                           const Doubles& phi, const std::optional<Doubles>& stokes, F f) {
  std::vector<Operand> operands{wavelength_operand(model, nm), {theta_name, theta}, {"phi", phi}};
  if (stokes) operands.push_back({"stokes", *stokes, {4}});
  const Broadcast broadcast(operands);
  return map(broadcast, [&](std::size_t i) {
    const Direction direction = direction_from_degrees(broadcast.number(1, i), broadcast.number(2, i));
    const Stokes light = stokes ? broadcast.at<4>(3, i) : Stokes{1, 0, 0, 0};
    return f(micrometres(broadcast.number(0, i)), direction, light);
  });
}

/// f(wavelength in micrometres) over an array of wavelengths.
template <class F>
py::object over_wavelengths(const ModelObject& model, const Wavelength& nm, F f) {
  const Broadcast broadcast({wavelength_operand(model, nm)});
  return map(broadcast, [&](std::size_t i) { return f(micrometres(broadcast.number(0, i))); });
}

void bind_directional_hemispherical(py::module_& m) {
  m.def(
      "directional_hemispherical_reflectance",
      [](const ModelObject& o, const Wavelength& nm, const Doubles& theta, const Doubles& phi,
         const std::optional<Doubles>& stokes) {
        return over_directions(o, nm, "theta_i_deg", theta, phi, stokes,
                               [&](double wavelength, const Direction& incident, const Stokes& light) {
                                 return stokes ? directional_hemispherical_reflectance(o.model(), wavelength, incident,
                                                                                       light)
                                               : directional_hemispherical_reflectance(o.model(), wavelength, incident);
                               });
      },
      py::arg("model"), py::arg("wavelength_nm") = py::none(), py::arg("theta_i_deg") = 0.0, py::arg("phi_i_deg") = 0.0,
      py::arg("stokes") = py::none(),
      "Reflected per incident flux, over the whole hemisphere, for unpolarized light or incident light `stokes`\n"
      "(..., 4) in the sp frame. All arguments broadcast.");
  m.def(
      "directional_hemispherical_uncertainty",
      [](const ModelObject& o, const Wavelength& nm, const Doubles& theta, const Doubles& phi,
         const std::optional<Doubles>& stokes) {
        return over_directions(o, nm, "theta_i_deg", theta, phi, stokes,
                               [&](double wavelength, const Direction& incident, const Stokes& light) {
                                 const PreparedUncertainty u = prepare_uncertainty(o.model(), wavelength);
                                 return directional_hemispherical_uncertainty(o.model(), u, incident, light);
                               });
      },
      py::arg("model"), py::arg("wavelength_nm") = py::none(), py::arg("theta_i_deg") = 0.0, py::arg("phi_i_deg") = 0.0,
      py::arg("stokes") = py::none(), "Its standard uncertainty, of the fit alone.");
}

void bind_hemispherical_directional(py::module_& m) {
  m.def(
      "hemispherical_directional_reflectance",
      [](const ModelObject& o, const Wavelength& nm, const Doubles& theta, const Doubles& phi,
         const std::optional<Doubles>& analyzer) {
        return over_directions(
            o, nm, "theta_r_deg", theta, phi, analyzer,
            [&](double wavelength, const Direction& reflected, const Stokes& passed) {
              return analyzer ? hemispherical_directional_reflectance(o.model(), wavelength, reflected, passed)
                              : hemispherical_directional_reflectance(o.model(), wavelength, reflected);
            });
      },
      py::arg("model"), py::arg("wavelength_nm") = py::none(), py::arg("theta_r_deg") = 0.0, py::arg("phi_r_deg") = 0.0,
      py::arg("analyzer") = py::none(),
      "Radiance into a direction under uniform unpolarized illumination, per that of the perfect diffuser; seen "
      "through\n"
      "an analyzer that passes the light `analyzer` (..., 4), in the sp frame.");
  m.def(
      "hemispherical_directional_uncertainty",
      [](const ModelObject& o, const Wavelength& nm, const Doubles& theta, const Doubles& phi,
         const std::optional<Doubles>& analyzer) {
        return over_directions(o, nm, "theta_r_deg", theta, phi, analyzer,
                               [&](double wavelength, const Direction& reflected, const Stokes& passed) {
                                 const PreparedUncertainty u = prepare_uncertainty(o.model(), wavelength);
                                 return hemispherical_directional_uncertainty(o.model(), u, reflected, passed);
                               });
      },
      py::arg("model"), py::arg("wavelength_nm") = py::none(), py::arg("theta_r_deg") = 0.0, py::arg("phi_r_deg") = 0.0,
      py::arg("analyzer") = py::none(), "Its standard uncertainty, of the fit alone.");
}

void bind_bihemispherical(py::module_& m) {
  m.def(
      "bihemispherical_reflectance",
      [](const ModelObject& o, const Wavelength& nm) {
        return over_wavelengths(o, nm, [&](double w) { return bihemispherical_reflectance(o.model(), w); });
      },
      py::arg("model"), py::arg("wavelength_nm") = py::none(),
      "Reflected per incident flux under uniform unpolarized illumination (white-sky albedo).");
  m.def(
      "bihemispherical_uncertainty",
      [](const ModelObject& o, const Wavelength& nm) {
        return over_wavelengths(
            o, nm, [&](double w) { return bihemispherical_uncertainty(o.model(), prepare_uncertainty(o.model(), w)); });
      },
      py::arg("model"), py::arg("wavelength_nm") = py::none(), "Its standard uncertainty, of the fit alone.");
  m.def(
      "reflectance_factor",
      [](const Doubles& f11) {
        const Broadcast broadcast({{"f11", f11}});
        return map(broadcast, [&](std::size_t i) { return reflectance_factor(broadcast.number(0, i)); });
      },
      py::arg("f11"), "pi f11: 1 for the perfect diffuser.");
}

void bind_aperture(py::module_& m) {
  const auto direction = [](double theta, double phi) { return direction_from_degrees(theta, phi); };
  py::class_<Aperture>(m, "Aperture",
                       "Directions from which a sample is illuminated or into which light is collected. Angles in "
                       "degrees.\nRaises ValueError for a shape that reaches below the horizon.")
      .def_static(
          "direction", [=](double theta, double phi) { return Aperture::direction(direction(theta, phi)); },
          py::arg("theta_deg"), py::arg("phi_deg") = 0.0)
      .def_static(
          "cone",
          [=](double theta, double phi, double half) { return Aperture::cone(direction(theta, phi), radians(half)); },
          py::arg("theta_deg"), py::arg("phi_deg"), py::arg("half_angle_deg"))
      .def_static(
          "annulus",
          [=](double theta, double phi, double inner, double outer) {
            return Aperture::annulus(direction(theta, phi), radians(inner), radians(outer));
          },
          py::arg("theta_deg"), py::arg("phi_deg"), py::arg("inner_deg"), py::arg("outer_deg"))
      .def_static(
          "ellipse",
          [=](double theta, double phi, double half_theta, double half_phi, double turn) {
            return Aperture::ellipse(direction(theta, phi), radians(half_theta), radians(half_phi), radians(turn));
          },
          py::arg("theta_deg"), py::arg("phi_deg"), py::arg("half_theta_deg"), py::arg("half_phi_deg"),
          py::arg("turn_deg") = 0.0)
      .def_static(
          "rectangle",
          [=](double theta, double phi, double half_theta, double half_phi, double turn) {
            return Aperture::rectangle(direction(theta, phi), radians(half_theta), radians(half_phi), radians(turn));
          },
          py::arg("theta_deg"), py::arg("phi_deg"), py::arg("half_theta_deg"), py::arg("half_phi_deg"),
          py::arg("turn_deg") = 0.0)
      .def_static(
          "ring", [](double least, double most) { return Aperture::ring(radians(least), radians(most)); },
          py::arg("theta_min_deg"), py::arg("theta_max_deg"), "At all azimuths")
      .def_static(
          "cap", [](double most) { return Aperture::cap(radians(most)); }, py::arg("theta_max_deg"))
      .def_static("hemisphere", &Aperture::hemisphere)
      .def("without", &Aperture::without, py::arg("port"), "With one more port: a cone that is taken out")
      .def_property_readonly("projected_solid_angle", &Aperture::projected_solid_angle, "In sr");
}

py::tuple averaged(const ModelObject& o, std::optional<double> nm, const Aperture& source, const Aperture& receiver,
                   double tolerance) {
  const double wavelength = o.wavelength(nm);
  const Average result = without_gil([&] {
    AverageOptions options;
    options.tolerance = tolerance;
    return average(prepare(o.model(), wavelength), source, receiver, options);
  });
  py::array_t<double> mueller({4, 4});
  Layout<Mueller>::store(result.mueller, mueller.mutable_data());
  return py::make_tuple(mueller, result.error, result.converged);
}

py::object polarized(const PolarizedCurve& curve) {
  std::array<py::array_t<double>, 4> columns;
  for (auto& column : columns) column = py::array_t<double>(static_cast<py::ssize_t>(curve.size()));
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const std::array values{curve[i].ss, curve[i].sp, curve[i].ps, curve[i].pp};
    for (std::size_t c = 0; c < 4; ++c) columns[c].mutable_data()[i] = values[c];
  }
  return py::module_::import("mmbrdf").attr("PolarizedBrdf")(columns[0], columns[1], columns[2], columns[3]);
}

void bind_curves(py::module_& m) {
  m.def(
      "polarized_curve",
      [](const ModelObject& o, std::optional<double> nm, const py::sequence& angles, bool as_printed) {
        return polarized(polarized_curve(o.model(), o.wavelength(nm), geometries_from(angles), rotation(as_printed)));
      },
      py::arg("model"), py::arg("wavelength_nm"), py::arg("geometry"), py::kw_only(), py::arg("as_printed") = false,
      "PolarizedBrdf(ss, sp, ps, pp) in sr^-1 at each geometry, as in the paper's Fig. 6.");
  m.def(
      "polarized_uncertainty",
      [](const ModelObject& o, std::optional<double> nm, const py::sequence& angles, bool as_printed) {
        return polarized(
            polarized_uncertainty(o.model(), o.wavelength(nm), geometries_from(angles), rotation(as_printed)));
      },
      py::arg("model"), py::arg("wavelength_nm"), py::arg("geometry"), py::kw_only(), py::arg("as_printed") = false,
      "Its standard uncertainty, of the fit alone.");
}

}  // namespace

void bind_radiometry(py::module_& m) {
  bind_directional_hemispherical(m);
  bind_hemispherical_directional(m);
  bind_bihemispherical(m);
  bind_aperture(m);
  bind_curves(m);
  m.def(
      "average", averaged, py::arg("model"), py::arg("wavelength_nm"), py::arg("source"), py::arg("receiver"),
      py::arg("tolerance") = 1e-10,
      "Mean of the matrix over a source and a receiver, weighted with projected solid angle: (matrix (4, 4) in sr^-1,\n"
      "xy frame; estimate of the quadrature's error in sr^-1; whether the tolerance was reached).");
}

}  // namespace mmbrdf::python
