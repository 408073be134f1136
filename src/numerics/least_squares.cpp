// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/numerics/least_squares.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "numerics/eigen_index.hpp"
#include "numerics/shared_rows.hpp"
#include "text/numbers.hpp"

// The problem [A b] is kept as the triangle T of its QR factorisation, T = [R q; 0 ρ]: R is that of A, q = Qᵀb, and |ρ|
// is the norm of what the columns of A cannot reach.

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Vector = Eigen::Map<const VectorXd>;

constexpr std::size_t rows_at_once = 128;    // keeps a block of rows in the cache
constexpr double estimability_limit = 1e-8;  // theory 4.7

/// Four sums at a time, of which none waits for another.
template <class Step>
double over_all(std::span<const double> numbers, Step step) {
  std::array<double, 4> parts{};
  std::size_t i = 0;
  for (; i + 4 <= numbers.size(); i += 4)
    for (std::size_t k = 0; k < 4; ++k) parts[k] = step(parts[k], numbers[i + k]);
  for (; i < numbers.size(); ++i) parts[0] = step(parts[0], numbers[i]);
  return step(step(parts[0], parts[1]), step(parts[2], parts[3]));
}

void require_finite(std::span<const double> numbers, const char* what) {
  if (over_all(numbers, [](double sum, double x) { return sum + 0 * x; }) == 0) return;  // NaN if one is not finite
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (!std::isfinite(numbers[i]))
      throw std::invalid_argument(std::string(what) + " number " + std::to_string(i + 1) + " is not finite");
}

/// Column j of a square, multiplied by a factor, as column `to`.
void copy_column(const std::vector<double>& square, std::size_t j, double factor, RowColumns& rows, std::size_t to) {
  for (std::size_t i = 0; i < rows.rows(); ++i) rows.column(to)[i] = factor * square[j * rows.rows() + i];
}

}  // namespace

double Solution::condition() const {
  return rank == 0 ? 0 : singular_values.front() / singular_values[static_cast<std::size_t>(rank) - 1];
}

double Solution::variance() const {
  return degrees_of_freedom() > 0 ? residual_norm * residual_norm / static_cast<double>(degrees_of_freedom()) : 0;
}

bool Solution::estimable(std::span<const double> g) const {
  if (g.size() != x.size())
    throw std::invalid_argument(std::to_string(g.size()) + " numbers for " + std::to_string(x.size()) + " unknowns");
  const Vector direction(g.data(), index(g.size()));
  const Eigen::Map<const MatrixXd> null(null_space.data(), index(g.size()), index(g.size()) - rank);
  return (null.transpose() * direction).norm() <= estimability_limit * direction.norm();
}

LeastSquares::LeastSquares(int unknowns) : unknowns_(unknowns) {
  if (unknowns < 1 || unknowns > max_unknowns)
    throw std::invalid_argument("unknowns = " + std::to_string(unknowns) + ", must be in 1..." +
                                std::to_string(max_unknowns));
  triangle_.assign(width() * width(), 0.0);
}

void LeastSquares::add(std::span<const double> rows, std::span<const double> values, std::span<const double> weights) {
  const std::size_t n = width() - 1;
  if (rows.size() != n * values.size())
    throw std::invalid_argument(std::to_string(rows.size()) + " numbers in " + std::to_string(values.size()) +
                                " rows of " + std::to_string(n) + " unknowns");
  if (!weights.empty() && weights.size() != values.size())
    throw std::invalid_argument(std::to_string(weights.size()) + " weights for " + std::to_string(values.size()) +
                                " rows");
  require_finite(rows, "row");
  require_finite(values, "value");
  require_finite(weights, "weight");
  if (const auto low = std::find_if(weights.begin(), weights.end(), [](double w) { return w < 0; });
      low != weights.end())
    throw std::invalid_argument("weight " + shortest(*low) + " is negative");

  const auto largest = [](std::span<const double> numbers) {
    return over_all(numbers, [](double m, double x) { return std::max(m, std::abs(x)); });
  };
  if (!weights.empty() && !std::isfinite(std::sqrt(largest(weights)) * std::max(largest(rows), largest(values))))
    throw std::invalid_argument("weight " + shortest(largest(weights)) + " makes a row infinite");

  for (std::size_t first = 0; first < values.size(); first += rows_at_once) {
    const std::size_t count = std::min(rows_at_once, values.size() - first);
    RowColumns columns(width(), count);
    for (std::size_t row = 0; row < count; ++row) {
      const double factor = weights.empty() ? 1 : std::sqrt(weights[first + row]);
      for (std::size_t j = 0; j < n; ++j) columns.column(j)[row] = factor * rows[(first + row) * n + j];
      columns.column(n)[row] = factor * values[first + row];
    }
    fold(triangle_.data(), n, columns);
  }
  rows_ += static_cast<long>(values.size()) - std::count(weights.begin(), weights.end(), 0.0);
}

