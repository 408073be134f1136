// SPDX-License-Identifier: BSD-3-Clause
/// Random numbers that are the same with every compiler; the distributions of the standard library are not.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <utility>

namespace mmbrdf {

/// One of several streams of the same seed that have nothing to do with each other.
inline std::mt19937_64 stream(std::uint64_t seed, std::uint32_t number) {
  std::seed_seq words{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32), number};
  return std::mt19937_64(words);
}

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

/// Positive, with mean 1 and this standard deviation: lognormal, and near to normal where that is small.
inline double factor(double deviation, std::mt19937_64& engine) {
  const double variance = std::log1p(deviation * deviation);
  return std::exp(std::sqrt(variance) * normal(engine) - variance / 2);
}

}  // namespace mmbrdf
