// SPDX-License-Identifier: BSD-3-Clause
/// Covariances of the sixteen elements of a Mueller matrix.
#pragma once

#include <array>
#include <cstddef>

#include "mmbrdf/polarization/mueller.hpp"

namespace mmbrdf {

/// Covariances of the sixteen elements of one matrix, in row-major order: symmetric, 16 × 16.
struct MuellerCovariance {
  std::array<double, 256> values{};
  double operator()(std::size_t element, std::size_t other) const { return values[16 * element + other]; }
  double& operator()(std::size_t element, std::size_t other) { return values[16 * element + other]; }
};

/// Throws std::invalid_argument, with what is wrong, for a covariance that nothing can have: not finite, not symmetric, or
/// with an eigenvalue below 0, each to 1e-9 of the largest element. Nothing else asks this: what a model gives is one.
void require_valid(const MuellerCovariance& covariance);

/// Of each element: the square roots of the covariance's diagonal.
Mueller standard_uncertainty(const MuellerCovariance& covariance);

/// Makes all covariances of these elements NaN: they were not measured.
void set_unknown(MuellerCovariance& covariance, const Elements& elements);

/// Covariance of the elements of left · M · right, from that of the elements of M, all of which must be known.
MuellerCovariance transformed(const MuellerCovariance& covariance, const Mueller& left, const Mueller& right);

/// Covariance of M11 and of the other elements divided by it, from that of the elements of M. Throws
/// std::invalid_argument unless M11 is positive.
MuellerCovariance normalized(const MuellerCovariance& covariance, const Mueller& m);

}  // namespace mmbrdf
