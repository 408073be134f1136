// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/samples/mirror_pairs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace mmbrdf {
namespace {

/// Samples of a pair, the one with sin δ > 0 first.
std::vector<std::pair<std::size_t, std::size_t>> paired(std::span<const Sample> samples) {
  std::array<std::vector<double>, 5> keys;  // wavelength, θi, φi, θr, |δ|
  std::vector<double> sides;
  for (const Sample& sample : samples) {
    const auto& [i, r] = sample.geometry;
    const double delta = std::remainder(r.phi - i.phi, 2 * std::numbers::pi);
    sides.push_back(std::sin(delta) * std::sin(r.theta));
    const double phi_i = std::remainder(i.phi, 2 * std::numbers::pi);
    const bool is_minus_pi = phi_i < -std::numbers::pi + pair_tolerance;  // which is π
    const std::array values{sample.wavelength, i.theta, is_minus_pi ? phi_i + 2 * std::numbers::pi : phi_i, r.theta,
                            std::abs(delta)};
    for (std::size_t k = 0; k < 5; ++k) keys[k].push_back(values[k]);
  }
  std::array<std::vector<std::size_t>, 5> cells;
  for (std::size_t k = 0; k < 5; ++k) cells[k] = grouped(keys[k], k == 0 ? wavelength_resolution : pair_tolerance);
  std::map<std::array<std::size_t, 5>, std::array<std::vector<std::size_t>, 2>> found;
  for (std::size_t s = 0; s < samples.size(); ++s)
    if (keys[1][s] >= pair_tolerance && std::abs(sides[s]) > pair_tolerance)
      found[{cells[0][s], cells[1][s], cells[2][s], cells[3][s], cells[4][s]}][sides[s] > 0 ? 0 : 1].push_back(s);
  // Of many random values close to each other a cell has a whole range: the nearest one is the mirror image.
  const auto distance = [&](std::size_t a, std::size_t b) {
    double result = 0;
    for (std::size_t k = 1; k < 5; ++k) result = std::max(result, std::abs(keys[k][a] - keys[k][b]));
    return result;
  };
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (auto& [cell, both] : found)
    for (const std::size_t first : both[0]) {
      const auto nearest = std::ranges::min_element(both[1], {}, [&](std::size_t s) { return distance(first, s); });
      if (nearest == both[1].end() || distance(first, *nearest) > pair_tolerance) continue;
      pairs.emplace_back(first, *nearest);
      both[1].erase(nearest);
    }
  return pairs;
}

}  // namespace

MirrorPairs mirror_pairs(std::span<const Sample> samples) {
  require_valid(samples);
  MirrorPairs result;
  std::array<double, 16> counts{};
  for (const auto& [a, b] : paired(samples)) {
    const Sample first = at_zero_azimuth(samples[a]), second = at_zero_azimuth(samples[b]);
    Mueller difference = first.normalized - mirrored(second.normalized);
    const double mean = (first.f11 + second.f11) / 2;
    difference(0, 0) = mean != 0 ? (first.f11 - second.f11) / mean : 0;
    for (std::size_t e = 0; e < 16; ++e) {
      if (std::isnan(difference.elements[e])) continue;  // not measured
      ++counts[e];
      result.rms.elements[e] += difference.elements[e] * difference.elements[e] / 2;
      result.mean.elements[e] += difference.elements[e] / 2;
    }
    ++result.pairs;
  }
  for (std::size_t e = 0; e < 16 && result.pairs > 0; ++e) {
    result.rms.elements[e] = std::sqrt(result.rms.elements[e] / counts[e]);  // 0 / 0 of what was not measured
    result.mean.elements[e] /= counts[e];
  }
  return result;
}

}  // namespace mmbrdf
