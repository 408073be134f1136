// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "mmbrdf/geometry/geometry.hpp"

namespace mmbrdf {

/// Number n (from 1) of Halton's sequence of a base.
inline double halton(int n, int base) {
  double result = 0;
  for (double part = 1.0 / base; n > 0; n /= base, part /= base) result += part * (n % base);
  return result;
}

/// The first pairs of directions of Halton's sequences of 2, 3, 5 and 7, uniform in projected cosine on both sides,
/// whose larger polar angle is above `low` and not above `high`, in degrees.
inline std::vector<Geometry> halton_directions(std::size_t count, double low, double high) {
  std::vector<Geometry> result;
  const double top = std::sin(radians(high));
  for (int n = 1; result.size() < count; ++n) {
    const Geometry g{{std::asin(top * std::sqrt(halton(n, 2))), 2 * std::numbers::pi * halton(n, 5)},
                     {std::asin(top * std::sqrt(halton(n, 3))), 2 * std::numbers::pi * halton(n, 7)}};
    if (std::max(g.incident.theta, g.reflected.theta) > radians(low)) result.push_back(g);
  }
  return result;
}

}  // namespace mmbrdf
