// SPDX-License-Identifier: BSD-3-Clause
/// Simulated samples of a random isotropic model, exact, with noise, or with something added to each.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <random>
#include <span>
#include <vector>

#include "given/random_model.hpp"
#include "mmbrdf/samples/simulation.hpp"

namespace mmbrdf {

inline constexpr std::array one_wavelength{0.5};
inline constexpr Orders small_orders{4, 3};

inline std::vector<Sample> exact(int count = 300, std::span<const double> wavelengths = one_wavelength) {
  return simulate(random_model(Family::isotropic, small_orders, 0, 5), wavelengths, random_geometries(count, 3));
}

/// Independent normal errors of one size.
inline std::vector<Sample> noisy(std::vector<Sample> samples, double deviation, unsigned long seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal(0, deviation);
  for (Sample& sample : samples) {
    sample.f11 += normal(engine);
    for (std::size_t e = 1; e < 16; ++e) sample.normalized.elements[e] += normal(engine);
  }
  return samples;
}

/// Something that breaks a symmetry, added to a sample.
using Change = std::function<void(Sample&)>;

inline std::vector<Sample> changed(std::vector<Sample> samples, const Change& change) {
  std::for_each(samples.begin(), samples.end(), change);
  return samples;
}

}  // namespace mmbrdf
