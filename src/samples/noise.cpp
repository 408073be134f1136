// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/samples/noise.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "text/numbers.hpp"

// With β = (2 ln s, a, b) and z = (1, ln cos θi, −ln cos θr), the variance of a residual r is exp(zᵀβ) and
//
//   −2 ln L = Σ zᵀβ + r² exp(−zᵀβ),    score = ½ Σ z (r² exp(−zᵀβ) − 1),    Fisher's information = ½ Σ z zᵀ.
//
// The information does not depend on β: it is decomposed once. −ln L is convex in β.

namespace mmbrdf {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int least_rows = 4;
constexpr int most_steps = 200;
constexpr double grazing = 1e-9;        // cosine of a polar angle that counts as 90 degrees
constexpr double least_spread = 1e-12;  // eigenvalue of the information, relative to the largest
constexpr double converged = 1e-9;      // step, in units of the standard uncertainties
constexpr double rounding = 1e-12;      // of the likelihood, relative
constexpr double most_exponent = 100;

void refuse(const char* name, double theta, const std::string& reason) {
  throw std::invalid_argument(std::string(name) + " = " + shortest(in_degrees(theta)) + " degrees, where " + reason);
}

bool is_grazing(const Direction& direction) { return std::cos(direction.theta) < grazing; }

/// cos^a θi and cos^b θr. `infinite` says for which of the two angles 90 degrees is refused, with these words.
std::pair<double, double> powers(const NoiseLaw& law, const Geometry& g, std::pair<bool, bool> infinite,
                                 const std::string& what) {
  require_valid(g);
  if (!(law.scale >= 0) || !std::isfinite(law.scale))
    throw std::invalid_argument("scale = " + shortest(law.scale) + ", must be finite and not negative");
  if (infinite.first && is_grazing(g.incident)) refuse("theta_i", g.incident.theta, "the " + what + " infinite");
  if (infinite.second && is_grazing(g.reflected)) refuse("theta_r", g.reflected.theta, "the " + what + " infinite");
  const auto power = [](double theta, double exponent) { return std::pow(std::max(std::cos(theta), 0.0), exponent); };
  return {power(g.incident.theta, law.incident_exponent), power(g.reflected.theta, law.reflected_exponent)};
}

Vector3d regressors(const Geometry& g) {
  if (is_grazing(g.incident)) refuse("theta_i", g.incident.theta, "it says nothing");
  if (is_grazing(g.reflected)) refuse("theta_r", g.reflected.theta, "it says nothing");
  return {1, std::log(std::cos(g.incident.theta)), -std::log(std::cos(g.reflected.theta))};
}

/// Residuals, squared, with their regressors.
struct Rows {
  std::vector<Vector3d> z;
  std::vector<double> squares;
  Matrix3d information = Matrix3d::Zero();

  void add(const Vector3d& regressor, double residual) {
    z.push_back(regressor);
    squares.push_back(residual * residual);
    information += 0.5 * regressor * regressor.transpose();
  }

  double minus_two_log_likelihood(const Vector3d& beta) const {
    double sum = 0;
    for (std::size_t i = 0; i < z.size(); ++i) {
      const double log_variance = z[i].dot(beta);
      sum += log_variance + squares[i] * std::exp(-log_variance);
    }
    return sum;
  }

  Vector3d score(const Vector3d& beta) const {
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < z.size(); ++i) sum += 0.5 * z[i] * (squares[i] * std::exp(-z[i].dot(beta)) - 1);
    return sum;
  }
};

Rows rows_of(std::span<const Sample> samples, std::span<const Mueller> residuals, std::span<const Element> elements) {
  Rows rows;
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const std::string name = "sample " + std::to_string(s + 1);
    const Vector3d z = regressors(samples[s].geometry);
    for (const auto& [row, column] : elements) {
      if (row < 0 || row > 3 || column < 0 || column > 3)
        throw std::invalid_argument("element (" + std::to_string(row) + ", " + std::to_string(column) +
                                    "): row and column are counted from 0 to 3");
      if (not_measured(samples[s])[Element{row, column}.index()]) continue;
      const double residual = residuals[s](row, column) / (row == 0 && column == 0 ? samples[s].f11 : 1);
      if (!std::isfinite(residual * residual))
        throw std::invalid_argument(name + ": the residual of element " + std::to_string(row + 1) +
                                    std::to_string(column + 1) + " is not finite");
      rows.add(z, residual);
    }
  }
  return rows;
}

