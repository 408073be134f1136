// SPDX-License-Identifier: BSD-3-Clause
#include "mixed/evidence.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "numerics/gram.hpp"

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double connected = 1e-9;    // least correlation of two columns of one part
constexpr double least_noise = 1e-8;  // variance, of the mean square of the readings: none is right to 1e-4
constexpr double no_noise = 1e-16;    // and of readings that are all 0
constexpr double longest_step = 4;    // of one logarithm
constexpr double enough = 1e-8;       // gain of evidence that a step must promise
constexpr double near = 1e-3;         // what is promised where slopes decide
constexpr int most_steps = 100;
constexpr std::size_t memory = 10;  // steps that a quasi-Newton direction remembers

Index root_of(std::vector<Index>& above, Index j) {
  while (above[static_cast<std::size_t>(j)] != j)
    j = above[static_cast<std::size_t>(j)] = above[static_cast<std::size_t>(above[static_cast<std::size_t>(j)])];
  return j;
}

/// G x, as if columns of different parts had no products: as inverse_of() takes them.
VectorXd product(const MatrixXd& g, const Parts& parts, const VectorXd& x) {
  VectorXd result = VectorXd::Zero(x.size());
  for (const std::vector<Index>& part : parts.columns)
    for (auto k = part.begin(); k != part.end(); ++k) {
      double row = g(*k, *k) * x(*k);
      for (auto j = k + 1; j != part.end(); ++j) {
        result(*j) += g(*j, *k) * x(*k);
        row += g(*j, *k) * x(*j);
      }
      result(*k) += row;
    }
  for (const Index c : parts.border) {
    result.head(c) += x(c) * g.row(c).head(c).transpose();
    result(c) = g.row(c).head(c + 1).dot(x.head(c + 1));
  }
  return result;
}

/// Steps and changes of the gradient, from which curvature is learnt (Nocedal and Wright, algorithm 7.4); where none is
/// known it is Fisher's information.
class Curvature {
 public:
  void learn(const VectorXd& step, const VectorXd& change) {
    if (step.dot(change) <= 1e-10) return;
    if (steps_.size() == memory) {
      steps_.erase(steps_.begin());
      changes_.erase(changes_.begin());
    }
    steps_.push_back(step);
    changes_.push_back(change);
  }
  VectorXd direction(const VectorXd& gradient, const MatrixXd& information) const {
    VectorXd q = gradient;
    std::vector<double> factors(steps_.size());
    for (std::size_t i = steps_.size(); i-- > 0;) {
      factors[i] = steps_[i].dot(q) / steps_[i].dot(changes_[i]);
      q -= factors[i] * changes_[i];
    }
    VectorXd result = information.ldlt().solve(q);
    for (std::size_t i = 0; i < steps_.size(); ++i)
      result += steps_[i] * (factors[i] - changes_[i].dot(result) / steps_[i].dot(changes_[i]));
    return result;
  }

 private:
  std::vector<VectorXd> steps_, changes_;
};

}  // namespace

void Gram::add(const MatrixXd& x, const VectorXd& y, const MatrixXd& errors) {
  add_gram(g, x, x.rows());
  z.noalias() += x.transpose() * y;
  d.noalias() += x.transpose() * errors;
  yy += y.squaredNorm();
  n += x.rows();
}

void Gram::merge(const Gram& other) {
  g += other.g;
  z += other.z;
  d += other.d;
  yy += other.yy;
  n += other.n;
}

