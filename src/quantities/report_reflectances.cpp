// SPDX-License-Identifier: BSD-3-Clause
// What a model reflects, and why that is uncertain. Part of report.hpp.

#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"
#include "mmbrdf/radiometry/reflectance_uncertainty.hpp"
#include "mmbrdf/uncertainty/expanded.hpp"
#include "quantities/report_fields.hpp"

namespace mmbrdf {
namespace {

/// At one wavelength.
struct Reflector {
  const ReportSubject& subject;
  double wavelength;
  PreparedModel prepared;
  std::optional<UncertainModel> u;  // none: it is not known
};

struct Reflected {
  std::string quantity;
  double value;
  Outside outside;
  std::vector<Contribution> budget = {};  // none: the uncertainty is not known
  Json u = nullptr;
};

Reflected dhr_at(const Reflector& from, int theta) {
  const Direction incident{radians(theta), 0};
  const Model& model = from.subject.model;
  Reflected result{"dhr, theta_i " + std::to_string(theta),
                   directional_hemispherical_reflectance(model, from.wavelength, incident),
                   outside(model.validity, from.wavelength, {incident, {}})};
  if (!from.u) return result;
  result.budget = directional_hemispherical_budget(*from.u, incident);
  result.u = standard_uncertainty(result.budget);
  return result;
}

Reflected bhr_of(const Reflector& from) {
  Reflected result{"bhr", bihemispherical_reflectance(from.subject.model, from.wavelength),
                   outside(from.subject.model.validity, from.wavelength)};
  if (!from.u) return result;
  result.budget = bihemispherical_budget(*from.u);
  result.u = standard_uncertainty(result.budget);
  return result;
}

Reflected factor_at(const Reflector& from, const std::string& name, const Geometry& geometry) {
  Reflected result{"reflectance factor " + name, reflectance_factor(from.prepared.f11(geometry)),
                   outside(from.subject.model.validity, from.wavelength, geometry)};
  if (!from.u) return result;
  Mueller gradient;
  gradient(0, 0) = reflectance_factor(1);
  result.budget = contributions(budget(from.u->model, from.u->fit, from.u->terms, geometry, Frame::sp), gradient);
  result.u = from.u->terms.empty() ? reflectance_factor(from.u->fit.standard_uncertainty(geometry)(0, 0))
                                   : standard_uncertainty(result.budget);
  return result;
}

std::vector<Reflected> reflected_by(const Reflector& from) {
  std::vector<Reflected> result;
  for (const int theta : {0, 8, 45, 60, 75}) result.push_back(dhr_at(from, theta));
  result.push_back(bhr_of(from));
  const Direction normal{}, oblique{radians(45), 0}, opposite{radians(45), radians(180)};
  result.push_back(factor_at(from, "0:45", {normal, opposite}));
  result.push_back(factor_at(from, "45:0", {oblique, normal}));
  return result;
}

Json freedom_or_null(double freedom) { return std::isinf(freedom) ? Json(nullptr) : Json(freedom); }

/// Of those quantities that certificates name.
void add_budget(Json& rows, const Json& wavelength, const Reflected& one) {
  if (one.budget.empty() || (one.quantity != "dhr, theta_i 8" && one.quantity != "reflectance factor 0:45")) return;
  const auto add_row = [&](const std::string& cause, double u, double freedom, const Json& expanded) {
    rows.push_back({{"wavelength_nm", wavelength},
                    {"quantity", one.quantity},
                    {"cause", cause},
                    {"u", u},
                    {"degrees_of_freedom", freedom_or_null(freedom)},
                    {"U", expanded}});
  };
  for (const Contribution& cause : one.budget) add_row(cause.name, cause.uncertainty, cause.freedom, nullptr);
  const ExpandedUncertainty all = expanded(one.budget);
  add_row("together", all.uncertainty, all.freedom, reported_coverage * all.uncertainty);
}

bool is_angle(ErrorOf what) { return what != ErrorOf::scale && what != ErrorOf::calibration; }

Json terms_json(std::span<const TypeBTerm> terms) {
  Json rows = Json::array();
  for (const TypeBTerm& term : terms)
    rows.push_back({{"cause", term.name},
                    {"kind", to_string(term.what) + (is_angle(term.what) ? "_deg" : "")},
                    {"u", is_angle(term.what) ? degrees(term.uncertainty) : term.uncertainty},
                    {"degrees_of_freedom", freedom_or_null(term.freedom)}});
  return rows;
}

/// What u is of.
std::string words_of_uncertainty(const ReportSubject& subject) {
  std::string text = uncertain_of(subject.model);
  for (std::size_t i = 0; i < subject.terms.size(); ++i)
    text += (i > 0                      ? ", "
             : subject.terms.size() > 1 ? " and of the terms "
                                        : " and of the term ") +
            subject.terms[i].name;
  const std::string missing = missing_from_uncertainty(subject.model);
  return text + (missing.empty() ? "" : "; " + missing);
}

}  // namespace

void add_reflectances(Json& report, const ReportSubject& subject) {
  Json reflectances = Json::array(), budgets = Json::array();
  const bool known = knows_uncertainty(subject.model);
  for (const double wavelength : subject.wavelengths) {
    const Json shown = subject.wavelength_json(wavelength);
    Reflector from{subject, wavelength, prepare(subject.model, wavelength), {}};
    if (known || !subject.terms.empty()) from.u = subject.uncertain_at(wavelength);
    for (const Reflected& one : reflected_by(from)) {
      reflectances.push_back({{"wavelength_nm", shown},
                              {"quantity", one.quantity},
                              {"value", one.value},
                              {"u", one.u},
                              {"validity", to_string(one.outside)}});
      add_budget(budgets, shown, one);
    }
  }
  report["uncertainty"] = known ? words_of_uncertainty(subject) : std::string("not known");
  if (!subject.terms.empty()) report["terms"] = terms_json(subject.terms);
  report["reflectances"] = std::move(reflectances);
  report["budgets"] = std::move(budgets);
}

}  // namespace mmbrdf
