// SPDX-License-Identifier: BSD-3-Clause
// Reflectances, and means over apertures.
#include "mmbrdf/radiometry/reflectance.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <functional>
#include <mutex>
#include <string>

#include "aperture.hpp"
#include "dataset.hpp"
#include "mmbrdf/fitting/subsets.hpp"
#include "mmbrdf/model/at_wavelengths.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/radiometry/certificate.hpp"
#include "mmbrdf/radiometry/reflectance_uncertainty.hpp"
#include "question.hpp"

namespace mmbrdf::python {

namespace {

using Wavelength = std::optional<Given>;

/// Which of the two directions of a geometry is asked for; the other is anywhere.
enum class Side { incident, reflected };

/// f(wavelength in micrometres, direction, Stokes vector or null) over arrays.
template <class F>
py::object over_directions(const ModelObject& model, Side side, const Wavelength& nm, const Given& theta,
                           const Given& phi, const std::optional<Given>& stokes, F f, bool warns = true) {
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
    const Stokes light = stokes ? broadcast.at<4>(3, i) : Stokes{};
    return f(wavelength, direction, stokes ? &light : nullptr);
  });
  if (warns) range.warn(broadcast.size());
  return result;
}

/// The same of a quantity that has no direction.
template <class F>
py::object over_wavelengths(const ModelObject& model, const Wavelength& nm, F f) {
  return over_directions(model, Side::incident, nm, py::float_(0.0), py::float_(0.0), {},
                         [&](double wavelength, const Direction&, const Stokes*) { return f(wavelength); });
}

constexpr const char* terms_doc =
    "Its standard uncertainty, of the fit, where it has one of its instrument, and of the terms of type B, as those "
    "of\n"
    "Model.evaluate_uncertainty(): each is one error for all directions. by_term=True: {'fit': u, 'scale': u, ...}, "
    "for\n"
    "budget(); of a fit of the sample 'posterior', 'declared scale', ..., 'projection' instead of 'fit'.";

/// A model at the wavelengths that are asked for, for several threads.
class UncertainModels {
 public:
  UncertainModels(const ModelObject& o, const Terms& terms)
      : terms_(terms_from(terms)),
        causes_(names_of_parts(o.model())),
        prepared_([&o, this](double wavelength) { return uncertain(o.model(), wavelength, terms_); }) {
    for (const TypeBTerm& term : terms_) causes_.push_back(term.name);
  }
  UncertainModels(const UncertainModels&) = delete;

  const UncertainModel& operator()(double wavelength) {
    const std::lock_guard lock(mutex_);
    return prepared_(wavelength);
  }

  /// compute(function that makes a number of a budget, whether to warn): of all causes together, or of each by name.
  template <class Compute>
  py::object uncertainties(bool by_term, Compute compute) const {
    if (!by_term)
      return compute([](const std::vector<Contribution>& budget) { return standard_uncertainty(budget); }, true);
    py::dict result;
    for (std::size_t c = 0; c < causes_.size(); ++c)
      result[py::str(causes_[c])] =
          compute([c](const std::vector<Contribution>& budget) { return budget[c].uncertainty; }, c == 0);
    return result;
  }

 private:
  std::vector<TypeBTerm> terms_;
  std::vector<std::string> causes_;
  AtWavelengths<std::function<UncertainModel(double)>> prepared_;
  std::mutex mutex_;
};

/// A reflectance between the hemisphere and a direction.
struct Reflectance {
  std::string name;
  Side side;
  double (*unpolarized)(const Model&, double, const Direction&);
  double (*value)(const Model&, double, const Direction&, const Stokes&);
  std::vector<Contribution> (*budget)(const UncertainModel&, const Direction&, const Stokes&);
  const char* doc;

  py::object values(const ModelObject& o, const Wavelength& nm, const Given& theta, const Given& phi,
                    const std::optional<Given>& stokes) const {
    return over_directions(o, side, nm, theta, phi, stokes,
                           [&](double wavelength, const Direction& direction, const Stokes* light) {
                             return light ? value(o.model(), wavelength, direction, *light)
                                          : unpolarized(o.model(), wavelength, direction);
                           });
  }

  py::object uncertainties(const ModelObject& o, const Wavelength& nm, const Given& theta, const Given& phi,
                           const std::optional<Given>& stokes, const Terms& terms, bool by_term) const {
    UncertainModels at(o, terms);
    return at.uncertainties(by_term, [&](auto number, bool warns) {
      return over_directions(
          o, side, nm, theta, phi, stokes,
          [&](double wavelength, const Direction& direction, const Stokes* light) {
            return number(budget(at(wavelength), direction, light ? *light : Stokes{1}));
          },
          warns);
    });
  }
};

const std::array reflectances{
    Reflectance{"directional_hemispherical", Side::incident, directional_hemispherical_reflectance,
                directional_hemispherical_reflectance, directional_hemispherical_budget,
                "Reflected per incident flux, over the whole hemisphere, for unpolarized light or incident light "
                "`stokes`\n(..., 4) in the sp frame. All arguments broadcast."},
    Reflectance{"hemispherical_directional", Side::reflected, hemispherical_directional_reflectance,
                hemispherical_directional_reflectance, hemispherical_directional_budget,
                "Radiance into a direction under uniform unpolarized illumination, per that of the perfect diffuser; "
                "seen through\nan analyzer that passes the light `analyzer` (..., 4), in the sp frame."}};

