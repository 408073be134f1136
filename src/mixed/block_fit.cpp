// SPDX-License-Identifier: BSD-3-Clause
#include "mixed/block_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mmbrdf/numerics/quadrature.hpp"
#include "numerics/dense.hpp"

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double projected_to = radians(75);

/// Noise variance to begin with: what the fit of the evaluated modes leaves, from the sums alone.
double first_noise(const Gram& gram, const std::vector<Index>& kept) {
  const MatrixXd g = gram.g.selfadjointView<Eigen::Lower>();
  const VectorXd z = gram.z(kept);
  const double left = gram.yy - dense::shortest_least_squares(g(kept, kept), z).col(0).dot(z);
  return std::max(left, 1e-3 * gram.yy) / static_cast<double>(gram.n);
}

BlockFit fitted(const MixedColumns& columns, const Gram& gram, const Parts& parts, const Block& evaluated,
                const Prior& prior, const Estimate& estimate) {
  const Index count = columns.isotropic_count(), hyper = prior.mean.size();
  const std::vector<Index> kept = columns_of(evaluated, columns.isotropic());
  const auto& [at, evidence, evaluations] = estimate;
  const VectorXd variances = prior.variances(at.head(hyper)), roots = variances.cwiseSqrt();
  BlockFit result;
  result.evaluations = evaluations;
  BlockPosterior& p = result.posterior;
  p.hyperparameters.assign(at.data(), at.data() + hyper);
  p.noise_variance = std::exp(at(hyper));
  p.evidence = evidence.value;
  p.mean.assign(evidence.mean.data(), evidence.mean.data() + count);
  for (Index j = count; j < columns.size(); ++j) p.free_mean.push_back(static_cast<float>(evidence.mean(j)));
  const MatrixXd& inverse = evidence.inverse.matrix;
  result.covariance =
      roots.head(count).asDiagonal() * inverse.topLeftCorner(count, count) * roots.head(count).asDiagonal();
  for (Index error = 0; error < gram.d.cols(); ++error) {
    const VectorXd b = roots.cwiseProduct(gram.d.col(error)) / p.noise_variance,
                   shared = roots.cwiseProduct(solved(gram.g, parts, variances, p.noise_variance, evidence.inverse, b));
    for (Index i = 0; i < count; ++i) p.shared.push_back(static_cast<float>(shared(i)));
  }
  const VectorXd a = projection(columns, kept) * evidence.mean.head(count);
  result.coefficients.assign(a.data(), a.data() + a.size());
  return result;
}

}  // namespace

std::vector<Index> columns_of(const Block& evaluated, const Block& isotropic) {
  std::vector<Index> result;
  for (const Mode& mode : evaluated.modes)
    result.push_back(std::ranges::find(isotropic.modes, mode) - isotropic.modes.begin());
  return result;
}

// The integrand is a polynomial in the cosines and in those of multiples of the azimuth: the sums are exact. Isotropic
// modes are symmetric about the plane of incidence, so half of the azimuths will do.
MatrixXd projection(const MixedColumns& columns, const std::vector<Index>& kept) {
  const Orders highest = orders(std::vector{columns.isotropic()});
  const int order = std::max(highest.f11, highest.other), steps = order + 1;
  const int polar = columns.mapping() == DiscMapping::lambert ? order / 2 + 2 : order + 2;
  const double top = 1 - std::cos(projected_to);
  const auto nodes = gauss_legendre(polar);
  MatrixXd normal = MatrixXd::Zero(static_cast<Index>(kept.size()), columns.isotropic_count());
  std::vector<Geometry> geometries;
  for (const Node& i : nodes) {
    VectorXd weights(static_cast<Index>(nodes.size()) * (steps + 1));
    geometries.clear();
    for (const Node& r : nodes)
      for (int step = 0; step <= steps; ++step) {
        const double cos_i = 1 - top * i.x, cos_r = 1 - top * r.x;
        weights(static_cast<Index>(geometries.size())) =
            (step == 0 || step == steps ? 0.5 : 1) * i.weight * r.weight * cos_i * cos_r;
        geometries.push_back({{std::acos(cos_i), 0}, {std::acos(cos_r), std::numbers::pi * step / steps}});
      }
    const MatrixXd rows = columns.isotropic_at(geometries);
    for (Index e = 0; e < columns.elements(); ++e) {
      const auto of_element = rows.middleRows(e * weights.size(), weights.size());
      normal.noalias() += (weights.asDiagonal() * of_element(Eigen::all, kept)).transpose() * of_element;
    }
  }
  return MatrixXd(normal(Eigen::all, kept)).ldlt().solve(normal);
}

BlockFit fit_block(const MixedColumns& columns, const Gram& gram, const Block& evaluated) {
  const Prior prior = prior_of(columns);
  const Parts parts = parts_of(gram.g, columns.calibration_count());
  const double noise = first_noise(gram, columns_of(evaluated, columns.isotropic()));
  return fitted(columns, gram, parts, evaluated, prior, estimate(gram, parts, prior, noise));
}

// C = S R Rᵀ S, the rows of R of norm 1: correlations are those of rows, which rounding turns by some 1e-4.
void round_covariance(BlockPosterior& posterior, const MatrixXd& covariance) {
  const VectorXd deviations = covariance.diagonal().cwiseSqrt();
  const VectorXd inverse = deviations.cwiseInverse();
  const MatrixXd factor = MatrixXd(inverse.asDiagonal() * covariance * inverse.asDiagonal()).llt().matrixL();
  posterior.deviations.assign(deviations.data(), deviations.data() + deviations.size());
  for (Index i = 0; i < factor.rows(); ++i)
    for (Index j = 0; j <= i; ++j)
      posterior.factor.push_back(static_cast<std::int16_t>(std::lround(factor(i, j) * full_scale)));
}

BlockFit fit_block_at(const MixedColumns& columns, const Gram& gram, const Block& evaluated, const LogVariances& at) {
  const Prior prior = prior_of(columns);
  const Parts parts = parts_of(gram.g, columns.calibration_count());
  return fitted(columns, gram, parts, evaluated, prior, {at, evidence(gram, parts, prior, at), 1});
}

}  // namespace mmbrdf