Parts parts_of(const MatrixXd& g, Index border) {
  const Index inner = g.cols() - border;
  std::vector<Index> above(static_cast<std::size_t>(inner));
  std::iota(above.begin(), above.end(), Index{0});
  const VectorXd limit = std::sqrt(connected) * g.diagonal().cwiseSqrt();
  for (Index k = 0; k < inner; ++k)
    for (Index j = k + 1; j < inner; ++j)
      if (std::abs(g(j, k)) > limit(j) * limit(k)) {
        const Index a = root_of(above, j), b = root_of(above, k);
        above[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
      }
  Parts parts;
  std::vector<std::size_t> number(static_cast<std::size_t>(inner));
  for (Index j = 0; j < inner; ++j) {
    const Index root = root_of(above, j);
    if (root == j) {
      number[static_cast<std::size_t>(j)] = parts.columns.size();
      parts.columns.emplace_back();
    }
    parts.columns[number[static_cast<std::size_t>(root)]].push_back(j);
  }
  for (Index j = inner; j < g.cols(); ++j) parts.border.push_back(j);
  return parts;
}

// A = [D B; Bᵀ C] with D of separate parts: with U = D⁻¹ B and S = C − BᵀU it is
//   A⁻¹ = [D⁻¹ + U S⁻¹ Uᵀ, −U S⁻¹; −S⁻¹ Uᵀ, S⁻¹],   det A = det D det S.
Inverse inverse_of(const MatrixXd& g, const Parts& parts, const VectorXd& variances, double noise) {
  const Index size = g.cols(), border = static_cast<Index>(parts.border.size()), inner = size - border;
  const VectorXd roots = variances.cwiseSqrt();
  const auto scaled = [&](Index j, Index k) { return roots(j) * g(std::max(j, k), std::min(j, k)) * roots(k) / noise; };
  Inverse result{MatrixXd::Zero(size, size), 0};
  MatrixXd b(inner, border), u(inner, border), s = MatrixXd::Identity(border, border);
  for (Index c = 0; c < border; ++c) {
    for (Index j = 0; j < inner; ++j) b(j, c) = scaled(inner + c, j);
    for (Index r = 0; r < border; ++r) s(r, c) += scaled(inner + r, inner + c);
  }
  for (const std::vector<Index>& part : parts.columns) {
    const auto count = static_cast<Index>(part.size());
    MatrixXd a = MatrixXd::Zero(count, count);
    for (Index k = 0; k < count; ++k)
      for (Index j = k; j < count; ++j)
        a(j, k) = scaled(part[static_cast<std::size_t>(j)], part[static_cast<std::size_t>(k)]) + (j == k ? 1 : 0);
    result.log_determinant += invert(a);
    result.matrix(part, part) = a;
    if (border > 0) u(part, Eigen::all) = a * b(part, Eigen::all);
  }
  if (border == 0) return result;
  s -= b.transpose() * u;
  result.log_determinant += invert(s);
  const MatrixXd us = u * s;
  result.matrix.topLeftCorner(inner, inner).noalias() += us * u.transpose();
  result.matrix.topRightCorner(inner, border) = -us;
  result.matrix.bottomLeftCorner(border, inner) = -us.transpose();
  result.matrix.bottomRightCorner(border, border) = s;
  return result;
}

// The product with the inverse alone is off by the rounding of the inverse times b, which is as large as A: where
// readings leave columns open by parts of the prior, not of the solution. What it leaves of b mends that.
VectorXd solved(const MatrixXd& g, const Parts& parts, const VectorXd& variances, double noise, const Inverse& inverse,
                const VectorXd& b) {
  const VectorXd roots = variances.cwiseSqrt();
  const VectorXd x = inverse.matrix * b;
  return x + inverse.matrix * (b - x - roots.cwiseProduct(product(g, parts, roots.cwiseProduct(x))) / noise);
}

Evidence evidence(const Gram& gram, const Parts& parts, const Prior& prior, const LogVariances& at) {
  const Index count = prior.mean.size(), size = gram.z.size();
  const double noise = std::exp(at(count)), n = static_cast<double>(gram.n);
  const VectorXd theta = at.head(count), v = prior.variances(theta), roots = v.cwiseSqrt();
  Evidence result;
  result.inverse = inverse_of(gram.g, parts, v, noise);
  if (!std::isfinite(result.inverse.log_determinant)) {
    result.value = result.alone = std::nan("");
    result.gradient.setZero(count + 1);
    return result;
  }
  const MatrixXd& inverse = result.inverse.matrix;
  const VectorXd m = solved(gram.g, parts, v, noise, result.inverse, roots.cwiseProduct(gram.z) / noise),
                 r = inverse.diagonal();
  result.mean = roots.cwiseProduct(m);
  // ‖y − Xμ‖² = yy − zᵀμ − μᵀ(z − Gμ), and (yy − zᵀμ) / s² = ‖y − Xμ‖² / s² + mᵀm, which an error of μ changes little
  const double residual =
      gram.yy - gram.z.dot(result.mean) - result.mean.dot(gram.z - product(gram.g, parts, result.mean));
  result.alone = -0.5 * (n * at(count) + result.inverse.log_determinant + residual / noise + m.squaredNorm());
  const VectorXd pull = (theta - prior.mean).cwiseQuotient(prior.deviation);
  result.value = result.alone - 0.5 * pull.squaredNorm();
  result.gradient.resize(count + 1);
  result.gradient.head(count) = prior.design.transpose() * (0.5 * (m.array().square() - 1 + r.array())).matrix() -
                                pull.cwiseQuotient(prior.deviation);
  result.gradient(count) = 0.5 * (residual / noise + (1 - r.array()).sum() - n);
  // Of two columns ½ ((1 − A⁻¹)_jk)², of a column and the noise ½ (A⁻¹ − A⁻²)_jj, of the noise ½ (n − p + tr A⁻²).
  const MatrixXd squares = inverse.cwiseAbs2();
  const VectorXd of_square = squares.colwise().sum();
  const MatrixXd weighted = squares * prior.design;
  result.information.resize(count + 1, count + 1);
  result.information.topLeftCorner(count, count) =
      0.5 * prior.design.transpose() * (weighted + ((1 - 2 * r.array()).matrix().asDiagonal() * prior.design));
  result.information.diagonal().head(count) += prior.deviation.cwiseAbs2().cwiseInverse();
  result.information.topRightCorner(count, 1) = 0.5 * prior.design.transpose() * (r - of_square);
  result.information.bottomLeftCorner(1, count) = result.information.topRightCorner(count, 1).transpose();
  result.information(count, count) = 0.5 * (n - static_cast<double>(size) + of_square.sum());
  return result;
}

Estimate estimate(const Gram& gram, const Parts& parts, const Prior& prior, double noise) {
  const Index count = prior.mean.size();
  const double least = std::log(std::max(least_noise * gram.yy / static_cast<double>(gram.n), no_noise));
  Estimate result{LogVariances(count + 1), {}, 1};
  result.at << prior.mean, std::max(std::log(noise), least);
  result.evidence = evidence(gram, parts, prior, result.at);
  if (!std::isfinite(result.evidence.value))
    throw std::invalid_argument("the evidence of the mixed model is not finite");
  Curvature curvature;
  for (int step = 0; step < most_steps; ++step) {
    const Evidence& here = result.evidence;
    VectorXd direction = curvature.direction(here.gradient, here.information);
    if (here.gradient.dot(direction) <= 0) direction = here.information.ldlt().solve(here.gradient);
    direction *= std::min(1.0, longest_step / direction.cwiseAbs().maxCoeff());
    if (result.at(count) + direction(count) < least) direction(count) = least - result.at(count);
    const double promised = here.gradient.dot(direction);
    if (!(promised > enough)) return result;
    double part = 1;
    Evidence there;
    for (;; part /= 3) {
      there = evidence(gram, parts, prior, result.at + part * direction);
      ++result.evaluations;
      if (there.value > here.value + 1e-4 * part * promised) break;
      // Near the top what is gained drowns in the rounding of the evidence, the slope does not.
      if (std::isfinite(there.value) && promised < near && std::abs(there.gradient.dot(direction)) < 0.9 * promised)
        break;
      if (part < 1e-4) return result;
    }
    curvature.learn(part * direction, here.gradient - there.gradient);
    result.at += part * direction;
    result.evidence = std::move(there);
  }
  throw std::runtime_error("the variances of the mixed model were not found in " + std::to_string(most_steps) +
                           " steps");
}

}  // namespace mmbrdf
