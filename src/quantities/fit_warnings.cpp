// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/quantities/fit_warnings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "mmbrdf/model/description.hpp"
#include "mmbrdf/quantities/conventions.hpp"
#include "mmbrdf/quantities/trust.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr double folded = 1.5;  // times the rms of the other elements: beyond it the mirror-odd ones are mixed up
constexpr int coarser = 2;      // than the steps of a report
constexpr std::size_t enough_samples = 60;
constexpr double beyond_doubt = 2;
constexpr double rounding = 1e-9;  // rms of simulated data without noise

/// Of the elements that change sign where the sample is seen in a mirror, or of the others but 11.
double rms_of_elements(const FitResult& result, bool odd) {
  double squares = 0;
  for (std::size_t e = 1; e < 16; ++e)
    if (((e / 4 < 2) != (e % 4 < 2)) == odd) squares += result.elements[e].rms * result.elements[e].rms;
  return std::sqrt(squares / (odd ? 8 : 7));
}

std::string sides_warning(const FitResult& result) {
  if (result.sides == plane_of_incidence)
    return "measured in one plane only, that of incidence: the model says nothing of directions outside of it";
  if ((result.sides & negative_side) && (result.sides & positive_side)) return "";
  const double odd = rms_of_elements(result, true), even = rms_of_elements(result, false);
  return "all samples lie on one side of the plane of incidence (phi_r - phi_i " +
         std::string(result.sides & positive_side ? "0 to 180" : "-180 to 0") +
         " degrees): whether the sample is handed cannot be told" +
         (odd > std::max(folded * even, rounding)
              ? "; were azimuths of the other side folded onto it? Elements 13, 14, 23, 24, 31, 32, 41, "
                "42 change their sign with the side, and fit " +
                    rounded(odd / even, 2) + " times as badly as the others"
              : "");
}

/// Samples that lack elements reach beyond the range, which is where all were measured.
std::string range_warning(const Validity& validity, std::span<const Sample> samples) {
  constexpr double edge = 1e-6;
  double theta_i = 0, theta_r = 0;
  for (const Sample& sample : samples) {
    theta_i = std::max(theta_i, sample.geometry.incident.theta);
    theta_r = std::max(theta_r, sample.geometry.reflected.theta);
  }
  if (theta_i <= validity.theta_i_max.value_or(theta_i) + edge &&
      theta_r <= validity.theta_r_max.value_or(theta_r) + edge)
    return "";
  return "not all elements were measured beyond " + angles_line(validity) + ": there the model is called extrapolated";
}

std::string chi_squared_warning(const FitResult& result) {
  const auto [f11, others] = chi_squared_per_dof(result);
  if (result.weights != Weights::data || !(std::max(f11, others) > high_chi_squared)) return "";
  std::size_t worst = 0;
  for (std::size_t b = 1; b < result.solutions.size(); ++b)
    if (result.solutions[b].variance() > result.solutions[worst].variance()) worst = b;
  return "chi^2 per degree of freedom is " + rounded(f11, 3) + " for f11 and " + rounded(others, 3) +
         " for the others, most in block " + result.model.blocks[worst].block.name + " (" +
         rounded(result.solutions[worst].variance(), 3) +
         "): the data are not as their uncertainties and the model say. Usual causes: another frame or sign "
         "convention, "
         "a dial that turns the other way, exchanged arms, outliers, orders too low";
}

std::string condition_warning(const FitResult& result) {
  std::string list;
  for (const FittedBlock& block : result.model.blocks)
    if (block.condition > high_condition && !result.model.posterior)
      list += (list.empty() ? "" : ", ") + block.block.name + " (" + rounded(block.condition, 2) + ")";
  if (list.empty()) return "";
  return "the data barely determine some combinations of coefficients: the condition is large in block " + list +
         "; choose lower orders, or trust the model only where its uncertainty is small";
}

/// Of the first wavelength, evenly spread.
std::vector<Sample> without_fills(std::span<const Sample> samples) {
  const double typical = typical_f11(samples);
  std::vector<Sample> here;
  std::ranges::copy_if(samples, std::back_inserter(here), [&](const Sample& s) {
    return same_wavelength(s.wavelength, samples.front().wavelength) && !is_fill(s, typical);
  });
  const std::size_t count = std::min(here.size(), most_tried);
  for (std::size_t i = 0; i < count; ++i) here[i] = here[i * here.size() / count];
  here.resize(count);
  return here;
}

double rms_of_f11(std::span<const Sample> samples) {
  double squares = 0, count = 0;
  for (const Sample& sample : samples)
    if (!std::isnan(sample.f11)) squares += sample.f11 * sample.f11, ++count;
  return count > 0 ? std::sqrt(squares / count) : 0;
}

double relative_rms(std::span<const Sample> samples, const FitResult& fitted) {
  const double all = rms_of_f11(samples);
  return all > 0 ? fitted.elements[0].rms / all : 0;
}

/// Reciprocity tells whether f11 has a cosine of the receiver too many or too few.
Finding cosine_finding(std::span<const Sample> samples, const FitOptions& options) {
  constexpr double grazing = 0.1;  // cos θr: the division would make noise of it
  const auto residual = [&](int power) {
    std::vector<Sample> scaled;
    for (Sample sample : samples) {
      const double cosine = std::cos(sample.geometry.reflected.theta);
      if (cosine < grazing || std::isnan(sample.f11)) continue;
      sample.f11 *= std::pow(cosine, power);
      for (std::size_t e = 1; e < 16; ++e) sample.normalized.elements[e] = std::numeric_limits<double>::quiet_NaN();
      sample.uncertainty = {};
      scaled.push_back(sample);
    }
    return relative_rms(scaled, fit(scaled, {Family::isotropic, inspected_orders}, options));
  };
  const double as_is = residual(0), divided = residual(-1), multiplied = residual(1);
  const bool too_many = divided <= multiplied;
  const double better = std::max(std::min(divided, multiplied), rounding);
  if (!(as_is > better_convention * better)) return {};
  return {"cosine",
          "a reciprocal f11 leaves " + rounded(100 * as_is, 2) + " %, but " + rounded(100 * better, 2) +
              " % after it is " + (too_many ? "divided" : "multiplied") + " by cos theta_r",
          too_many ? "is it f cos theta_r? Call the column f_cos (columns f_cos=f11)"
                   : "was it divided by cos theta_r once too often? Multiply the column by it"};
}