void bind_directional(py::module_& m, const Reflectance& one) {
  const bool incident = one.side == Side::incident;
  const auto define = [&](const char* what, auto function, const char* doc, const auto&... own) {
    m.def((one.name + what).c_str(), function, py::arg("model"), py::arg("wavelength_nm") = py::none(),
          py::arg(incident ? "theta_i_deg" : "theta_r_deg") = 0.0, py::arg(incident ? "phi_i_deg" : "phi_r_deg") = 0.0,
          py::arg(incident ? "stokes" : "analyzer") = py::none(), own..., doc);
  };
  define(
      "_reflectance",
      [&one](const ModelObject& o, const Wavelength& nm, const Given& theta, const Given& phi,
             const std::optional<Given>& stokes) { return one.values(o, nm, theta, phi, stokes); },
      one.doc);
  define(
      "_uncertainty",
      [&one](const ModelObject& o, const Wavelength& nm, const Given& theta, const Given& phi,
             const std::optional<Given>& stokes, const Terms& terms,
             bool by_term) { return one.uncertainties(o, nm, theta, phi, stokes, terms, by_term); },
      terms_doc, py::kw_only(), py::arg("terms") = py::none(), py::arg("by_term") = false);
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
      [](const ModelObject& o, const Wavelength& nm, const Terms& terms, bool by_term) {
        UncertainModels at(o, terms);
        return at.uncertainties(by_term, [&](auto number, bool) {
          return over_wavelengths(o, nm, [&](double w) { return number(bihemispherical_budget(at(w))); });
        });
      },
      py::arg("model"), py::arg("wavelength_nm") = py::none(), py::kw_only(), py::arg("terms") = py::none(),
      py::arg("by_term") = false, terms_doc);
  m.def(
      "reflectance_factor",
      [](const Given& f11) {
        const Broadcast broadcast({{"f11", f11}});
        return map(broadcast, [&](std::size_t i) { return reflectance_factor(broadcast.number(0, i)); });
      },
      py::arg("f11"), "pi f11: 1 for the perfect diffuser.");
}

py::tuple averaged(const ModelObject& o, std::optional<double> nm, const ApertureObject& source,
                   const ApertureObject& receiver, double tolerance) {
  const double wavelength = o.wavelength(nm);
  const Average result = without_gil([&] {
    AverageOptions options;
    options.tolerance = tolerance;
    return average(prepare(o.model(), wavelength), source, receiver, options);
  });
  Range range(o);
  range.count(wavelength, {{source.largest_theta(), 0}, {receiver.largest_theta(), 0}});
  range.warn(1);
  return py::make_tuple(array_of(result.mueller), result.error, result.converged);
}

py::array_t<double> average_uncertainty(const ModelObject& o, std::optional<double> nm, const ApertureObject& source,
                                        const ApertureObject& receiver, const Terms& terms) {
  const double wavelength = o.wavelength(nm);
  return array_of(without_gil([&] {
    const UncertainModel model = uncertain(o.model(), wavelength, terms_from(terms));
    const int few = average(model.model, source, receiver, {.tolerance = 1e-3}).nodes;  // digits that u needs
    return standard_uncertainty(average_budget(model, source, receiver, few).total);
  }));
}

py::object certified_model(const ModelObject& o, const Given& nm, const Given& reflectance, const Given& u,
                           const Given& theta) {
  const Broadcast broadcast({{"wavelength_nm", nm}, {"reflectance", reflectance}, {"u", u}, {"theta_i_deg", theta}});
  std::vector<CertifiedReflectance> certificate;
  for (std::size_t i = 0; i < broadcast.size(); ++i)
    certificate.push_back({micrometres(broadcast.number(0, i)), broadcast.number(1, i), broadcast.number(2, i),
                           radians(broadcast.number(3, i))});
  CertifiedModel result = without_gil([&] { return certified(o.model(), certificate); });
  if (result.change > noticeable_change)
    warn("UserWarning", formatted("the certificate changes f11 by up to {:.1f} %", 100 * result.change) +
                            "; the other elements / f11 stay those of the sample that was measured, and a darker one "
                            "depolarizes less");
  return py::cast(std::make_shared<ModelObject>(std::move(result.model)));
}

