// SPDX-License-Identifier: BSD-3-Clause
/// Random Mueller matrices that can exist: sums of Jones matrices, from retarders to polarizers.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>

#include "mmbrdf/polarization/mueller.hpp"

namespace mmbrdf {

/// Rows one after the other.
using Jones = std::array<std::complex<double>, 4>;

/// docs/conventions.md: the Stokes vector of the field J (e1, e2).
inline Stokes stokes_behind(const Jones& j, std::complex<double> e1, std::complex<double> e2) {
  const std::complex<double> f1 = j[0] * e1 + j[1] * e2, f2 = j[2] * e1 + j[3] * e2, product = std::conj(f1) * f2;
  return {std::norm(f1) + std::norm(f2), std::norm(f1) - std::norm(f2), 2 * product.real(), 2 * product.imag()};
}

/// The matrix that does to Stokes vectors what J does to fields; from light along e1, e2, half-way between, and
/// left-handed.
inline Mueller mueller_of(const Jones& j) {
  const Stokes along_1 = stokes_behind(j, 1, 0), along_2 = stokes_behind(j, 0, 1);
  const double h = std::sqrt(0.5);
  const Stokes between = stokes_behind(j, h, h), left = stokes_behind(j, h, {0, h});
  Mueller m;
  for (int i = 0; i < 4; ++i) {
    const auto row = static_cast<std::size_t>(i);
    m(i, 0) = (along_1[row] + along_2[row]) / 2;
    m(i, 1) = (along_1[row] - along_2[row]) / 2;
    m(i, 2) = between[row] - m(i, 0);
    m(i, 3) = left[row] - m(i, 0);
  }
  return m;
}

/// Infinite if a number is not finite.
inline double largest(const Mueller& m) {
  double result = 0;
  for (const double element : m.elements)
    result = std::isfinite(element) ? std::max(result, std::abs(element)) : std::numeric_limits<double>::infinity();
  return result;
}

class RandomMueller {
 public:
  explicit RandomMueller(std::uint64_t seed) : engine_(seed) {}

  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  int below(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }
  std::complex<double> complex() { return {normal_(engine_), normal_(engine_)}; }
  Jones jones() { return {complex(), complex(), complex(), complex()}; }

  static constexpr int kinds = 6;

  /// 0 anything; 1 a polarizer behind which light has another polarization; 2 nearly such a one; 3 a retarder; 4 the
  /// polarizer along e1; 5 nothing in the way.
  Mueller pure(int kind) {
    const auto a = complex(), b = complex(), c = complex(), d = complex();
    if (kind == 0) return mueller_of({a, b, c, d});
    if (kind == 3) {
      const double norm = std::sqrt(std::norm(a) + std::norm(b));
      return mueller_of({a / norm, -std::conj(b) / norm, b / norm, std::conj(a) / norm});
    }
    if (kind == 4) return mueller_of({1, 0, 0, 0});
    if (kind == 5) return identity();
    const double leak = kind == 1 ? 0 : std::pow(10, between(-18, 0));
    const Jones other = jones();
    return mueller_of(
        {a * c + leak * other[0], a * d + leak * other[1], b * c + leak * other[2], b * d + leak * other[3]});
  }

  /// One to four of these, with weights down to 1e-16; a perfect depolarizer with them at times; of any magnitude.
  Mueller realizable() {
    Mueller m = pure(below(kinds));
    for (int more = below(4); more > 0; --more)
      m = m + (below(2) == 0 ? between(0, 1) : std::pow(10, between(-16, 0))) * pure(below(kinds));
    if (below(5) == 0) m = m + between(0, 1) * m(0, 0) * diagonal(1, 0, 0, 0);
    return below(4) == 0 ? std::pow(10, between(-250, 250)) * m : m;
  }

  /// Each element of its own magnitude, some of them 0 or the largest that there is.
  Mueller anything() {
    Mueller m;
    for (double& element : m.elements) {
      const int kind = below(8);
      const double size = kind == 0   ? 0
                          : kind == 1 ? std::numeric_limits<double>::max()
                          : kind == 2 ? std::numeric_limits<double>::denorm_min()
                          : kind < 6  ? 1
                                      : std::pow(10, between(-308, 308));
      element = size * (below(2) == 0 ? 1 : -1) * (kind == 3 ? between(0, 1) : 1);
    }
    return m;
  }

 private:
  std::mt19937_64 engine_;
  std::normal_distribution<double> normal_;
};

}  // namespace mmbrdf
