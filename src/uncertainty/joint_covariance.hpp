// SPDX-License-Identifier: BSD-3-Clause
/// The parameters of a fitted block that have a covariance: its coefficients and, of block 11, the values of the
/// reflectance table behind them where those were found from the same data.
#pragma once

#include <Eigen/Core>

#include "mmbrdf/model/model.hpp"

namespace mmbrdf {

bool has_uncertain_reflectance(const FittedBlock& fitted, const ReflectanceTable& table);

/// Of all parameters. Throws std::invalid_argument if the covariance is not known.
Eigen::MatrixXd joint_covariance(const FittedBlock& fitted, const ReflectanceTable& table);

}  // namespace mmbrdf
