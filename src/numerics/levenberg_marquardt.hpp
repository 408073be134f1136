// SPDX-License-Identifier: BSD-3-Clause
/// Least squares of functions that are not linear, by Levenberg and Marquardt.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "numerics/dense.hpp"

namespace mmbrdf {

/// Rows in units of their standard deviations.
struct Linearised {
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd residuals;
};

/// Moves x to where the sum of squares of linearised(x).residuals is least, in at most 50 steps; move(x, step) changes
/// it. Columns are scaled to 1, so that units do not matter.
template <class Unknowns, class Rows, class Move>
void levenberg_marquardt(Unknowns& x, const Rows& linearised, const Move& move) {
  double damping = 1e-6;
  Linearised now = linearised(x);
  const Eigen::Index size = now.jacobian.cols();
  for (int iteration = 0; iteration < 50 && damping < 1e6; ++iteration) {
    const Eigen::VectorXd scales = now.jacobian.colwise().norm().cwiseMax(1e-300).transpose();
    Eigen::MatrixXd rows(now.jacobian.rows() + size, size);
    rows.topRows(now.jacobian.rows()) = now.jacobian * scales.cwiseInverse().asDiagonal();
    rows.bottomRows(size) = std::sqrt(damping) * Eigen::MatrixXd::Identity(size, size);
    Eigen::VectorXd values = Eigen::VectorXd::Zero(rows.rows());
    values.head(now.residuals.size()) = now.residuals;
    const Eigen::VectorXd step = dense::least_squares(rows, values).cwiseQuotient(scales);
    Unknowns moved = x;
    move(moved, step);
    Linearised next = linearised(moved);
    const double before = now.residuals.squaredNorm(), after = next.residuals.squaredNorm();
    if (!(after <= before)) {
      damping *= 10;
      continue;
    }
    x = std::move(moved);
    now = std::move(next);
    damping /= 10;
    if (before - after <= 1e-12 * before) break;
  }
}

}  // namespace mmbrdf
