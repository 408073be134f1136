// SPDX-License-Identifier: BSD-3-Clause
/// Random numbers that are the same with every compiler; the distributions of the standard library are not.
#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <utility>

namespace mmbrdf {

/// Uniform in [0, 1): a multiple of 2⁻⁵³.
inline double uniform(std::mt19937_64& engine) { return static_cast<double>(engine() >> 11) * 0x1p-53; }

/// Two that are normal with mean 0 and standard deviation 1, independent of each other (Box and Muller).
inline std::pair<double, double> two_normal(std::mt19937_64& engine) {
  const double radius = std::sqrt(-2 * std::log(1 - uniform(engine)));
  const double angle = 2 * std::numbers::pi * uniform(engine);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// One of them.
inline double normal(std::mt19937_64& engine) { return two_normal(engine).first; }

}  // namespace mmbrdf