void LeastSquares::merge(const LeastSquares& other) {
  if (other.unknowns_ != unknowns_)
    throw std::invalid_argument("cannot merge " + std::to_string(other.unknowns_) + " unknowns into " +
                                std::to_string(unknowns_));
  if (std::all_of(triangle_.begin(), triangle_.end(), [](double x) { return x == 0; })) {
    triangle_ = other.triangle_;
  } else {
    RowColumns rows(width(), width());
    for (std::size_t j = 0; j < width(); ++j) copy_column(other.triangle_, j, 1, rows, j);
    fold(triangle_.data(), width() - 1, rows, Shape::triangle);
  }
  rows_ += other.rows_;
}

LeastSquares LeastSquares::repeated(std::span<const double> factors, double value_factor) const {
  require_finite(factors, "factor");
  require_finite({&value_factor, 1}, "value factor");
  if (factors.size() > static_cast<std::size_t>(max_unknowns)) throw std::invalid_argument("too many factors");
  LeastSquares result(unknowns_ * static_cast<int>(factors.size()));
  RowColumns rows(result.width(), width());
  std::size_t j = 0;
  for (const double factor : factors)
    for (std::size_t column = 0; column + 1 < width(); ++column) copy_column(triangle_, column, factor, rows, j++);
  copy_column(triangle_, width() - 1, value_factor, rows, j);
  fold(result.triangle_.data(), result.width() - 1, rows, Shape::triangle);
  result.rows_ = rows_;
  return result;
}

LeastSquares LeastSquares::restricted(std::span<const std::size_t> unknowns) const {
  std::vector<bool> taken(width() - 1, false);
  for (const std::size_t unknown : unknowns) {
    if (unknown >= taken.size() || taken[unknown])
      throw std::invalid_argument("unknown number " + std::to_string(unknown) +
                                  (unknown < taken.size() ? " comes twice" : " is not there"));
    taken[unknown] = true;
  }
  LeastSquares result(static_cast<int>(unknowns.size()));
  RowColumns rows(result.width(), width());
  std::size_t j = 0;
  for (const std::size_t unknown : unknowns) copy_column(triangle_, unknown, 1, rows, j++);
  copy_column(triangle_, width() - 1, 1, rows, j);
  fold(result.triangle_.data(), result.width() - 1, rows);
  result.rows_ = rows_;
  return result;
}

double LeastSquares::residual_norm(std::span<const double> x) const {
  if (x.size() + 1 != width())
    throw std::invalid_argument(std::to_string(x.size()) + " values for " + std::to_string(unknowns_) + " unknowns");
  const Eigen::Map<const MatrixXd> triangle(triangle_.data(), index(width()), index(width()));
  VectorXd extended(index(width()));
  extended << Vector(x.data(), unknowns_), -1;
  return VectorXd(triangle.triangularView<Eigen::Upper>() * extended).stableNorm();
}

std::vector<double> LeastSquares::normal_matrix() const {
  const Eigen::Map<const MatrixXd> triangle(triangle_.data(), index(width()), index(width()));
  const MatrixXd r = triangle.topLeftCorner(unknowns_, unknowns_).triangularView<Eigen::Upper>();
  const MatrixXd product = r.transpose() * r;
  return {product.data(), product.data() + product.size()};
}

std::vector<double> LeastSquares::normal_vector() const {
  const Eigen::Map<const MatrixXd> triangle(triangle_.data(), index(width()), index(width()));
  const VectorXd product = triangle.topLeftCorner(unknowns_, unknowns_).triangularView<Eigen::Upper>().transpose() *
                           triangle.col(unknowns_).head(unknowns_);
  return {product.data(), product.data() + product.size()};
}

std::vector<double> LeastSquares::state() const {
  std::vector<double> result;
  result.reserve(width() * (width() + 1) / 2 + 1);
  for (std::size_t row = 0; row < width(); ++row)
    for (std::size_t column = row; column < width(); ++column) result.push_back(triangle_[column * width() + row]);
  result.push_back(static_cast<double>(rows_));
  return result;
}

LeastSquares LeastSquares::from_state(int unknowns, std::span<const double> state) {
  LeastSquares result(unknowns);
  const std::size_t width = result.width();
  if (state.size() != width * (width + 1) / 2 + 1)
    throw std::invalid_argument("a state of " + std::to_string(state.size()) + " numbers for " +
                                std::to_string(unknowns) + " unknowns");
  require_finite(state, "state");
  if (state.back() < 0 || state.back() != std::floor(state.back()) || state.back() > 9e15)
    throw std::invalid_argument("a state with " + shortest(state.back()) + " rows");
  auto next = state.begin();
  for (std::size_t row = 0; row < width; ++row)
    for (std::size_t column = row; column < width; ++column) result.triangle_[column * width + row] = *next++;
  result.rows_ = static_cast<long>(state.back());
  return result;
}

Solution LeastSquares::solve(double tolerance) const {
  if (!(tolerance >= 0 && tolerance < 1))
    throw std::invalid_argument("rank tolerance " + shortest(tolerance) + " is not in [0, 1)");
  Decompositions none;
  return SharedRows(*this).solve(MatrixXd::Ones(1, 1), rows_, tolerance, none);
}

}  // namespace mmbrdf
