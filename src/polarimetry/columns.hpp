// SPDX-License-Identifier: BSD-3-Clause
/// States of a polarimeter as a matrix, and when that counts as having full rank.
#pragma once

#include <Eigen/Core>
#include <span>

#include "mmbrdf/polarization/mueller.hpp"
#include "numerics/eigen_index.hpp"

namespace mmbrdf {

inline constexpr double least_singular = 1e-12;  ///< relative to the largest: below, rounding alone could have made it

/// 4 × states, a state in each column.
inline Eigen::MatrixXd columns(std::span<const Stokes> states) {
  Eigen::MatrixXd result(4, index(states.size()));
  for (std::size_t s = 0; s < states.size(); ++s)
    result.col(index(s)) = Eigen::Map<const Eigen::Vector4d>(states[s].data());
  return result;
}

/// Whether rows of a 4 × states matrix with these singular values are independent.
inline bool has_rank_four(const Eigen::VectorXd& singular_values) {
  return singular_values(3) > least_singular * singular_values(0);
}

}  // namespace mmbrdf
