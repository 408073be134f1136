// SPDX-License-Identifier: BSD-3-Clause
// The mixed model of a few invented readings, against the textbook form: y is normal with covariance K = s² + X diag(v) Xᵀ.
#include "mixed/evidence.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "mixed/block_fit.hpp"
#include "mmbrdf/numerics/quadrature.hpp"

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Directions and their mirror images about a plane: their mirror-even and mirror-odd columns are parts of their own.
std::vector<Geometry> mirror_images() {
  std::vector<Geometry> result;
  for (int i = 0; i < 6; ++i)
    for (const double sign : {1.0, -1.0})
      result.push_back({{0.1 + 0.2 * i, 0}, {1.2 - 0.17 * i, sign * (0.3 + 0.5 * i)}});
  return result;
}

struct Invented {
  MixedColumns columns;
  MatrixXd x, d;
  VectorXd y;
  Prior prior;
  Gram gram;
  Parts parts;
  LogVariances at;

  explicit Invented(std::size_t block)
      : columns(blocks(Family::isotropic, {4, 3})[block], DiscMapping::lambert),
        x(columns.at(mirror_images())),
        d(x.rows(), 2),
        y(x.rows()),
        prior(prior_of(columns)),
        gram(columns.size(), 2),
        at(prior.mean.size() + 1) {
    std::mt19937 engine(1);
    std::normal_distribution<double> normal;
    for (double& one : y) one = 0.3 * normal(engine);
    for (double& one : d.reshaped()) one = normal(engine);
    gram.add(x.topRows(5), y.head(5), d.topRows(5));
    Gram rest(columns.size(), 2);
    rest.add(x.bottomRows(x.rows() - 5), y.tail(x.rows() - 5), d.bottomRows(x.rows() - 5));
    gram.merge(rest);
    parts = parts_of(gram.g, columns.calibration_count());
    for (Index h = 0; h < prior.mean.size(); ++h) at(h) = prior.mean(h) + 0.4 * static_cast<double>(h % 3) + 0.3;
    at(prior.mean.size()) = std::log(0.02);
  }

  double noise() const { return std::exp(at(at.size() - 1)); }
  VectorXd variances() const { return prior.variances(at.head(prior.mean.size())); }
  MatrixXd covariance_of_readings() const {
    return x * variances().asDiagonal() * x.transpose() + noise() * MatrixXd::Identity(x.rows(), x.rows());
  }
  /// V = diag v − diag v Xᵀ K⁻¹ X diag v.
  MatrixXd posterior_covariance() const {
    const MatrixXd vx = variances().asDiagonal() * x.transpose();
    return MatrixXd(variances().asDiagonal()) - vx * covariance_of_readings().llt().solve(vx.transpose());
  }
  Evidence found(const LogVariances& where) const { return evidence(gram, parts, prior, where); }
};

// f11, which has no calibration columns, and blocks of one, two and four elements that have.
const std::vector<std::size_t> some_blocks{0, 1, 2, 5};

// 1e-7: K has a condition of 1e6, A the same.
TEST(Evidence, IsTheLogarithmOfTheDensityOfTheReadings) {
  for (const std::size_t b : some_blocks) {
    const Invented block(b);
    ASSERT_GT(block.parts.columns.size(), 1);
    const Eigen::LLT<MatrixXd> k(block.covariance_of_readings());
    const double ln_det = 2 * k.matrixLLT().diagonal().array().log().sum();
    const double expected = -0.5 * (ln_det + block.y.dot(k.solve(block.y)));
    const VectorXd pull =
        (block.at.head(block.prior.mean.size()) - block.prior.mean).cwiseQuotient(block.prior.deviation);
    const Evidence found = block.found(block.at);
    EXPECT_NEAR(found.alone, expected, 1e-7 * std::abs(expected)) << b;
    EXPECT_NEAR(found.value, expected - 0.5 * pull.squaredNorm(), 1e-7 * std::abs(expected)) << b;
    const VectorXd mean = block.variances().asDiagonal() * block.x.transpose() * k.solve(block.y);
    EXPECT_LT((found.mean - mean).cwiseAbs().maxCoeff(), 1e-7 * mean.cwiseAbs().maxCoeff()) << b;
    const VectorXd roots = block.variances().cwiseSqrt();
    const MatrixXd covariance = roots.asDiagonal() * found.inverse.matrix * roots.asDiagonal();
    EXPECT_LT((covariance - block.posterior_covariance()).cwiseAbs().maxCoeff(), 1e-7 * block.variances().maxCoeff())
        << b;
  }
}

