// SPDX-License-Identifier: BSD-3-Clause
// What samples say of a model, and of themselves. Part of report.hpp.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>

#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/fitting/leverage.hpp"
#include "mmbrdf/fitting/symmetry.hpp"
#include "mmbrdf/quantities/conventions.hpp"
#include "mmbrdf/quantities/fit_warnings.hpp"
#include "mmbrdf/samples/comparison.hpp"
#include "mmbrdf/samples/noise.hpp"
#include "quantities/report_fields.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

ReportField data_field(const Model& model, const ReportedSamples& data) {
  ReportField field{{{"name", data.name},
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

ReportField conventions_field(const Model& model, std::span<const Sample> samples) {
  const std::vector<ConventionFit> fits = convention_fits(samples, orders(model), model.mapping);
  ReportField field;
  for (const ConventionFit& fit : fits) field.value.push_back({{"read_as", fit.read_as}, {"rms", fit.rms}});
  if (std::string line = convention_warning(fits); !line.empty()) field.warnings.push_back(line);
  return field;
}

/// The tests of a symmetry; `what` is what the data are said to break.
ReportField symmetry(const std::vector<FTest>& tests, const std::string& what) {
  ReportField field;
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

ReportField noise(const Model& model, std::span<const Sample> samples) {
  ReportField field;
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
      field.notes.push_back("the law of the noise at " + nm(wavelength) + " is not known: " + error.what());
    }
  }
  return field;
}

/// Of each element what the model knows: blocks are known or not as a whole, so in any frame.
std::vector<Sample> known_to(const Model& model, std::span<const Sample> samples) {
  std::vector<Sample> result(samples.begin(), samples.end());
  const auto forget = [&](Mueller& m) {
    for (std::size_t e = 1; e < 16; ++e)
      if (model.not_measured[e]) m.elements[e] = std::numeric_limits<double>::quiet_NaN();
  };
  for (Sample& sample : result) {
    forget(sample.normalized);
    if (!sample.as_measured) continue;
    AsMeasured as_measured = *sample.as_measured;
    forget(as_measured.normalized);
    sample.as_measured = std::make_shared<const AsMeasured>(as_measured);
  }
  return result;
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
ReportField chi_squared(const FitResult& fitted) {
  ReportField field{
      "the samples do not state the uncertainties of all their elements: what chi^2 would be is not known",
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

ReportField leverage(const SampleDiagnostics& diagnostics, std::span<const Sample> samples) {
  ReportField field;
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

ReportField outlier_field(const SampleDiagnostics& diagnostics, std::span<const Sample> samples) {
  const std::vector<Outlier> found = outliers(diagnostics, outlier_threshold);
  ReportField field;
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
ReportField repeats(std::span<const Sample> samples, const FitResult& fitted) {
  ReportField field;
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

/// Azimuth and polar angle of a source in tenths of degrees, as pictures of samples tell them apart; without an azimuth near
/// the normal.
constexpr double normal_deg = 0.2, same_azimuth_deg = 0.4;
double tenths(double angle) { return std::round(10 * degrees(angle)) / 10; }
double azimuth_of(const Sample& s) {
  const double phi = std::fmod(tenths(s.geometry.incident.phi), 360);
  return phi < 0 ? phi + 360 : phi;
}

/// Angles of incidence of the samples from one azimuth.
std::vector<double> incidence_angles(std::span<const Sample> samples, double phi_deg) {
  std::set<double> angles;
  for (const Sample& s : samples) {
    const double turn = std::remainder(degrees(s.geometry.incident.phi) - phi_deg, 360);
    if (std::abs(turn) < same_azimuth_deg || degrees(s.geometry.incident.theta) < normal_deg)
      angles.insert(tenths(s.geometry.incident.theta));
  }
  const std::vector<double> all(angles.begin(), angles.end());
  if (all.empty()) return {};
  const std::set<double> shown{all.front(), all[all.size() / 2], all.back()};
  return {shown.begin(), shown.end()};
}

/// Which directions pictures show.
Json directions_json(std::span<const Sample> samples) {
  constexpr std::size_t many = 50;
  constexpr double from_the_left = 180;
  std::set<std::array<double, 3>> sources;
  std::map<double, int> azimuths;
  for (const Sample& s : samples) {
    sources.insert({s.wavelength, tenths(s.geometry.incident.theta), azimuth_of(s)});
    if (degrees(s.geometry.incident.theta) >= normal_deg) ++azimuths[azimuth_of(s)];
  }
  const std::vector<double> measured = wavelengths(samples);
  const bool grid = samples.size() >= many * sources.size();
  const auto most = std::ranges::max_element(azimuths, {}, [](const auto& one) { return one.second; });
  const double phi = grid && most != azimuths.end() ? most->first : from_the_left;
  Json json{{"wavelengths_nm", Json::array()}, {"grid", grid}, {"phi_i_deg", phi}};
  for (const double one : measured) json["wavelengths_nm"].push_back(nanometres(one));
  const double middle = measured[(measured.size() - 1) / 2];
  json["theta_i_deg"] = incidence_angles(at_wavelengths(samples, std::array{middle}), phi);
  return json;
}

}  // namespace

void add_samples(Json& report, const Model& model, const ReportedSamples& data) {
  const Comparison compared = compare(model, data.samples);  // refuses no samples
  add(report, "data", data_field(model, data));
  report["directions"] = directions_json(data.samples);
  ReportField differences{residuals_json(compared)};
  if (compared.dark > 0) differences.warnings.push_back(dark_line(compared));
  add(report, "residuals", std::move(differences));
  const std::vector<Sample> known = known_to(model, data.samples);
  const FitResult unweighted = refitted(model, known, Weights::none);
  const bool weighs = std::ranges::all_of(known, knows_all_uncertainties, in_own_frame);
  add(report, "chi_squared", chi_squared(weighs ? refitted(model, known, Weights::data) : unweighted));
  add(report, "conventions", conventions_field(model, data.samples));
  const SymmetryTests tests = symmetry_tests(known, orders(model), model.mapping);
  add(report, "reciprocity", symmetry(tests.reciprocity, "reciprocity"));
  add(report, "mirror_symmetry", symmetry(tests.mirror, "mirror symmetry"));
  add(report, "dependence_on_phi_i", symmetry(tests.azimuth, "isotropy"));
  if (tests.one_azimuth)
    report["dependence_on_phi_i"] =
        "the source has one azimuth in these data: whether the sample is isotropic cannot be told";
  add(report, "noise", noise(model, known));
  add(report, "repeats", repeats(known, unweighted));
  const SampleDiagnostics diagnostics = sample_diagnostics(known, unweighted);
  add(report, "leverage", leverage(diagnostics, known));
  add(report, "outliers", outlier_field(diagnostics, known));
}

}  // namespace mmbrdf
