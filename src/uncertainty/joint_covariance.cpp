// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty/joint_covariance.hpp"

#include <stdexcept>

#include "numerics/eigen_index.hpp"

namespace mmbrdf {

using Eigen::MatrixXd;
using Eigen::VectorXd;

bool has_uncertain_reflectance(const FittedBlock& fitted, const ReflectanceTable& table) {
  return feeds_f11(fitted.block) && !table.covariance.empty();
}

Eigen::Map<const MatrixXd> own_covariance(const FittedBlock& fitted) {
  if (fitted.covariance.empty())
    throw std::invalid_argument("the covariance of block " + fitted.block.name + " is not known");
  const Eigen::Index size = index(fitted.coefficients.size());
  return {fitted.covariance.data(), size, size};
}

Eigen::Map<const MatrixXd> covariance_with_values(const FittedBlock& fitted, const ReflectanceTable& table) {
  return {table.covariance_with_f11.data(), index(fitted.coefficients.size()), index(table.values.size())};
}

bool has_independent_values(const ReflectanceTable& table) { return table.covariance.size() == table.values.size(); }

double variance_of_values(const ReflectanceTable& table, const VectorXd& weights) {
  if (has_independent_values(table))
    return weights.cwiseAbs2().dot(Eigen::Map<const VectorXd>(table.covariance.data(), weights.size()));
  return weights.dot(Eigen::Map<const MatrixXd>(table.covariance.data(), weights.size(), weights.size()) * weights);
}

}  // namespace mmbrdf