// 1e-6: central differences of 1e-4 of smooth functions, and their rounding.
TEST(Evidence, HasTheSlopeOfItsValues) {
  constexpr double step = 1e-4;
  for (const std::size_t b : some_blocks) {
    const Invented block(b);
    const VectorXd gradient = block.found(block.at).gradient;
    for (Index h = 0; h < gradient.size(); ++h) {
      LogVariances up = block.at, down = block.at;
      up(h) += step;
      down(h) -= step;
      const double slope = (block.found(up).value - block.found(down).value) / (2 * step);
      EXPECT_NEAR(gradient(h), slope, 1e-6 * (1 + std::abs(slope))) << b << " " << h;
    }
  }
}

// ½ tr(K⁻¹ ∂K K⁻¹ ∂K) of two parameters of a normal distribution without mean, and 1 / deviation² of their prior.
TEST(Evidence, HasFishersInformationOfANormalDistribution) {
  for (const std::size_t b : some_blocks) {
    const Invented block(b);
    const Index count = block.at.size();
    const Eigen::LLT<MatrixXd> k(block.covariance_of_readings());
    std::vector<MatrixXd> changes;
    for (Index h = 0; h + 1 < count; ++h) {
      const VectorXd dv = block.variances().cwiseProduct(block.prior.design.col(h));
      changes.push_back(k.solve(block.x * dv.asDiagonal() * block.x.transpose()));
    }
    changes.push_back(k.solve(block.noise() * MatrixXd::Identity(block.x.rows(), block.x.rows())));
    MatrixXd expected(count, count);
    for (Index i = 0; i < count; ++i)
      for (Index j = 0; j < count; ++j)
        expected(i, j) = 0.5 * (changes[static_cast<std::size_t>(i)] * changes[static_cast<std::size_t>(j)]).trace();
    expected.diagonal().head(count - 1) += block.prior.deviation.cwiseAbs2().cwiseInverse();
    const MatrixXd found = block.found(block.at).information;
    EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-6 * expected.maxCoeff()) << b;
  }
}

// Where a step promises less than 1e-8 (theory 8.3) the search ends: Newton's step there is no larger than its root.
TEST(Evidence, IsNowhereLargerAroundWhatIsFound) {
  for (const std::size_t b : some_blocks) {
    const Invented block(b);
    const Estimate top = estimate(block.gram, block.parts, block.prior, 0.1);
    const VectorXd newton = top.evidence.information.ldlt().solve(top.evidence.gradient);
    EXPECT_LT(newton.dot(top.evidence.gradient), 1e-6) << b;
    for (Index h = 0; h < top.at.size(); ++h)
      for (const double step : {-0.1, 0.1}) {
        LogVariances aside = top.at;
        aside(h) += step;
        EXPECT_LT(block.found(aside).value, top.evidence.value + 1e-6) << b << " " << h;
      }
  }
}

// Theory 8.4: J = V XᵀW² D / s². 1e-6: kept in single precision.
TEST(BlockFit, HasTheEffectsOfSharedErrorsAndTheCovarianceOfThePosterior) {
  for (const std::size_t b : some_blocks) {
    const Invented block(b);
    const Index n = block.columns.isotropic_count();
    const BlockFit fit = fit_block_at(block.columns, block.gram, block.columns.isotropic(), block.at);
    const MatrixXd v = block.posterior_covariance();
    EXPECT_LT((fit.covariance - v.topLeftCorner(n, n)).cwiseAbs().maxCoeff(), 1e-7 * v.maxCoeff()) << b;
    const MatrixXd j = (v * block.x.transpose() * block.d).topRows(n) / block.noise();
    const MatrixXd shared = Eigen::Map<const Eigen::MatrixXf>(fit.posterior.shared.data(), n, 2).cast<double>();
    EXPECT_LT((shared - j).cwiseAbs().maxCoeff(), 1e-6 * j.cwiseAbs().maxCoeff()) << b;
  }
}

