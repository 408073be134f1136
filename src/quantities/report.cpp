// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/quantities/report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "mmbrdf/mixed/sample_traits.hpp"
#include "mmbrdf/quantities/answer.hpp"
#include "mmbrdf/radiometry/reflectance_uncertainty.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"
#include "quantities/report_fields.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

std::string in_words(const ReportSubject& reported, double wavelength) {
  return reported.known_wavelengths ? nm(wavelength) : "its wavelength";
}

/// Once for all wavelengths of which the same is true.
Warnings unsupported_warnings(const ReportSubject& reported) {
  std::vector<std::pair<std::string, std::vector<double>>> lines;
  for (const double wavelength : reported.wavelengths) {
    const std::string line = unsupported_line(reported.model.validity, wavelength);
    if (line.empty()) continue;
    auto same = std::ranges::find(lines, line, [](const auto& one) { return one.first; });
    if (same == lines.end()) same = lines.insert(lines.end(), {line, {}});
    same->second.push_back(wavelength);
  }
  Warnings warnings;
  for (const auto& [line, where] : lines)
    warnings.push_back((reported.known_wavelengths ? nanometre_list(where) : "its wavelength") + ": " + line);
  return warnings;
}

Warnings range_warnings(const ReportSubject& reported) {
  const Model& model = reported.model;
  Warnings warnings;
  if (std::string line = unknown_range_line(reported.name, model.validity); !line.empty()) warnings.push_back(line);
  for (const double wavelength : reported.wavelengths)
    if (outside(model.validity, wavelength) & outside_wavelength)
      warnings.push_back(nm(wavelength) + " lies outside the fitted range: what is said of it is extrapolated from " +
                         nanometre_list(model.validity.wavelengths));
  std::ranges::move(unsupported_warnings(reported), std::back_inserter(warnings));
  if (!knows_uncertainty(model))
    warnings.push_back("the covariance of the coefficients is not known, or not of all, and no uncertainty with it");
  for (const FittedBlock& fitted : model.blocks) {
    const std::size_t count = fitted.coefficients.size(), rank = static_cast<std::size_t>(fitted.rank);
    if (rank > 0 && rank < count)
      warnings.push_back("the data left " + std::to_string(count - rank) + " of " + count_of(count, "combination") +
                         " of block " + fitted.block.name + " free" +
                         (model.posterior ? ": what that leaves open is in u" : ""));
  }
  return warnings;
}

Warnings range_notes(const ReportSubject& reported) {
  Warnings notes;
  for (const double wavelength : reported.wavelengths)
    if (outside(reported.model.validity, wavelength) & interpolated)
      notes.push_back(nm(wavelength) + " lies between the fitted wavelengths " +
                      nanometre_list(reported.model.validity.wavelengths) + ": what is said of it is interpolated");
  return notes;
}

Json model_json(const ReportSubject& reported) {
  const Model& model = reported.model;
  Json json{{"name", model.name.empty() ? reported.name : model.name},
            {"basis", basis_line(model)},
            {"fitted range", fitted_range(model.validity)}};
  if (model.not_measured.any()) json["not measured"] = not_measured_line(model.not_measured);
  const ReflectanceTable& table = model.reflectance;
  if (!table.values.empty())
    json["reflectance table"] =
        reflectance_line(table) + (table.covariance.empty() ? ", exact" : ", with its covariance") + reach_of(table);
  for (const auto& [name, text] : model.provenance) json[json.contains(name) ? "provenance: " + name : name] = text;
  return json;
}

Json fit_json(const Model& model) {
  Json rows = Json::array();
  for (const FittedBlock& fitted : model.blocks)
    rows.push_back({{"block", fitted.block.name},
                    {"coefficients", fitted.coefficients.size()},
                    {"rank", fitted.rank > 0 ? Json(fitted.rank) : Json(nullptr)},
                    {"condition", fitted.condition > 0 ? Json(fitted.condition) : Json(nullptr)},
                    {"covariance", model.posterior || !fitted.covariance.empty()}});
  return rows;
}

Json sample_json(const Posterior& posterior) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < posterior.data().wavelengths.size(); ++i)
    for (const auto& [block, noise, anisotropy, nonreciprocal] : sample_traits(posterior, i))
      rows.push_back({{"wavelength_nm", nanometres(posterior.data().wavelengths[i].wavelength)},
                      {"block", block},
                      {"noise", noise},
                      {"once_per_turn", anisotropy[0]},
                      {"twice_per_turn", anisotropy[1]},
                      {"thrice_per_turn", anisotropy[2]},
                      {"nonreciprocal", nonreciprocal}});
  return rows;
}

/// Within the fitted angles, and up to the horizon.
std::vector<double> polar_limits(const Validity& validity) {
  const double fitted = fitted_theta_max(validity);
  return fitted < radians(90) ? std::vector{fitted, radians(90)} : std::vector{fitted};
}

