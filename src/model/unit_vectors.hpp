// SPDX-License-Identifier: BSD-3-Clause
/// Which vectors stand for directions.
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>

#include "mmbrdf/geometry/geometry.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {

/// z ≥ 0, length 1 to 1e-6.
inline bool is_unit_vector(const Vector3& v) {
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  return std::abs(length - 1) < 1e-6 && v[2] >= 0;
}

/// Throws std::invalid_argument, with `what` before the vector, for others.
inline void require_unit_vector(const Vector3& v, const std::string& what = "") {
  if (!is_unit_vector(v))
    throw std::invalid_argument(what + (what.empty() ? "(" : " (") + shortest(v[0]) + ", " + shortest(v[1]) + ", " +
                                shortest(v[2]) + ") is not a unit vector with z >= 0");
}

}  // namespace mmbrdf
