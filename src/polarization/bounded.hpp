// SPDX-License-Identifier: BSD-3-Clause
// Numbers that would be infinite are the largest there is: results of finite matrices are finite.
#pragma once

#include <algorithm>
#include <limits>

namespace mmbrdf {

inline constexpr double largest_double = std::numeric_limits<double>::max();

inline double bounded(double x) { return std::clamp(x, -largest_double, largest_double); }

}  // namespace mmbrdf