// Coefficients drawn from the prior, readings of them with noise: (β − μ)ᵀ V⁻¹ (β − μ) of the isotropic modes is a χ², and
// intervals of 95 % of what is predicted hold 95 % of the truths. 4 standard deviations of 100 draws.
TEST(BlockFit, ContainsTheTruthAsOftenAsItSays) {
  constexpr int draws = 100;
  Invented block(1);
  const Index n = block.columns.isotropic_count();
  const Geometry there{{0.4, 0.2}, {0.7, 2}};
  const MatrixXd h = block.columns.isotropic_at({&there, 1});
  std::mt19937 engine(3);
  std::normal_distribution<double> normal;
  double chi_squared = 0, within = 0;
  for (int draw = 0; draw < draws; ++draw) {
    VectorXd truth = block.variances().cwiseSqrt();
    for (double& one : truth) one *= normal(engine);
    block.y = block.x * truth;
    for (double& one : block.y) one += std::sqrt(block.noise()) * normal(engine);
    block.gram.z = block.x.transpose() * block.y;
    block.gram.yy = block.y.squaredNorm();
    const Evidence found = block.found(block.at);
    const VectorXd roots = block.variances().head(n).cwiseSqrt();
    const MatrixXd v = roots.asDiagonal() * found.inverse.matrix.topLeftCorner(n, n) * roots.asDiagonal();
    const VectorXd apart = truth.head(n) - found.mean.head(n);
    chi_squared += apart.dot(v.ldlt().solve(apart));
    const VectorXd u = (h * v * h.transpose()).diagonal().cwiseSqrt();
    within += ((h * apart).cwiseAbs().array() < 1.959964 * u.array()).cast<double>().mean();
  }
  const double freedom = static_cast<double>(n);
  EXPECT_NEAR(chi_squared / draws, freedom, 4 * std::sqrt(2 * freedom / draws));
  EXPECT_NEAR(within / draws, 0.95, 4 * std::sqrt(0.95 * 0.05 / draws));
}

/// Nodes of the mean over a direction uniform in projected cosine, up to 75 degrees.
std::vector<Node> polar_nodes() {
  std::vector<Node> result = gauss_legendre(20);
  for (Node& node : result) node.x = std::asin(std::sqrt(node.x) * std::sin(radians(75)));
  return result;
}

// The mean square of h μ − g a over both directions is least where gᵀ(g a − h μ) has no mean. 1e-7: 20 nodes of an
// analytic integrand; azimuths are exact.
TEST(BlockFit, EvaluatesWhatIsNearestToThePosteriorMean) {
  constexpr int azimuths = 16;
  for (const std::size_t b : some_blocks) {
    const MixedColumns columns(blocks(Family::isotropic, {5, 4})[b], DiscMapping::lambert);
    const std::vector<Index> kept = columns_of(blocks(Family::isotropic, {3, 2})[b], columns.isotropic());
    const MatrixXd p = projection(columns, kept);
    MatrixXd left = MatrixXd::Zero(p.rows(), p.cols());
    double size = 0;
    for (const Node& i : polar_nodes())
      for (const Node& r : polar_nodes()) {
        std::vector<Geometry> around;
        for (int a = 0; a < azimuths; ++a) around.push_back({{i.x, 0}, {r.x, 2 * std::numbers::pi * a / azimuths}});
        const MatrixXd h = columns.isotropic_at(around), g = h(Eigen::all, kept);
        left += i.weight * r.weight * g.transpose() * (g * p - h);
        size += i.weight * r.weight * h.squaredNorm();
      }
    EXPECT_LT(left.cwiseAbs().maxCoeff(), 1e-7 * size) << b;
  }
}

}  // namespace
}  // namespace mmbrdf
