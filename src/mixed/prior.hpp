// SPDX-License-Identifier: BSD-3-Clause
/// Prior variances of the columns of a mixed model: ln v is linear in hyperparameters, which have normal priors.
///
///   isotropic, n and m ≤ 2   v = 100                       others  ln v = l_iso − 2 s_iso ln((1 + n + m) / 6)
///   free                     ln v = l − s ln(1 + ((n + m) / 3)²), l one of l_1, l_2, l_3, l_odd, l_nonreciprocal
///   calibration              ln v = l_calibration
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mixed/columns.hpp"

namespace mmbrdf {

struct Prior {
  Eigen::MatrixXd design;           ///< d ln v / d hyperparameter, columns × hyperparameters; names: posterior.hpp
  Eigen::VectorXd constant;         ///< the rest of ln v
  Eigen::VectorXd mean, deviation;  ///< of the hyperparameters

  Eigen::VectorXd variances(const Eigen::VectorXd& hyperparameters) const;
};

Prior prior_of(const MixedColumns& columns);

}  // namespace mmbrdf
