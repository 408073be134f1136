// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/quantities/report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/fitting/leverage.hpp"
#include "mmbrdf/fitting/symmetry.hpp"
#include "mmbrdf/mixed/sample_traits.hpp"
#include "mmbrdf/model/description.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/quantities/conventions.hpp"
#include "mmbrdf/quantities/fit_warnings.hpp"
#include "mmbrdf/quantities/trust.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"
#include "mmbrdf/radiometry/reflectance_uncertainty.hpp"
#include "mmbrdf/samples/comparison.hpp"
#include "mmbrdf/samples/noise.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using Json = nlohmann::ordered_json;
using Warnings = std::vector<std::string>;

struct Reported {
  const Model& model;
  const std::string& name;
  std::vector<double> wavelengths;  // to report on
  bool known_wavelengths;           // no: there is one, and it stands for a wavelength that nobody has said
};

/// A field of the report, and what there is to warn of in it.
struct Field {
  Json value = Json::array();
  Warnings warnings{};
};

std::string at(const Geometry& geometry) { return place_line(geometry); }

std::string count_of(std::size_t count, const std::string& what) { return counted(static_cast<long>(count), what); }

std::string nm(double wavelength) { return nanometre_list(std::array{wavelength}); }

std::string nm(const Reported& reported, double wavelength) {
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
      warnings.push_back(nm(reported, wavelength) + ": " + line);
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

Field realizability(const Reported& reported) {
  Field field;
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
      std::ranges::move(unphysical(d, nm(reported, wavelength)), std::back_inserter(field.warnings));
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
        [&, &place = geometry] { return reflectance_factor(standard_uncertainty(u->fit.evaluate(place))(0, 0)); });
}

Json reflectances(const Reported& reported) {
  Json rows = Json::array();
  for (const double wavelength : reported.wavelengths) add_reflectances(rows, reported, wavelength);
  return rows;
}

Field data_field(const Model& model, const ReportedSamples& data) {
  Field field{{{"name", data.name},
               {"samples", data.samples.size()},
               {"wavelengths", nanometre_list(wavelengths(data.samples))},
               {"residuals and noise", "of the model as it is"},
               {"chi_squared", "of fits of its basis to these samples, weighted by their uncertainties"},
               {"conventions, symmetries, repeats, leverage and outliers",
                "of fits of its basis to these samples, without weights"}}};
  RangeCount range;
  for (const Sample& s : data.samples) range.add(outside(model.validity, s.wavelength, s.geometry));
  if (range.outside > 0) field.warnings.push_back(range.line("sample") + ": residuals there are of extrapolations");
  return field;
}

Json difference_json(const std::string& element, const std::string& unit, const Difference& d) {
  return {{"element", element},  {"unit", unit},         {"rms", d.rms},
          {"mean", d.mean},      {"largest", d.largest}, {"wavelength_nm", nanometres(d.wavelength)},
          {"at", at(d.geometry)}};
}

Json residuals_json(const Comparison& comparison) {
  Json rows = Json::array();
  rows.push_back(difference_json("11", "sr^-1", comparison.f11));
  rows.push_back(difference_json("11", "f11", comparison.f11_relative));
  for (std::size_t e = 1; e < 16; ++e)
    if (comparison.normalized[e].samples > 0)
      rows.push_back(difference_json(element_name(e), "f11", comparison.normalized[e]));
  return rows;
}

Field conventions(const Model& model, std::span<const Sample> samples) {
  const std::vector<ConventionFit> fits = convention_fits(samples, orders(model), model.mapping);
  Field field;
  for (const auto& [read_as, rms] : fits) field.value.push_back({{"read_as", read_as}, {"rms", rms}});
  if (std::string line = convention_warning(fits); !line.empty()) field.warnings.push_back(line);
  return field;
}

/// The tests of a symmetry; `what` is what the data are said to break.
Field symmetry(const std::vector<FTest>& tests, const std::string& what) {
  Field field;
  for (const FTest& test : tests) {
    field.value.push_back({{"block", test.block},
                           {"rows", test.rows},
                           {"more_coefficients", test.extra},
                           {"rms", test.rms},
                           {"rms_without", test.rms_extended},
                           {"F", test.f},
                           {"p", test.p}});
    if (test.p < significant_p && test.rms_extended < (1 - noticeable_fall) * test.rms)
      field.warnings.push_back("the data break " + what + " in block " + test.block + ": F = " + rounded(test.f, 3) +
                               ", and without it the rms falls from " + rounded(test.rms, 3) + " to " +
                               rounded(test.rms_extended, 3));
  }
  return field;
}

Field noise(const Model& model, std::span<const Sample> samples) {
  Field field;
  for (const double wavelength : wavelengths(samples)) {
    const std::vector<Sample> here = at_wavelengths(samples, std::array{wavelength});
    try {
      const auto& [law, covariance, rows] = estimate_noise(here, residuals(model, here));
      field.value.push_back({{"wavelength_nm", nanometres(wavelength)},
                             {"scale", law.scale},
                             {"u_scale", law.scale * std::sqrt(covariance[0])},
                             {"exponent_cos_theta_i", law.incident_exponent},
                             {"u_exponent_i", std::sqrt(covariance[4])},
                             {"exponent_cos_theta_r", law.reflected_exponent},
                             {"u_exponent_r", std::sqrt(covariance[8])}});
    } catch (const std::invalid_argument& error) {
      field.warnings.push_back("the law of the noise at " + nm(wavelength) + " is not known: " + error.what());
    }
  }
  return field;
}

