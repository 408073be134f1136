// SPDX-License-Identifier: BSD-3-Clause
/// States of a polarimeter as a matrix.
#pragma once

#include <Eigen/Core>
#include <span>

#include "mmbrdf/polarization/mueller.hpp"
#include "numerics/eigen_index.hpp"

namespace mmbrdf {

/// 4 × states, a state in each column.
inline Eigen::MatrixXd columns(std::span<const Stokes> states) {
  Eigen::MatrixXd result(4, index(states.size()));
  for (std::size_t s = 0; s < states.size(); ++s)
    result.col(index(s)) = Eigen::Map<const Eigen::Vector4d>(states[s].data());
  return result;
}

}  // namespace mmbrdf