Warnings unphysical(const ModelDiagnostics& d, const std::string& wavelength, bool fitted) {
  const std::string where = (fitted ? "within the fitted angles at " : "up to the horizon at ") + wavelength;
  Warnings warnings;
  if (d.unrealizable > 0)
    warnings.push_back(std::to_string(d.unrealizable) + " of " + std::to_string(d.geometries) + " matrices " + where +
                       " cannot exist; the smallest eigenvalue / f11 is " + rounded(d.margin.value, 2) + " at " +
                       at(d.margin.geometry));
  if (std::string line = not_positive_line(d, where); !line.empty()) warnings.push_back(line);
  if (std::string line = energy_line(d, where); fitted && !line.empty()) warnings.push_back(line);
  return warnings;
}

/// Standard uncertainties of the extremes of a model, null where they are not known.
struct ExtremesUncertainty {
  Json margin, f11, dhr;
};

ExtremesUncertainty uncertainty_of_extremes(const ReportSubject& reported, const ModelDiagnostics& d) {
  const Model& model = reported.model;
  if (!knows_uncertainty(model)) return {};
  const UncertainModel u = reported.uncertain_at(d.wavelength);
  ExtremesUncertainty result;
  const bool unlimited = std::cos(d.f11.geometry.reflected.theta) < grazing_limit &&
                         std::ranges::any_of(u.terms, [](const TypeBTerm& t) { return t.what == ErrorOf::theta_r; });
  if (u.terms.empty())
    result.f11 = u.fit.standard_uncertainty(d.f11.geometry)(0, 0);
  else if (!unlimited)
    result.f11 = standard_uncertainty(budget(u.model, u.fit, u.terms, d.f11.geometry).total)(0, 0);
  result.dhr = standard_uncertainty(directional_hemispherical_budget(u, {d.dhr_theta_i, 0}));
  if (!d.whole) return result;
  const AnswerOptions options{.terms = u.terms, .parts = false};
  for (const Answered& one : Answers(model, options).at(d.wavelength).at(d.margin.geometry).quantities)
    if (one.quantity->name == "eigenvalue_min" && one.uncertainty) result.margin = *one.uncertainty;
  return result;
}

/// What is beyond a known range of angles is only to be noted: nothing was measured there.
ReportField realizability(const ReportSubject& reported) {
  ReportField field;
  const double fitted = fitted_theta_max(reported.model.validity);
  for (const double wavelength : reported.wavelengths)
    for (const double theta_max : polar_limits(reported.model.validity)) {
      const ModelDiagnostics d = model_diagnostics(reported.model, wavelength, theta_max);
      const ExtremesUncertainty u = uncertainty_of_extremes(reported, d);
      field.value.push_back({{"wavelength_nm", reported.wavelength_json(wavelength)},
                             {"theta_max_deg", degrees(theta_max)},
                             {"geometries", d.geometries},
                             {"unrealizable", d.whole ? Json(d.unrealizable) : Json(nullptr)},
                             {"smallest_margin", d.whole ? Json(d.margin.value) : Json(nullptr)},
                             {"u_margin", u.margin},
                             {"margin_at", d.whole ? Json(at(d.margin.geometry)) : Json(nullptr)},
                             {"f11_not_positive", d.not_positive_f11},
                             {"smallest_f11", d.f11.value},
                             {"u_smallest_f11", u.f11},
                             {"largest_dhr", d.dhr},
                             {"u_largest_dhr", u.dhr},
                             {"dhr_at_theta_i_deg", degrees(d.dhr_theta_i)}});
      const Warnings found = unphysical(d, in_words(reported, wavelength), theta_max < radians(90));
      std::ranges::copy(found, std::back_inserter(theta_max > fitted ? field.notes : field.warnings));
    }
  return field;
}

/// Throws unless there is something to report on.
ReportSubject reported(const Model& model, const std::string& name, std::span<const double> wavelengths,
                       std::span<const TypeBTerm> terms) {
  require_valid(model);
  ReportSubject result{
      model, name, {wavelengths.begin(), wavelengths.end()}, !wavelengths.empty() || knows_wavelength(model), terms};
  if (wavelengths.empty()) result.wavelengths = known_wavelengths(model);
  if (result.wavelengths.empty())
    throw std::invalid_argument(name + " does not say to which wavelengths it was fitted: give some");
  for (const double wavelength : result.wavelengths) require_wavelength(wavelength);
  return result;
}

}  // namespace

std::string shown_name_of(const Model& model, const std::string& name) {
  const bool same = model.name.empty() || model.name == name || model.name == name.substr(0, name.rfind('.'));
  return same ? name : name + " (" + model.name + ")";
}

std::string report_json(const Model& model, const std::string& name, std::span<const double> wavelengths,
                        const std::optional<ReportedSamples>& samples, std::span<const TypeBTerm> terms) {
  const ReportSubject what = reported(model, name, wavelengths, terms);
  Json report{{"title", "Report on " + shown_name_of(model, name)},
              {"warnings", range_warnings(what)},
              {"notes", range_notes(what)}};
  report["model"] = model_json(what);
  report["fit"] = fit_json(model);
  if (model.posterior) report["sample"] = sample_json(*model.posterior);
  add(report, "realizability", realizability(what));
  add_reflectances(report, what);
  if (samples) add_samples(report, model, *samples);
  return report.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace mmbrdf
