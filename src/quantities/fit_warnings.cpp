// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/quantities/fit_warnings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "mmbrdf/model/description.hpp"
#include "mmbrdf/quantities/conventions.hpp"
#include "mmbrdf/quantities/trust.hpp"
#include "quantities/angle_unit.hpp"
#include "quantities/cosine.hpp"
#include "quantities/fit_limits.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr double folded = 1.5;  // times the rms of the other elements: beyond it the mirror-odd ones are mixed up

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
         (odd > std::max(folded * even, exact_rms)
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

void add(std::vector<std::string>& warnings, std::string line) {
  if (!line.empty()) warnings.push_back(std::move(line));
}

/// What fits of low order to samples show; nothing of samples that cannot be fitted, as fill values alone.
void add_findings(std::vector<std::string>& warnings, std::span<const Sample> samples) try {
  for (const Finding& finding :
       {may_be_radians(samples) ? radian_finding(samples) : Finding(), cosine_finding(samples)})
    if (!finding.fault.empty()) warnings.push_back(to_string(finding));
} catch (const std::invalid_argument&) {
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
    if (found.dhr - surely * found.u_dhr > brightest.dhr - surely * brightest.u_dhr) brightest = found;
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
  if (samples.empty()) return warnings;
  add_findings(warnings, samples);
  add(warnings, convention_warning(samples, orders(model), model.mapping));
  return warnings;
}

}  // namespace mmbrdf
