// SPDX-License-Identifier: BSD-3-Clause
// Lack of fit against pure error. Part of symmetry.hpp.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>

#include "mmbrdf/fitting/symmetry.hpp"
#include "mmbrdf/samples/comparison.hpp"

namespace mmbrdf {
namespace {

/// Residuals as they were fitted, by what was measured: wavelength and angles, which repeats have the same.
std::map<std::array<double, 5>, std::vector<Mueller>> by_geometry(std::span<const Sample> samples,
                                                                  const FitResult& fitted) {
  std::map<std::array<double, 5>, std::vector<Mueller>> result;
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const auto& [incident, reflected] = samples[s].geometry;
    Mueller r = turns(fitted.model) ? turned(fitted.residuals[s], -incident.phi) : fitted.residuals[s];
    r(0, 0) = fitted.residuals[s](0, 0) / fitted.model.reflectance.at(samples[s].wavelength);
    result[{samples[s].wavelength, incident.theta, incident.phi, reflected.theta, reflected.phi}].push_back(r);
  }
  return result;
}

struct Scatter {
  long repeats = 0;
  double squares = 0;  // about the mean
};

/// Of one element, where it was measured.
Scatter scatter(const std::vector<Mueller>& residuals, std::size_t element) {
  std::vector<double> values;
  for (const Mueller& r : residuals)
    if (!std::isnan(r.elements[element])) values.push_back(r.elements[element]);
  if (values.empty()) return {};
  double mean = 0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  Scatter result{static_cast<long>(values.size()) - 1};
  for (const double value : values) result.squares += std::pow(value - mean, 2);
  return result;
}

}  // namespace

std::vector<LackOfFit> lack_of_fit(std::span<const Sample> samples, const FitResult& fitted) {
  if (fitted.residuals.size() != samples.size())
    throw std::invalid_argument(std::to_string(fitted.residuals.size()) + " residuals for " +
                                std::to_string(samples.size()) + " samples");
  const auto groups = by_geometry(samples, fitted);
  std::vector<LackOfFit> result;
  for (std::size_t b = 0; b < fitted.solutions.size(); ++b) {
    const Block& block = fitted.model.blocks[b].block;
    const Solution& solution = fitted.solutions[b];
    LackOfFit& test = result.emplace_back();
    test.block = block.name;
    double pure = 0;
    for (const auto& [geometry, residuals] : groups)
      for (const Element& element : block.elements) {
        const Scatter here = scatter(residuals, element.index());
        test.repeats += here.repeats;
        pure += here.squares;
      }
    const long q = solution.degrees_of_freedom() - test.repeats;
    if (test.repeats == 0 || q <= 0) {
      test.repeats = 0;
      continue;
    }
    const double left = std::max(0.0, solution.residual_norm * solution.residual_norm - pure);
    test.pure_error = std::sqrt(pure / static_cast<double>(test.repeats));
    test.misfit = std::sqrt(left / static_cast<double>(q));
    if (pure <= 0) continue;  // copies: they say nothing of the noise
    test.f = std::pow(test.misfit / test.pure_error, 2);
    test.p = f_probability(test.f, static_cast<double>(q), static_cast<double>(test.repeats));
  }
  return result;
}

}  // namespace mmbrdf
