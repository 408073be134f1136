// SPDX-License-Identifier: BSD-3-Clause
/// The mixed model of a block from sums over its readings alone: the evidence of the prior variances, where it is
/// largest, and the posterior there.
///
///   G, z, yy, n   XᵀW²X, XᵀW²y, yᵀW²y, number of readings; s² noise variance of a reading of weight 1
///   L             diagonal of the roots of the prior variances v
///   A = 1 + L G L / s²,   m = A⁻¹ L z / s²,   mean μ = L m,   covariance V = L A⁻¹ L
///   evidence      −½ [n ln s² + ln det A + (yy − zᵀμ) / s²], less constants
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mixed/prior.hpp"

namespace mmbrdf {

/// Sums over weighted readings of a block; those of parts of a series add up.
struct Gram {
  Eigen::MatrixXd g;  ///< lower triangle
  Eigen::VectorXd z;
  Eigen::MatrixXd d;  ///< XᵀW²D, a column for each error that all readings share
  double yy = 0;
  long n = 0;

  Gram() = default;
  Gram(Eigen::Index columns, Eigen::Index errors)
      : g(Eigen::MatrixXd::Zero(columns, columns)),
        z(Eigen::VectorXd::Zero(columns)),
        d(Eigen::MatrixXd::Zero(columns, errors)) {}
  /// Rows of X, y and D, already multiplied by the weights. Rows of 0 count as readings.
  void add(const Eigen::MatrixXd& x, const Eigen::VectorXd& y, const Eigen::MatrixXd& errors);
  void merge(const Gram& other);
};

/// Hyperparameters, and the logarithm of the noise variance behind them.
using LogVariances = Eigen::VectorXd;

/// Which columns readings connect. A grid that is symmetric about a plane, as goniometers measure, has no product of a
/// mirror-even and a mirror-odd column; calibration columns, which are last, border all parts.
struct Parts {
  std::vector<std::vector<Eigen::Index>> columns;
  std::vector<Eigen::Index> border;
};
Parts parts_of(const Eigen::MatrixXd& g, Eigen::Index border);

/// A⁻¹, whole, and ln det A, NaN if A is not positive definite.
struct Inverse {
  Eigen::MatrixXd matrix;
  double log_determinant = 0;
};
Inverse inverse_of(const Eigen::MatrixXd& g, const Parts& parts, const Eigen::VectorXd& variances, double noise);

/// A⁻¹ b, of an inverse_of() these.
Eigen::VectorXd solved(const Eigen::MatrixXd& g, const Parts& parts, const Eigen::VectorXd& variances, double noise,
                       const Inverse& inverse, const Eigen::VectorXd& b);

struct Evidence {
  double value = 0;             ///< with the hyperprior: less ½ Σ ((θ − mean) / deviation)²
  double alone = 0;             ///< without it
  Eigen::VectorXd gradient;     ///< of value, by the variances
  Eigen::MatrixXd information;  ///< Fisher's, with that of the hyperprior
  Eigen::VectorXd mean;         ///< μ
  Inverse inverse;
};
Evidence evidence(const Gram& gram, const Parts& parts, const Prior& prior, const LogVariances& at);

struct Estimate {
  LogVariances at;
  Evidence evidence;
  int evaluations = 0;
};
/// The largest evidence, from the hyperprior means and this noise variance on: quasi-Newton steps in the metric of
/// Fisher's information. Throws std::runtime_error where it is not found.
Estimate estimate(const Gram& gram, const Parts& parts, const Prior& prior, double noise);

}  // namespace mmbrdf
