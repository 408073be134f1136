// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty/joint_covariance.hpp"

#include <stdexcept>

#include "numerics/eigen_index.hpp"

namespace mmbrdf {

using Eigen::MatrixXd;

bool has_uncertain_reflectance(const FittedBlock& fitted, const ReflectanceTable& table) {
  return feeds_f11(fitted.block) && !table.covariance.empty();
}

MatrixXd joint_covariance(const FittedBlock& fitted, const ReflectanceTable& table) {
  if (fitted.covariance.empty())
    throw std::invalid_argument("the covariance of block " + fitted.block.name + " is not known");
  const Eigen::Index size = index(fitted.coefficients.size()), count = index(table.values.size());
  const Eigen::Map<const MatrixXd> own(fitted.covariance.data(), size, size);
  if (!has_uncertain_reflectance(fitted, table)) return own;
  const Eigen::Map<const MatrixXd> with_f11(table.covariance_with_f11.data(), size, count);  // row-major, transposed
  MatrixXd result(size + count, size + count);
  result << own, with_f11, with_f11.transpose(), Eigen::Map<const MatrixXd>(table.covariance.data(), count, count);
  return result;
}

}  // namespace mmbrdf
