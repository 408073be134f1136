// SPDX-License-Identifier: BSD-3-Clause
#include "report_facts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "arguments.hpp"
#include "describe.hpp"
#include "files.hpp"
#include "mmbrdf/comparison.hpp"
#include "mmbrdf/description.hpp"
#include "mmbrdf/diagnostics.hpp"
#include "mmbrdf/fit.hpp"
#include "mmbrdf/noise.hpp"
#include "mmbrdf/radiometry.hpp"
#include "mmbrdf/reflectance_uncertainty.hpp"
#include "mmbrdf/uncertainty.hpp"
#include "output.hpp"

namespace mmbrdf::program {

namespace {

using Json = nlohmann::ordered_json;

// When data are said to break a symmetry: the F test alone finds the least misfit of thousands of rows significant.
constexpr double significant = 1e-3;  // p
constexpr double noticeable = 0.05;   // part by which the rms falls without the symmetry
constexpr double outlier_threshold = 5;
constexpr double high_leverage = 0.5;
constexpr std::size_t most_listed = 20;

void warn_in(Json& facts, const std::string& text) { facts["warnings"].push_back(text); }

std::string at(const Geometry& g) {
  return format("theta_i %.4g, theta_r %.4g, phi_r - phi_i %.4g degrees", degrees(g.incident.theta),
                degrees(g.reflected.theta), std::remainder(degrees(g.reflected.phi - g.incident.phi), 360));
}

std::string nm(double wavelength) { return brief(nanometres(wavelength)) + " nm"; }

/// null where the model does not depend on it, nor say to which it was fitted.
Json wavelength_json(const ReportedModel& reported, double wavelength) {
  return reported.known_wavelengths ? Json(nanometres(wavelength)) : Json(nullptr);
}

Json model_json(const ReportedModel& reported) {
  const Model& model = reported.model;
  Json json{{"name", model.name.empty() ? reported.name : model.name},
            {"basis", basis_line(model)},
            {"fitted range", fitted_range(model.validity)}};
  if (!model.reflectance.values.empty()) {
    json["reflectance table"] = reflectance_line(model.reflectance) +
                                (model.reflectance.covariance.empty() ? ", exact" : ", with its covariance");
  }
  for (const auto& [name, text] : model.provenance) {
    json[name] = text;
  }
  return json;
}

Json fit_json(const Model& model) {
  Json rows = Json::array();
  for (const FittedBlock& block : model.blocks) {
    Json row{{"block", block.block.name}, {"coefficients", block.coefficients.size()}};
    row["rank"] = block.rank > 0 ? Json(block.rank) : Json(nullptr);
    row["condition"] = block.condition > 0 ? Json(block.condition) : Json(nullptr);
    row["covariance"] = !block.covariance.empty();
    rows.push_back(row);
  }
  return rows;
}

/// Within the fitted angles, and up to the horizon.
std::vector<double> polar_limits(const Validity& validity) {
  std::vector<double> limits;
  if (validity.theta_i_max && validity.theta_r_max) {
    limits.push_back(std::max(*validity.theta_i_max, *validity.theta_r_max));
  }
  limits.push_back(radians(90));
  return limits;
}

void add_realizability(Json& facts, const ReportedModel& reported) {
  Json rows = Json::array();
  for (const double wavelength : reported.wavelengths) {
    for (const double theta_max : polar_limits(reported.model.validity)) {
      const ModelDiagnostics d = model_diagnostics(reported.model, wavelength, theta_max);
      const bool fitted = theta_max < radians(90);
      rows.push_back({{"wavelength_nm", wavelength_json(reported, wavelength)},
                      {"theta_max_deg", degrees(theta_max)},
                      {"geometries", d.geometries},
                      {"unrealizable", d.unrealizable},
                      {"smallest_margin", d.margin.value},
                      {"margin_at", at(d.margin.geometry)},
                      {"f11_not_positive", d.not_positive_f11},
                      {"smallest_f11", d.f11.value},
                      {"largest_dhr", d.dhr},
                      {"dhr_at_theta_i_deg", degrees(d.dhr_theta_i)}});
      const std::string where = (fitted ? "within the fitted angles at " : "up to the horizon at ") +
                                (reported.known_wavelengths ? nm(wavelength) : "its wavelength");
      if (d.unrealizable > 0) {
        warn_in(facts, std::to_string(d.unrealizable) + " of " + std::to_string(d.geometries) + " matrices " + where +
                           " cannot exist; the smallest eigenvalue / f11 is " + format("%.3g", d.margin.value) +
                           " at " + at(d.margin.geometry));
      }
      if (d.not_positive_f11 > 0) {
        warn_in(facts, "f11 is not positive at " + std::to_string(d.not_positive_f11) + " of " +
                           counted(d.geometries, "direction") + " " + where + ", down to " +
                           format("%.3g sr^-1 at ", d.f11.value) + at(d.f11.geometry));
      }
      if (fitted && d.dhr > 1) {
        warn_in(facts, format("the directional-hemispherical reflectance reaches %.4f at theta_i %.4g degrees, ", d.dhr,
                              degrees(d.dhr_theta_i)) +
                           (reported.known_wavelengths ? nm(wavelength) : "its wavelength") +
                           ": more light comes back than falls in");
      }
    }
  }
  facts["realizability"] = rows;
}

/// Quantities at one wavelength, each with its uncertainty where there is a covariance.
void add_reflectances_at(Json& rows, const ReportedModel& reported, double wavelength,
                         const std::optional<PreparedUncertainty>& u) {
  const Model& model = reported.model;
  const auto add = [&](const std::string& quantity, double value, std::optional<double> uncertainty) {
    rows.push_back(
        {{"wavelength_nm", wavelength_json(reported, wavelength)}, {"quantity", quantity}, {"value", value}});
    rows.back()["u"] = uncertainty ? Json(*uncertainty) : Json(nullptr);
  };
  for (const int theta : {0, 8, 45, 60, 75}) {
    const Direction incident{radians(theta), 0};
    const std::string name = "dhr, theta_i " + std::to_string(theta);
    add(name, directional_hemispherical_reflectance(model, wavelength, incident),
        u ? std::optional(directional_hemispherical_uncertainty(model, *u, incident)) : std::nullopt);
  }
  add("bhr", bihemispherical_reflectance(model, wavelength),
      u ? std::optional(bihemispherical_uncertainty(model, *u)) : std::nullopt);
  const PreparedModel prepared = prepare(model, wavelength);
  for (const auto& [name, geometry] :
       {std::pair("reflectance factor 0:45", Geometry{{0, 0}, {radians(45), radians(180)}}),
        std::pair("reflectance factor 45:0", Geometry{{radians(45), 0}, {0, 0}})}) {
    add(name, reflectance_factor(prepared.f11(geometry)),
        u ? std::optional(reflectance_factor(standard_uncertainty(u->evaluate(geometry))(0, 0))) : std::nullopt);
  }
}

void add_reflectances(Json& facts, const ReportedModel& reported) {
  Json rows = Json::array();
  const bool known = knows_uncertainty(reported.model);
  for (const double wavelength : reported.wavelengths) {
    add_reflectances_at(rows, reported, wavelength,
                        known ? std::optional(prepare_uncertainty(reported.model, wavelength)) : std::nullopt);
  }
  facts["reflectances"] = rows;
}

Json difference_json(const std::string& element, const std::string& unit, const Difference& d) {
  return {{"element", element},  {"unit", unit},         {"rms", d.rms},
          {"mean", d.mean},      {"largest", d.largest}, {"wavelength_nm", nanometres(d.wavelength)},
          {"at", at(d.geometry)}};
}

void add_residuals(Json& facts, const ReportedModel& reported, std::span<const Sample> samples) {
  const Comparison comparison = compare(reported.model, samples);
  Json rows = Json::array();
  rows.push_back(difference_json("11", "sr^-1", comparison.f11));
  rows.push_back(difference_json("11", "f11", comparison.f11_relative));
  for (std::size_t e = 1; e < 16; ++e) {
    rows.push_back(difference_json(element_name(e), "f11", comparison.normalized[e]));
  }
  facts["residuals"] = rows;
}

Json tests_json(const std::vector<FTest>& tests) {
  Json rows = Json::array();
  for (const FTest& test : tests) {
    rows.push_back({{"block", test.block},
                    {"rows", test.rows},
                    {"more_coefficients", test.extra},
                    {"rms", test.rms},
                    {"rms_without", test.rms_extended},
                    {"F", test.f},
                    {"p", test.p}});
  }
  return rows;
}

void warn_of_tests(Json& facts, const std::vector<FTest>& tests, const std::string& what) {
  for (const FTest& test : tests) {
    if (test.p < significant && test.rms_extended < (1 - noticeable) * test.rms) {
      warn_in(facts, "the data break " + what + " in block " + test.block +
                         format(": F = %.3g, and without it the rms falls from %.3g to %.3g", test.f, test.rms,
                                test.rms_extended));
    }
  }
}

void add_symmetries(Json& facts, const ReportedModel& reported, std::span<const Sample> samples) {
  const SymmetryTests tests = symmetry_tests(samples, orders(reported.model), reported.model.mapping);
  facts["reciprocity"] = tests_json(tests.reciprocity);
  facts["mirror_symmetry"] = tests_json(tests.mirror);
  facts["dependence_on_phi_i"] = tests_json(tests.azimuth);
  warn_of_tests(facts, tests.reciprocity, "reciprocity");
  warn_of_tests(facts, tests.mirror, "mirror symmetry");
  warn_of_tests(facts, tests.azimuth, "isotropy");
  if (tests.one_azimuth) {
    facts["dependence_on_phi_i"] =
        "the source has one azimuth in these data: whether the sample is isotropic cannot be told";
  }
}

void add_noise(Json& facts, const ReportedModel& reported, std::span<const Sample> samples) {
  Json rows = Json::array();
  for (const double wavelength : mmbrdf::wavelengths(samples)) {
    const std::vector<Sample> here = at_wavelengths(samples, std::array{wavelength});
    Json row{{"wavelength_nm", nanometres(wavelength)}};
    try {
      const NoiseEstimate noise = estimate_noise(here, residuals(reported.model, here));
      const double u_scale = noise.law.scale * std::sqrt(noise.covariance[0]);
      row.update({{"scale", noise.law.scale},
                  {"u_scale", u_scale},
                  {"exponent_cos_theta_i", noise.law.incident_exponent},
                  {"u_exponent_i", std::sqrt(noise.covariance[4])},
                  {"exponent_cos_theta_r", noise.law.reflected_exponent},
                  {"u_exponent_r", std::sqrt(noise.covariance[8])}});
      rows.push_back(row);
    } catch (const std::invalid_argument& error) {
      warn_in(facts, "the law of the noise at " + nm(wavelength) + " is not known: " + plain_message(error));
    }
  }
  facts["noise"] = rows;
}

/// Of a fit of the same basis to these samples, without weights.
void add_outliers(Json& facts, const ReportedModel& reported, std::span<const Sample> samples) {
  const Model& model = reported.model;
  FitOptions options;
  options.minimum_norm = true;
  if (!model.reflectance.values.empty() && wavelengths(samples).size() > 1) {
    options.reflectance = ReflectanceTable{model.reflectance.wavelengths, model.reflectance.values};
  }
  const FitResult result = fit(samples, {model.family, orders(model), model.mapping}, options);
  const SampleDiagnostics diagnostics = sample_diagnostics(samples, result);
  Json leverage = Json::array();
  for (const SampleDiagnostics::Leverage& block : diagnostics.leverage) {
    const double largest = block.values[block.largest];
    leverage.push_back({{"block", block.block},
                        {"rank", block.rank},
                        {"largest_leverage", largest},
                        {"sample", block.largest + 1},
                        {"at", at(samples[block.largest].geometry)}});
    if (largest > high_leverage) {
      warn_in(facts, format("sample %zu decides block ", block.largest + 1) + block.block +
                         format(" almost alone where it is: its leverage is %.2f", largest));
    }
  }
  facts["leverage"] = leverage;
  const std::vector<Outlier> found = outliers(diagnostics, outlier_threshold);
  Json rows = Json::array();
  for (std::size_t i = 0; i < std::min(found.size(), most_listed); ++i) {
    const Sample& sample = samples[found[i].sample];
    rows.push_back({{"sample", found[i].sample + 1},
                    {"element", element_name(found[i].element)},
                    {"studentized", found[i].studentized},
                    {"wavelength_nm", nanometres(sample.wavelength)},
                    {"at", at(sample.geometry)}});
  }
  facts["outliers"] = rows;
  if (!found.empty()) {
    warn_in(facts, counted(static_cast<long>(found.size()), "element") +
                       format(" of samples lie more than %g standard deviations off; the largest are listed",
                              outlier_threshold));
  }
}

void warn_of_range(Json& facts, const ReportedModel& reported) {
  if (const std::string line = unknown_range_line(reported.name, reported.model.validity); !line.empty()) {
    warn_in(facts, line);
  }
  for (const double wavelength : reported.wavelengths) {
    if (outside(reported.model.validity, wavelength, {}) & outside_wavelength) {
      warn_in(facts, nm(wavelength) + " lies outside the fitted range: what is said of it is extrapolated from " +
                         nanometre_list(reported.model.validity.wavelengths));
    }
  }
  if (!knows_uncertainty(reported.model)) {
    warn_in(facts, "the covariance of the coefficients is not known, or not of all, and no uncertainty with it");
  }
  for (const FittedBlock& block : reported.model.blocks) {
    if (block.rank > 0 && static_cast<std::size_t>(block.rank) < block.coefficients.size()) {
      warn_in(facts, "the data left " +
                         std::to_string(block.coefficients.size() - static_cast<std::size_t>(block.rank)) + " of " +
                         counted(static_cast<long>(block.coefficients.size()), "combination") + " of block " +
                         block.block.name + " free");
    }
  }
}

}  // namespace

Json model_facts(const ReportedModel& reported) {
  Json facts{{"title", "Report on " + reported.name}};
  facts["warnings"] = Json::array();
  warn_of_range(facts, reported);
  facts["model"] = model_json(reported);
  facts["fit"] = fit_json(reported.model);
  add_realizability(facts, reported);
  add_reflectances(facts, reported);
  return facts;
}

void add_data_facts(Json& facts, const ReportedModel& reported, const std::string& data,
                    std::span<const Sample> samples) {
  facts["data"] = Json{{"name", data},
                       {"samples", samples.size()},
                       {"wavelengths", nanometre_list(wavelengths(samples))},
                       {"residuals and noise", "of the model as it is"},
                       {"symmetries, leverage and outliers", "of fits of its basis to these samples, without weights"}};
  const auto leaves = [&](const Sample& s) {
    return leaves_known_range(outside(reported.model.validity, s.wavelength, s.geometry));
  };
  if (const auto count = std::count_if(samples.begin(), samples.end(), leaves); count > 0) {
    warn_in(facts, std::to_string(count) + " of " + counted(static_cast<long>(samples.size()), "sample") +
                       " lie outside the range that the model was fitted to: their residuals are of extrapolations");
  }
  add_residuals(facts, reported, samples);
  add_symmetries(facts, reported, samples);
  add_noise(facts, reported, samples);
  add_outliers(facts, reported, samples);
}

}  // namespace mmbrdf::program
