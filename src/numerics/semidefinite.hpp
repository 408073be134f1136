// SPDX-License-Identifier: BSD-3-Clause
/// What every use of a covariance asks of it.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "text/numbers.hpp"

namespace mmbrdf {

/// Eigenvalues, rising, of the covariance `of` something. Throws std::invalid_argument, naming it, for one below
/// −tolerance times the largest.
inline void require_semidefinite(const Eigen::VectorXd& eigenvalues, const std::string& of, double tolerance) {
  const double lowest = eigenvalues(0), highest = std::max(eigenvalues(eigenvalues.size() - 1), 0.0);
  if (!std::isfinite(highest) || !(lowest >= -tolerance * highest))
    throw std::invalid_argument("the covariance of " + of + " is not positive semidefinite: its eigenvalues are " +
                                shortest(lowest) + " to " + shortest(highest));
}

}  // namespace mmbrdf