std::string convention_remedy(std::span<const ConventionFit> fits) {
  const std::string& best = std::ranges::min_element(fits, {}, &ConventionFit::rms)->read_as;
  if (best.starts_with("frame ")) return "frame " + best.substr(6) + " (--frame)";
  if (best.find("transposed") != std::string::npos)
    return "exchange m12 and m21, m13 and m31 ..., or change the signs of 13, 31, 23, 32, 34 and 43";
  return "change the signs in the table; where both beams have another convention: --convention";
}

void add(std::vector<std::string>& warnings, std::string line) {
  if (!line.empty()) warnings.push_back(std::move(line));
}

}  // namespace

ReducedChiSquared chi_squared_per_dof(const FitResult& result) {
  std::array<double, 2> squares{}, freedom{};  // of f11, of the others
  for (std::size_t e = 0; e < 16; ++e) {
    squares[e > 0] += result.elements[e].chi_squared;
    freedom[e > 0] += static_cast<double>(result.elements[e].rows);
  }
  for (std::size_t b = 0; b < result.solutions.size(); ++b)
    freedom[result.model.blocks[b].block.elements.front().index() > 0] -= result.solutions[b].rank;
  const auto ratio = [&](std::size_t part) { return freedom[part] > 0 ? squares[part] / freedom[part] : 0; };
  return {ratio(0), ratio(1)};
}

std::vector<std::string> data_warnings(const FitResult& result) {
  std::vector<std::string> warnings;
  add(warnings, sides_warning(result));
  add(warnings, chi_squared_warning(result));
  add(warnings, condition_warning(result));
  return warnings;
}

Inspection inspect(std::span<const Sample> samples) {
  Inspection result;
  result.findings = row_findings(samples);
  if (samples.empty()) throw std::invalid_argument("there are no samples");
  const std::vector<Sample> some = without_fills(samples);
  FitOptions options;
  options.minimum_norm = true;
  try {
    const FitResult fitted = fit(some, {Family::isotropic, inspected_orders}, options);
    const Validity& validity = fitted.model.validity;
    result.sides = fitted.sides;
    result.f11_residual = relative_rms(some, fitted);
    result.unsupported = unsupported_share(validity, some.front().wavelength);
    result.hole = unsupported_line(validity, some.front().wavelength);
    const auto found = f11_diagnostics(fitted.model, some.front().wavelength, fitted_theta_max(validity), coarser);
    // Few samples leave much to the smallest norm.
    if (const std::string line = energy_line(found, "of a fit of low order");
        !line.empty() && (some.size() >= enough_samples || found.dhr > beyond_doubt))
      result.findings.push_back({"scale of f11", line, ""});
    if (Finding cosine = cosine_finding(some, options); !cosine.fault.empty()) result.findings.push_back(cosine);
    if (const std::string line = sides_warning(fitted); line.find("folded") != std::string::npos)
      result.findings.push_back({"azimuths", line, "give phi_i and phi_r as they were, from -180 to 180 or 0 to 360"});
    if (const auto fits = convention_fits(some, inspected_orders); !convention_warning(fits).empty())
      result.findings.push_back({"frame or signs", convention_warning(fits), convention_remedy(fits)});
  } catch (const std::invalid_argument& error) {
    result.findings.push_back({"no fit", error.what(), ""});
  }
  return result;
}

std::vector<std::string> fit_warnings(const FitResult& result, std::span<const Sample> samples,
                                      std::span<const long> numbers) {
  std::vector<std::string> warnings = result.warnings;
  for (const Finding& finding : row_findings(samples, numbers)) add(warnings, to_string(finding));
  std::ranges::move(data_warnings(result), std::back_inserter(warnings));
  const Model& model = result.model;
  const std::vector<double>& wavelengths = model.validity.wavelengths;
  const std::size_t count = std::min(wavelengths.size(), most_checked);
  double emptiest = 0, share = 0;     // the wavelength of which most is not supported
  F11Diagnostics brightest, darkest;  // the worst of all wavelengths, of which one is told
  for (std::size_t i = 0; i < count; ++i) {
    const double wavelength = wavelengths[i * wavelengths.size() / count];
    const F11Diagnostics found = f11_diagnostics(model, wavelength, fitted_theta_max(model.validity), coarser);
    if (found.dhr - found.u_dhr > brightest.dhr - brightest.u_dhr) brightest = found;
    const double here = unsupported_share(model.validity, wavelength);
    if (here > share) emptiest = wavelength;
    share = std::max(share, here);
    if (found.not_positive_f11 > darkest.not_positive_f11) darkest = found;
  }
  const auto where = [](const F11Diagnostics& found) {
    return "within the fitted angles at " + nanometre_list(std::array{found.wavelength});
  };
  if (share > 0) add(warnings, unsupported_line(model.validity, emptiest));
  add(warnings, energy_line(brightest, where(brightest)));
  add(warnings, not_positive_line(darkest, where(darkest)));
  add(warnings, range_warning(model.validity, samples));
  if (!samples.empty()) add(warnings, convention_warning(samples, orders(model), model.mapping));
  return warnings;
}

}  // namespace mmbrdf
