// SPDX-License-Identifier: BSD-3-Clause
/// The parameters of a fitted block that have a covariance: its coefficients and, of block 11, the values of the
/// reflectance table behind them where those were found from the same data.
#pragma once

#include <Eigen/Core>

#include "mmbrdf/model/model.hpp"

namespace mmbrdf {

bool has_uncertain_reflectance(const FittedBlock& fitted, const ReflectanceTable& table);

/// Of the coefficients. Throws std::invalid_argument if it is not known.
Eigen::Map<const Eigen::MatrixXd> own_covariance(const FittedBlock& fitted);

/// Of the coefficients, in rows, with the values of a table that has a covariance.
Eigen::Map<const Eigen::MatrixXd> covariance_with_values(const FittedBlock& fitted, const ReflectanceTable& table);

/// Whether a table that has a covariance has variances alone.
bool has_independent_values(const ReflectanceTable& table);

/// Of Σ weights × values, of a table that has a covariance.
double variance_of_values(const ReflectanceTable& table, const Eigen::VectorXd& weights);

}  // namespace mmbrdf
