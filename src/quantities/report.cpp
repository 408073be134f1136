// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/quantities/report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "mmbrdf/mixed/sample_traits.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"
#include "mmbrdf/radiometry/reflectance_uncertainty.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"
#include "quantities/report_fields.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

struct Reported {
  const Model& model;
  const std::string& name;
  std::vector<double> wavelengths;  // to report on
  bool known_wavelengths;           // no: there is one, and it stands for a wavelength that nobody has said
};

std::string in_words(const Reported& reported, double wavelength) {
  return reported.known_wavelengths ? nm(wavelength) : "its wavelength";
}

Json wavelength_json(const Reported& reported, double wavelength) {
  return reported.known_wavelengths ? Json(nanometres(wavelength)) : Json(nullptr);
}

Warnings range_warnings(const Reported& reported) {
  const Model& model = reported.model;
  Warnings warnings;
  if (std::string line = unknown_range_line(reported.name, model.validity); !line.empty()) warnings.push_back(line);
  for (const double wavelength : reported.wavelengths)
    if (outside(model.validity, wavelength) & outside_wavelength)
      warnings.push_back(nm(wavelength) + " lies outside the fitted range: what is said of it is extrapolated from " +
                         nanometre_list(model.validity.wavelengths));
  for (const double wavelength : reported.wavelengths)
    if (std::string line = unsupported_line(model.validity, wavelength); !line.empty())
      warnings.push_back(in_words(reported, wavelength) + ": " + line);
  if (!knows_uncertainty(model))
    warnings.push_back("the covariance of the coefficients is not known, or not of all, and no uncertainty with it");
  for (const FittedBlock& fitted : model.blocks) {
    const std::size_t count = fitted.coefficients.size(), rank = static_cast<std::size_t>(fitted.rank);
    if (rank > 0 && rank < count)
      warnings.push_back("the data left " + std::to_string(count - rank) + " of " + count_of(count, "combination") +
                         " of block " + fitted.block.name + " free");
  }
  return warnings;
}

Json model_json(const Reported& reported) {
  const Model& model = reported.model;
  Json json{{"name", model.name.empty() ? reported.name : model.name},
            {"basis", basis_line(model)},
            {"fitted range", fitted_range(model.validity)}};
  const ReflectanceTable& table = model.reflectance;
  if (!table.values.empty())
    json["reflectance table"] =
        reflectance_line(table) + (table.covariance.empty() ? ", exact" : ", with its covariance");
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

Warnings unphysical(const ModelDiagnostics& d, const std::string& wavelength) {
  const bool fitted = d.theta_max < radians(90);
  const std::string where = (fitted ? "within the fitted angles at " : "up to the horizon at ") + wavelength;
  Warnings warnings;
  if (d.unrealizable > 0)
    warnings.push_back(std::to_string(d.unrealizable) + " of " + std::to_string(d.geometries) + " matrices " + where +
                       " cannot exist; the smallest eigenvalue / f11 is " + rounded(d.margin.value, 3) + " at " +
                       at(d.margin.geometry));
  if (std::string line = not_positive_line(d, where); !line.empty()) warnings.push_back(line);
  if (std::string line = energy_line(d, where); fitted && !line.empty()) warnings.push_back(line);
  return warnings;
}

ReportField realizability(const Reported& reported) {
  ReportField field;
  for (const double wavelength : reported.wavelengths)
    for (const double theta_max : polar_limits(reported.model.validity)) {
      const ModelDiagnostics d = model_diagnostics(reported.model, wavelength, theta_max);
      field.value.push_back({{"wavelength_nm", wavelength_json(reported, wavelength)},
                             {"theta_max_deg", degrees(theta_max)},
                             {"geometries", d.geometries},
                             {"unrealizable", d.whole ? Json(d.unrealizable) : Json(nullptr)},
                             {"smallest_margin", d.whole ? Json(d.margin.value) : Json(nullptr)},
                             {"margin_at", d.whole ? Json(at(d.margin.geometry)) : Json(nullptr)},
                             {"f11_not_positive", d.not_positive_f11},
                             {"smallest_f11", d.f11.value},
                             {"largest_dhr", d.dhr},
                             {"dhr_at_theta_i_deg", degrees(d.dhr_theta_i)}});
      std::ranges::move(unphysical(d, in_words(reported, wavelength)), std::back_inserter(field.warnings));
    }
  return field;
}

/// Quantities at one wavelength, each with its uncertainty where there is a covariance.
void add_reflectances(Json& rows, const Reported& reported, double wavelength) {
  const Model& model = reported.model;
  std::optional<UncertainModel> u;
  if (knows_uncertainty(model)) u = uncertain(model, wavelength);
  const auto add = [&](const std::string& quantity, double value, auto uncertainty) {
    rows.push_back({{"wavelength_nm", wavelength_json(reported, wavelength)},
                    {"quantity", quantity},
                    {"value", value},
                    {"u", u ? Json(uncertainty()) : Json(nullptr)}});
  };
  for (const int theta : {0, 8, 45, 60, 75}) {
    const Direction incident{radians(theta), 0};
    add("dhr, theta_i " + std::to_string(theta), directional_hemispherical_reflectance(model, wavelength, incident),
        [&] { return standard_uncertainty(directional_hemispherical_budget(*u, incident)); });
  }
  add("bhr", bihemispherical_reflectance(model, wavelength),
      [&] { return standard_uncertainty(bihemispherical_budget(*u)); });
  const PreparedModel prepared = prepare(model, wavelength);
  for (const auto& [name, geometry] : {std::pair("0:45", Geometry{{0, 0}, {radians(45), radians(180)}}),
                                       std::pair("45:0", Geometry{{radians(45), 0}, {0, 0}})})
    add(std::string("reflectance factor ") + name, reflectance_factor(prepared.f11(geometry)),
        [&, &place = geometry] { return reflectance_factor(u->fit.standard_uncertainty(place)(0, 0)); });
}

Json reflectances(const Reported& reported) {
  Json rows = Json::array();
  for (const double wavelength : reported.wavelengths) add_reflectances(rows, reported, wavelength);
  return rows;
}

/// Throws unless there is something to report on.
Reported reported(const Model& model, const std::string& name, std::span<const double> wavelengths) {
  require_valid(model);
  Reported result{
      model, name, {wavelengths.begin(), wavelengths.end()}, !wavelengths.empty() || knows_wavelength(model)};
  if (wavelengths.empty()) result.wavelengths = known_wavelengths(model);
  if (result.wavelengths.empty())
    throw std::invalid_argument(name + " does not say to which wavelengths it was fitted: give some");
  for (const double wavelength : result.wavelengths) require_wavelength(wavelength);
  return result;
}

}  // namespace

std::string report_json(const Model& model, const std::string& name, std::span<const double> wavelengths,
                        const std::optional<ReportedSamples>& samples) {
  const Reported what = reported(model, name, wavelengths);
  Json report{{"title", "Report on " + name}, {"warnings", range_warnings(what)}};
  report["model"] = model_json(what);
  report["fit"] = fit_json(model);
  if (model.posterior) report["sample"] = sample_json(*model.posterior);
  add(report, "realizability", realizability(what));
  report["reflectances"] = reflectances(what);
  if (samples) add_samples(report, model, *samples);
  return report.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace mmbrdf