void require_determined(const Rows& rows) {
  if (rows.z.size() < least_rows)
    throw std::invalid_argument(std::to_string(rows.z.size()) + " residuals, too few for a law with 3 unknowns");
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(rows.information);
  if (!(eigen.eigenvalues()(0) > least_spread * eigen.eigenvalues()(2)))
    throw std::invalid_argument(
        "the polar angles of the samples do not determine the law of the noise; both must vary, each by itself");
}

/// Scoring from a uniform variance, with steps halved until the likelihood grows.
Vector3d most_likely(const Rows& rows, const Eigen::LLT<Matrix3d>& information) {
  double mean = 0;
  for (const double square : rows.squares) mean += square / static_cast<double>(rows.squares.size());
  const auto no_maximum = [] { return std::invalid_argument("too many residuals are 0 to have a law"); };
  if (!(mean > 0) || !std::isfinite(mean)) throw no_maximum();
  Vector3d beta(std::log(mean), 0, 0);
  double best = rows.minus_two_log_likelihood(beta);
  for (int i = 0; i < most_steps; ++i) {
    const Vector3d score = rows.score(beta);
    Vector3d step = information.solve(score);
    if (std::sqrt(std::abs(score.dot(step))) < converged) return beta;
    const double worst = best + rounding * (std::abs(best) + static_cast<double>(rows.z.size()));
    double next = rows.minus_two_log_likelihood(beta + step);
    for (int half = 0; half < 60 && !(next <= worst); ++half)
      next = rows.minus_two_log_likelihood(beta + (step *= 0.5));
    beta += step;
    best = std::min(best, next);
    if (!(beta.tail(2).cwiseAbs().maxCoeff() < most_exponent)) break;
  }
  throw no_maximum();
}

}  // namespace

double standard_deviation(const NoiseLaw& law, const Geometry& geometry) {
  const auto [a, b] = powers(law, geometry, {0 > law.incident_exponent, 0 < law.reflected_exponent}, "noise is");
  return law.scale * std::sqrt(a / b);
}

double weight(const NoiseLaw& law, const Geometry& geometry) {
  const auto [a, b] = powers(law, geometry, {law.incident_exponent > 0, law.reflected_exponent < 0}, "weight is");
  const double result = b / a / (law.scale * law.scale);
  if (!std::isfinite(result))
    throw std::invalid_argument("scale = " + shortest(law.scale) + ", the weight is infinite");
  return result;
}

std::string to_string(const NoiseEstimate& estimate) {
  const auto& [law, covariance, rows] = estimate;
  const double u = law.scale * std::sqrt(covariance[0]), u_i = std::sqrt(covariance[4]), u_r = std::sqrt(covariance[8]);
  return "sigma^2 = " + to_place_of(law.scale, u) + "^2 cos(theta_i)^" + to_place_of(law.incident_exponent, u_i) +
         " / cos(theta_r)^" + to_place_of(law.reflected_exponent, u_r) + ", u " + to_place_of(u, u) + ", " +
         to_place_of(u_i, u_i) + ", " + to_place_of(u_r, u_r);
}

NoiseEstimate estimate_noise(std::span<const Sample> samples, std::span<const Mueller> residuals,
                             std::span<const Element> elements) {
  if (samples.size() != residuals.size())
    throw std::invalid_argument(std::to_string(residuals.size()) + " residuals for " + std::to_string(samples.size()) +
                                " samples");
  const Rows rows = rows_of(samples, residuals, elements);
  if (rows.z.empty() && !samples.empty() && !elements.empty())
    throw std::invalid_argument("the elements whose residuals tell the law of the noise were not measured");
  require_determined(rows);
  const Eigen::LLT<Matrix3d> information(rows.information);
  const Vector3d beta = most_likely(rows, information);
  NoiseEstimate result;
  result.law = {std::exp(beta(0) / 2), beta(1), beta(2)};
  Matrix3d covariance = information.solve(Matrix3d::Identity());
  covariance.row(0) *= 0.5;  // of ln s, which is half of the first unknown
  covariance.col(0) *= 0.5;
  for (std::size_t i = 0; i < 9; ++i)
    result.covariance[i] = covariance(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3));
  result.rows = static_cast<long>(rows.z.size());
  return result;
}

}  // namespace mmbrdf
