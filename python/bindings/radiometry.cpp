// SPDX-License-Identifier: BSD-3-Clause
// Reflectances, and means over apertures.
#include "mmbrdf/radiometry/reflectance.hpp"

#include <pybind11/stl.h>

#include <functional>
#include <map>
#include <mutex>

#include "dataset.hpp"
#include "mmbrdf/fitting/subsets.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/radiometry/reflectance_uncertainty.hpp"
#include "question.hpp"

namespace mmbrdf::python {

namespace {

using Wavelength = std::optional<Given>;

/// What was made for each wavelength (micrometres). May be asked by many threads.
template <class T>
class ForWavelengths {
 public:
  explicit ForWavelengths(std::function<T(double)> make) : make_(std::move(make)) {}
  const T& at(double wavelength) {
    const std::lock_guard lock(mutex_);
    const auto known = made_.find(wavelength);
    return known != made_.end() ? known->second : made_.emplace(wavelength, make_(wavelength)).first->second;
  }

 private:
  std::function<T(double)> make_;
  std::mutex mutex_;
  std::map<double, T> made_;
};

using Uncertainties = ForWavelengths<PreparedUncertainty>;

Uncertainties uncertainties_of(const ModelObject& o) {
  return Uncertainties([&o](double wavelength) { return prepare_uncertainty(o.model(), wavelength); });
}

/// Which of the two directions of a geometry is asked for; the other is anywhere.
enum class Side { incident, reflected };

/// f(wavelength in micrometres, direction, Stokes vector) over arrays.
template <class F>
py::object over_directions(const ModelObject& model, Side side, const Wavelength& nm, const Given& theta,
                           const Given& phi, const std::optional<Given>& stokes, F f) {
  const bool incident = side == Side::incident;
  std::vector<Operand> operands{model.wavelength_operand(nm),
                                {incident ? "theta_i_deg" : "theta_r_deg", theta},
                                {incident ? "phi_i_deg" : "phi_r_deg", phi}};
  if (stokes) operands.push_back({incident ? "stokes" : "analyzer", *stokes, {4}});
  const Broadcast broadcast(std::move(operands));
  Range range(model);
  const py::object result = map(broadcast, [&](std::size_t i) {
    const Direction direction = direction_from_degrees(broadcast.number(1, i), broadcast.number(2, i));
    const double wavelength = micrometres(broadcast.number(0, i));
    range.count(wavelength, incident ? Geometry{direction, {}} : Geometry{{}, direction});
    return f(wavelength, direction, stokes ? broadcast.at<4>(3, i) : Stokes{1, 0, 0, 0});
  });
  range.warn(broadcast.size());
  return result;
}

/// f(wavelength in micrometres) over an array of wavelengths.
template <class F>
py::object over_wavelengths(const ModelObject& model, const Wavelength& nm, F f) {
  return over_directions(model, Side::incident, nm, py::float_(0.0), py::float_(0.0), {},
                         [&](double wavelength, const Direction&, const Stokes&) { return f(wavelength); });
}

void bind_directional_hemispherical(py::module_& m) {
  m.def(
      "directional_hemispherical_reflectance",
      [](const ModelObject& o, const Wavelength& nm, const Given& theta, const Given& phi,
         const std::optional<Given>& stokes) {
        return over_directions(o, Side::incident, nm, theta, phi, stokes,
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
      [](const ModelObject& o, const Wavelength& nm, const Given& theta, const Given& phi,
         const std::optional<Given>& stokes) {
        Uncertainties u = uncertainties_of(o);
        return over_directions(o, Side::incident, nm, theta, phi, stokes,
                               [&](double wavelength, const Direction& incident, const Stokes& light) {
                                 return directional_hemispherical_uncertainty(o.model(), u.at(wavelength), incident,
                                                                              light);
                               });
      },
      py::arg("model"), py::arg("wavelength_nm") = py::none(), py::arg("theta_i_deg") = 0.0, py::arg("phi_i_deg") = 0.0,
      py::arg("stokes") = py::none(), "Its standard uncertainty, of the fit and, where it has one, its instrument.");
}

void bind_hemispherical_directional(py::module_& m) {
  m.def(
      "hemispherical_directional_reflectance",
      [](const ModelObject& o, const Wavelength& nm, const Given& theta, const Given& phi,
         const std::optional<Given>& analyzer) {
        return over_directions(
            o, Side::reflected, nm, theta, phi, analyzer,
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
      [](const ModelObject& o, const Wavelength& nm, const Given& theta, const Given& phi,
         const std::optional<Given>& analyzer) {
        Uncertainties u = uncertainties_of(o);
        return over_directions(o, Side::reflected, nm, theta, phi, analyzer,
                               [&](double wavelength, const Direction& reflected, const Stokes& passed) {
                                 return hemispherical_directional_uncertainty(o.model(), u.at(wavelength), reflected,
                                                                              passed);
                               });
      },
      py::arg("model"), py::arg("wavelength_nm") = py::none(), py::arg("theta_r_deg") = 0.0, py::arg("phi_r_deg") = 0.0,
      py::arg("analyzer") = py::none(), "Its standard uncertainty, of the fit and, where it has one, its instrument.");
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
      py::arg("model"), py::arg("wavelength_nm") = py::none(),
      "Its standard uncertainty, of the fit and, where it has one, its instrument.");
  m.def(
      "reflectance_factor",
      [](const Given& f11) {
        const Broadcast broadcast({{"f11", f11}});
        return map(broadcast, [&](std::size_t i) { return reflectance_factor(broadcast.number(0, i)); });
      },
      py::arg("f11"), "pi f11: 1 for the perfect diffuser.");
}

py::tuple averaged(const ModelObject& o, std::optional<double> nm, const Aperture& source, const Aperture& receiver,
                   double tolerance) {
  const double wavelength = o.wavelength(nm);
  const Average result = without_gil([&] {
    AverageOptions options;
    options.tolerance = tolerance;
    return average(prepare(o.model(), wavelength), source, receiver, options);
  });
  Range range(o);
  range.count(wavelength, {{source.largest_theta(), 0}, {receiver.largest_theta(), 0}});
  range.warn(1);
  py::array_t<double> mueller({4, 4});
  Layout<Mueller>::store(result.mueller, mueller.mutable_data());
  return py::make_tuple(mueller, result.error, result.converged);
}

/// Geometries of a curve. Warns of those outside the fitted range.
std::vector<Geometry> curve_geometries(const ModelObject& o, double wavelength, const py::sequence& angles) {
  std::vector<Geometry> geometries = geometries_from(angles);
  Range range(o);
  for (const Geometry& g : geometries) range.count(wavelength, g);
  range.warn(geometries.size());
  return geometries;
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
        const double wavelength = o.wavelength(nm);
        const std::vector<Geometry> geometries = curve_geometries(o, wavelength, angles);
        return polarized(polarized_curve(o.turned(as_printed), wavelength, geometries));
      },
      py::arg("model"), py::arg("wavelength_nm"), py::arg("geometry"), py::kw_only(), py::arg("as_printed") = false,
      "PolarizedBrdf(ss, sp, ps, pp) in sr^-1 at each geometry, as in the paper's Fig. 6.");
  m.def(
      "polarized_uncertainty",
      [](const ModelObject& o, std::optional<double> nm, const py::sequence& angles, bool as_printed) {
        const double wavelength = o.wavelength(nm);
        const std::vector<Geometry> geometries = curve_geometries(o, wavelength, angles);
        return polarized(polarized_uncertainty(o.turned(as_printed), wavelength, geometries));
      },
      py::arg("model"), py::arg("wavelength_nm"), py::arg("geometry"), py::kw_only(), py::arg("as_printed") = false,
      "Its standard uncertainty, of the fit and, where it has one, its instrument.");
}

}  // namespace

void bind_radiometry(py::module_& m) {
  bind_directional_hemispherical(m);
  bind_hemispherical_directional(m);
  bind_bihemispherical(m);
  bind_curves(m);
  m.def(
      "average", averaged, py::arg("model"), py::arg("wavelength_nm"), py::arg("source"), py::arg("receiver"),
      py::arg("tolerance") = 1e-10,
      "Mean of the matrix over a source and a receiver, weighted with projected solid angle: (matrix (4, 4) in sr^-1,\n"
      "xy frame; estimate of the quadrature's error in sr^-1; whether the tolerance was reached).");
}

}  // namespace mmbrdf::python