/// {name: u} to the budget of a number, or of many at once.
py::object budget_of(const py::dict& parts, const std::map<std::string, double>& freedoms) {
  std::vector<std::string> names;
  std::vector<Operand> operands;
  names.reserve(parts.size());  // operands point to them
  for (const auto& [name, u] : parts) {
    names.push_back(name.cast<std::string>());
    operands.push_back({names.back().c_str(), u.cast<Given>()});
  }
  for (const auto& [name, freedom] : freedoms)
    if (std::ranges::find(names, name) == names.end())
      throw std::invalid_argument("degrees_of_freedom: there is no part " + name);
  const Broadcast broadcast(std::move(operands));
  const py::object all = map(broadcast, [&](std::size_t i) {
    std::vector<Contribution> causes;
    for (std::size_t c = 0; c < names.size(); ++c) {
      causes.push_back({names[c], broadcast.number(c, i)});
      if (const auto known = freedoms.find(names[c]); known != freedoms.end()) causes.back().freedom = known->second;
    }
    const ExpandedUncertainty u = expanded(std::move(causes));
    return std::array{u.uncertainty, u.freedom, u.coverage_factor, u.expanded};
  });
  const auto column = [&](int c) -> py::object { return all[py::make_tuple(py::ellipsis(), c)]; };
  return record("Budget", parts, column(0), column(1), column(2), column(3));
}

/// curve(model, wavelength in micrometres, geometries)
template <class CurveOf>
py::object curve_of(const ModelObject& o, const std::optional<double>& nm, const py::sequence& angles, bool as_printed,
                    CurveOf curve) {
  const double wavelength = o.wavelength(nm);
  const std::vector<Geometry> geometries = geometries_from(angles);
  Range range(o);
  range.count(wavelength, geometries);
  range.warn(geometries.size());
  return polarized(curve(o.turned(as_printed), wavelength, geometries));
}

void bind_curves(py::module_& m) {
  m.def(
      "polarized_curve",
      [](const ModelObject& o, std::optional<double> nm, const py::sequence& angles, bool as_printed) {
        return curve_of(o, nm, angles, as_printed, polarized_curve);
      },
      py::arg("model"), py::arg("wavelength_nm"), py::arg("geometry"), py::kw_only(), py::arg("as_printed") = false,
      "PolarizedBrdf(ss, sp, ps, pp) in sr^-1 at each geometry, as in the paper's Fig. 6.");
  m.def(
      "polarized_uncertainty",
      [](const ModelObject& o, std::optional<double> nm, const py::sequence& angles, bool as_printed,
         const Terms& terms) {
        const std::vector<TypeBTerm> added = terms_from(terms);
        return curve_of(o, nm, angles, as_printed, [&](const Model& model, double at, std::span<const Geometry> all) {
          return polarized_uncertainty(model, at, all, added);
        });
      },
      py::arg("model"), py::arg("wavelength_nm"), py::arg("geometry"), py::kw_only(), py::arg("as_printed") = false,
      py::arg("terms") = py::none(),
      "Its standard uncertainty, of the fit, where it has one of its instrument, and of the terms, as those of\n"
      "Model.evaluate_uncertainty().");
}

}  // namespace

py::object polarized(const std::vector<PolarizedBrdf>& curve) {
  std::array<py::array_t<double>, 4> columns;
  for (auto& column : columns) column = py::array_t<double>(static_cast<py::ssize_t>(curve.size()));
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const std::array values{curve[i].ss, curve[i].sp, curve[i].ps, curve[i].pp};
    for (std::size_t c = 0; c < 4; ++c) columns[c].mutable_data()[i] = values[c];
  }
  return record("PolarizedBrdf", columns[0], columns[1], columns[2], columns[3]);
}

void bind_radiometry(py::module_& m) {
  for (const Reflectance& one : reflectances) bind_directional(m, one);
  bind_bihemispherical(m);
  bind_curves(m);
  m.def(
      "average", averaged, py::arg("model"), py::arg("wavelength_nm"), py::arg("source"), py::arg("receiver"),
      py::arg("tolerance") = 1e-10,
      "Mean of the matrix over a source and a receiver, weighted with projected solid angle: (matrix (4, 4) in sr^-1,\n"
      "xy frame; estimate of the quadrature's error in sr^-1; whether the tolerance was reached).");
  m.def("average_uncertainty", average_uncertainty, py::arg("model"), py::arg("wavelength_nm"), py::arg("source"),
        py::arg("receiver"), py::kw_only(), py::arg("terms") = py::none(),
        "Standard uncertainties of the matrix that average() gives, of the fit and of the terms: (4, 4) in sr^-1.");
  m.def("certified", certified_model, py::arg("model"), py::arg("wavelength_nm"), py::arg("reflectance"), py::arg("u"),
        py::arg("theta_i_deg") = 8.0,
        "The Model rescaled so that its directional-hemispherical reflectance is the certified one, with its standard\n"
        "uncertainty, at these wavelengths (arrays broadcast); valid between them. Errors of the certificate count as\n"
        "one for all its wavelengths. Warns where f11 changes by more than 3 %: the other elements / f11 do not\n"
        "change, though the polarization of a grey sample differs from that of a white one.");
  m.def("budget", budget_of, py::arg("parts"), py::arg("degrees_of_freedom") = std::map<std::string, double>(),
        "What can be signed: Budget of {name: standard uncertainty}, numbers or arrays, as by_term=True and\n"
        "Analyzed.parts give them. degrees_of_freedom of those parts where they are finite: {'fit': "
        "model.degrees_of_freedom}; all others are inf.");
}

}  // namespace mmbrdf::python
