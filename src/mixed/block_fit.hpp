// SPDX-License-Identifier: BSD-3-Clause
/// The mixed model of one block at one wavelength, from sums over its readings to what is kept of it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mixed/evidence.hpp"
#include "mmbrdf/mixed/posterior.hpp"

namespace mmbrdf {

/// The column of each mode of the evaluated block.
std::vector<Eigen::Index> columns_of(const Block& evaluated, const Block& isotropic);

/// P: the evaluated coefficients nearest to a function of all isotropic modes, kept × isotropic, over directions uniform
/// in projected cosine with θ ≤ 75° on both sides.
Eigen::MatrixXd projection(const MixedColumns& columns, const std::vector<Eigen::Index>& kept);

struct BlockFit {
  BlockPosterior posterior;
  std::vector<double> coefficients;  ///< of the evaluated modes, P × mean
  Eigen::MatrixXd covariance;        ///< of the isotropic modes
  int evaluations = 0;               ///< of the evidence
};

/// Where the evidence is largest. The columns of the sums d are the declared errors of size 1.
BlockFit fit_block(const MixedColumns& columns, const Gram& gram, const Block& evaluated);
/// Fills the rounded form.
void round_covariance(BlockPosterior& posterior, const Eigen::MatrixXd& covariance);
/// At given variances.
BlockFit fit_block_at(const MixedColumns& columns, const Gram& gram, const Block& evaluated, const LogVariances& at);

}  // namespace mmbrdf