/// A fit of the same basis to these samples.
FitResult refitted(const Model& model, std::span<const Sample> samples, Weights weights) {
  FitOptions options;
  options.minimum_norm = true;
  if (!model.reflectance.values.empty() && wavelengths(samples).size() > 1)
    options.reflectance = ReflectanceTable{model.reflectance.wavelengths, model.reflectance.values};
  return fit(samples, {model.family, orders(model), model.mapping, model.rotation}, options, weights);
}

bool knows_all_uncertainties(const Sample& sample) {
  const Elements unknown = not_measured(sample);
  for (std::size_t e = 0; e < 16; ++e)
    if (!unknown[e] && !(sample.uncertainty.elements[e] > 0)) return false;
  return true;
}

/// And what the samples say against themselves.
Field chi_squared(const FitResult& fitted) {
  Field field{"the samples do not state the uncertainties of all their elements: what chi^2 would be is not known",
              data_warnings(fitted)};
  if (fitted.weights != Weights::data) return field;
  field.value = Json::array();
  long freedom = 0;
  for (std::size_t b = 0; b < fitted.solutions.size(); ++b) {
    const Solution& solution = fitted.solutions[b];
    field.value.push_back({{"block", fitted.model.blocks[b].block.name},
                           {"degrees_of_freedom", solution.degrees_of_freedom()},
                           {"chi_squared_per_dof", solution.variance()}});
    freedom += b > 0 ? solution.degrees_of_freedom() : 0;
  }
  field.value.push_back({{"block", "all but 11"},
                         {"degrees_of_freedom", freedom},
                         {"chi_squared_per_dof", chi_squared_per_dof(fitted).others}});
  return field;
}

Field leverage(const SampleDiagnostics& diagnostics, std::span<const Sample> samples) {
  Field field;
  for (const SampleDiagnostics::Leverage& block : diagnostics.leverage) {
    const double largest = block.values[block.largest];
    field.value.push_back({{"block", block.block},
                           {"rank", block.rank},
                           {"largest_leverage", largest},
                           {"sample", block.largest + 1},
                           {"at", at(samples[block.largest].geometry)}});
    if (largest > high_leverage)
      field.warnings.push_back("sample " + std::to_string(block.largest + 1) + " decides block " + block.block +
                               " almost alone where it is: its leverage is " + fixed(largest, 2));
  }
  return field;
}

Field outlier_field(const SampleDiagnostics& diagnostics, std::span<const Sample> samples) {
  const std::vector<Outlier> found = outliers(diagnostics, outlier_threshold);
  Field field;
  for (const Outlier& outlier : std::span(found).first(std::min(found.size(), listed_outliers))) {
    const Sample& sample = samples[outlier.sample];
    field.value.push_back({{"sample", outlier.sample + 1},
                           {"element", element_name(outlier.element)},
                           {"studentized", outlier.studentized},
                           {"wavelength_nm", nanometres(sample.wavelength)},
                           {"at", at(sample.geometry)}});
  }
  if (!found.empty())
    field.warnings.push_back(count_of(found.size(), "element") + " of samples lie more than " +
                             shortest(outlier_threshold) + " standard deviations off; the largest are listed");
  return field;
}

/// What repeats say of the misfit: a table, or the sentence that there are none.
Field repeats(std::span<const Sample> samples, const FitResult& fitted) {
  Field field;
  for (const LackOfFit& test : lack_of_fit(samples, fitted)) {
    if (test.repeats == 0) return {"no geometry was measured twice: repeats would tell noise from misfit"};
    field.value.push_back({{"block", test.block},
                           {"repeats", test.repeats},
                           {"pure_error", test.pure_error},
                           {"misfit", test.misfit},
                           {"F", test.f},
                           {"p", test.p}});
    if (test.p < significant_p && test.misfit > (1 + noticeable_fall) * test.pure_error)
      field.warnings.push_back("the model misses block " + test.block +
                               " by more than repeats scatter: F = " + rounded(test.f, 3) + ", " +
                               rounded(test.misfit, 3) + " against " + rounded(test.pure_error, 3));
  }
  return field;
}

void add(Json& report, const std::string& name, Field field) {
  report[name] = std::move(field.value);
  for (std::string& warning : field.warnings) report["warnings"].push_back(std::move(warning));
}

void add_samples(Json& report, const Model& model, const ReportedSamples& data) {
  add(report, "data", data_field(model, data));
  const Comparison compared = compare(model, data.samples);
  Field differences{residuals_json(compared)};
  if (compared.dark > 0) differences.warnings.push_back(dark_line(compared));
  add(report, "residuals", std::move(differences));
  const FitResult unweighted = refitted(model, data.samples, Weights::none);
  const bool weighs = std::ranges::all_of(data.samples, knows_all_uncertainties);
  add(report, "chi_squared", chi_squared(weighs ? refitted(model, data.samples, Weights::data) : unweighted));
  add(report, "conventions", conventions(model, data.samples));
  const SymmetryTests tests = symmetry_tests(data.samples, orders(model), model.mapping);
  add(report, "reciprocity", symmetry(tests.reciprocity, "reciprocity"));
  add(report, "mirror_symmetry", symmetry(tests.mirror, "mirror symmetry"));
  add(report, "dependence_on_phi_i", symmetry(tests.azimuth, "isotropy"));
  if (tests.one_azimuth)
    report["dependence_on_phi_i"] =
        "the source has one azimuth in these data: whether the sample is isotropic cannot be told";
  add(report, "noise", noise(model, data.samples));
  add(report, "repeats", repeats(data.samples, unweighted));
  const SampleDiagnostics diagnostics = sample_diagnostics(data.samples, unweighted);
  add(report, "leverage", leverage(diagnostics, data.samples));
  add(report, "outliers", outlier_field(diagnostics, data.samples));
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
