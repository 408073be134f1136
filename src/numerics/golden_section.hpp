// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>

namespace mmbrdf {

/// Where a function with one valley between two ends is smallest, to `width`.
template <class F>
double golden_section(const F& function, double low, double high, double width) {
  constexpr double share = 1 / std::numbers::phi;
  double a = high - share * (high - low), b = low + share * (high - low);
  double at_a = function(a), at_b = function(b);
  while (high - low > width) {
    if (at_a < at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = high - share * (high - low);
      at_a = function(a);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = low + share * (high - low);
      at_b = function(b);
    }
  }
  return (low + high) / 2;
}

/// Where a function is smallest: the best of equal steps, then golden section from the step before it to that
/// behind it, one of which is beyond the ends where the best is at one.
template <class F>
double scanned_minimum(const F& function, double low, double high, int steps, double width) {
  const double step = (high - low) / steps;
  double best = low, least = function(low);
  for (int k = 1; k < steps; ++k)
    if (const double value = function(low + k * step); value < least) {
      least = value;
      best = low + k * step;
    }
  return golden_section(function, best - step, best + step, width);
}

}  // namespace mmbrdf
