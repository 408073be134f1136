// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/numerics/least_squares.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>
#include <stdexcept>
#include <string>

#include "numerics/eigen_index.hpp"
#include "numerics/fold.hpp"
#include "numerics/svd_cache.hpp"
#include "text/numbers.hpp"

// The problem [A b] is kept as the triangle T of its QR factorisation, T = [R q; 0 ρ]: R is that of A, q = Qᵀb, and |ρ|
// is the norm of what the columns of A cannot reach. Each column of values has its q and its ρ.

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Vector = Eigen::Map<const VectorXd>;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

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

/// A combination of a singular vector of the factors and one of the triangle.
struct SingularPair {
  Index factor, unknown;
  double value;  // singular value: the product of both
};

std::vector<SingularPair> pairs_by_falling_value(const VectorXd& of_factors, const VectorXd& of_unknowns) {
  std::vector<SingularPair> pairs;
  for (Index f = 0; f < of_factors.size(); ++f)
    for (Index u = 0; u < of_unknowns.size(); ++u) pairs.push_back({f, u, of_factors(f) * of_unknowns(u)});
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const SingularPair& a, const SingularPair& b) { return a.value > b.value; });
  return pairs;
}

std::vector<double> numbers_of(const MatrixXd& m) { return {m.data(), m.data() + m.size()}; }

/// Of singular vectors v, falling with their values, and what each gives of the right side. The residual norm is that
/// of the last of these alone.
Solution solution_of(MatrixXd v, const VectorXd& values, const VectorXd& right, double tolerance) {
  Solution solution;
  solution.singular_values = numbers_of(values);
  const Index size = values.size(), rank = (values.array() > tolerance * values(0)).count();
  solution.rank = static_cast<int>(rank);
  solution.null_space = numbers_of(v.rightCols(size - rank));
  solution.residual_norm = right.tail(size - rank).stableNorm();
  for (Index q = 0; q < rank; ++q) v.col(q) /= values(q);
  solution.x = numbers_of(v.leftCols(rank) * right.head(rank));
  MatrixXd inverse = MatrixXd::Zero(size, size);                                       // symmetric to the last bit
  if (rank > 0) inverse.selfadjointView<Eigen::Lower>().rankUpdate(v.leftCols(rank));  // of 0 columns it divides by 0
  inverse.triangularView<Eigen::StrictlyUpper>() = inverse.transpose();
  solution.inverse = numbers_of(inverse);
  return solution;
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

LeastSquares::LeastSquares(int unknowns, int values) : unknowns_(unknowns), values_(values) {
  if (unknowns < 1 || unknowns > max_unknowns)
    throw std::invalid_argument("unknowns = " + std::to_string(unknowns) + ", must be in 1..." +
                                std::to_string(max_unknowns));
  if (values < 1) throw std::invalid_argument("columns of values = " + std::to_string(values) + ", must be at least 1");
  triangle_.assign(height() * width(), 0.0);
}

void LeastSquares::add(std::span<const double> rows, std::span<const double> values, std::span<const double> weights) {
  const std::size_t n = height() - 1, columns = width() - n, count = values.size() / columns;
  if (rows.size() != n * count || values.size() != columns * count)
    throw std::invalid_argument(std::to_string(rows.size()) + " numbers in " + std::to_string(count) + " rows of " +
                                std::to_string(n) + " unknowns");
  if (!weights.empty() && weights.size() != count)
    throw std::invalid_argument(std::to_string(weights.size()) + " weights for " + std::to_string(count) + " rows");
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

  for (std::size_t first = 0; first < count; first += rows_at_once) {
    RowColumns block(width(), std::min(rows_at_once, count - first));
    for (std::size_t row = 0; row < block.rows(); ++row) {
      const double factor = weights.empty() ? 1 : std::sqrt(weights[first + row]);
      for (std::size_t j = 0; j < n; ++j) block.column(j)[row] = factor * rows[(first + row) * n + j];
      for (std::size_t v = 0; v < columns; ++v) block.column(n + v)[row] = factor * values[(first + row) * columns + v];
    }
    add(block, 0);
  }
  rows_ += static_cast<long>(count) - std::count(weights.begin(), weights.end(), 0.0);
}

void LeastSquares::add(RowColumns& rows, long count) {
  fold(triangle_.data(), height() - 1, rows);
  rows_ += count;
}

void LeastSquares::merge(const LeastSquares& other) {
  if (other.unknowns_ != unknowns_ || other.values_ != values_)
    throw std::invalid_argument("cannot merge " + std::to_string(other.unknowns_) + " unknowns into " +
                                std::to_string(unknowns_));
  if (std::all_of(triangle_.begin(), triangle_.end(), [](double x) { return x == 0; })) {
    triangle_ = other.triangle_;
    rows_ += other.rows_;
  } else {
    merge_repeated(other, std::array{1.0});
  }
}

void LeastSquares::merge_repeated(const LeastSquares& other, std::span<const double> factors, double value_factor) {
  require_finite(factors, "factor");
  require_finite({&value_factor, 1}, "value factor");
  if (factors.size() * (other.height() - 1) != height() - 1 || other.values_ != values_)
    throw std::invalid_argument(std::to_string(factors.size()) + " factors for " + std::to_string(other.unknowns_) +
                                " unknowns do not make " + std::to_string(unknowns_));
  RowColumns rows(width(), other.height());
  std::size_t to = 0;
  for (const double factor : factors)
    for (std::size_t j = 0; j + 1 < other.height(); ++j) other.copy_column(j, factor, rows, to++);
  for (std::size_t j = other.height() - 1; j < other.width(); ++j) other.copy_column(j, value_factor, rows, to++);
  fold(triangle_.data(), height() - 1, rows, Shape::triangle);
  rows_ += other.rows_;
}

LeastSquares LeastSquares::repeated(std::span<const double> factors, double value_factor) const {
  if (factors.size() > static_cast<std::size_t>(max_unknowns)) throw std::invalid_argument("too many factors");
  LeastSquares result(unknowns_ * static_cast<int>(factors.size()), values_);
  result.merge_repeated(*this, factors, value_factor);
  return result;
}

LeastSquares LeastSquares::restricted(std::span<const std::size_t> unknowns) const {
  std::vector<bool> taken(height() - 1, false);
  for (const std::size_t unknown : unknowns) {
    if (unknown >= taken.size() || taken[unknown])
      throw std::invalid_argument("unknown number " + std::to_string(unknown) +
                                  (unknown < taken.size() ? " comes twice" : " is not there"));
    taken[unknown] = true;
  }
  LeastSquares result(static_cast<int>(unknowns.size()), values_);
  RowColumns rows(result.width(), height());
  std::size_t to = 0;
  for (const std::size_t unknown : unknowns) copy_column(unknown, 1, rows, to++);
  for (std::size_t j = height() - 1; j < width(); ++j) copy_column(j, 1, rows, to++);
  fold(result.triangle_.data(), result.height() - 1, rows);
  result.rows_ = rows_;
  return result;
}

/// Calls work(positions) for each set of problems that share their rows, and what is at the same places of `others` too.
template <class Work>
void LeastSquares::for_alike(std::span<const LeastSquares* const> problems, std::span<const LeastSquares* const> others,
                             Work work) {
  const auto is_single = [](const LeastSquares* one) { return one->values_ == 1; };
  if (!std::ranges::all_of(problems, is_single) || !std::ranges::all_of(others, is_single) ||
      (!others.empty() && others.size() != problems.size()))
    throw std::invalid_argument("problems must be as many as the others and have one column of values each");
  std::vector<bool> done(problems.size());
  for (std::size_t first = 0; first < problems.size(); ++first) {
    if (done[first]) continue;
    std::vector<std::size_t> alike;
    for (std::size_t p = first; p < problems.size(); ++p)
      if (!done[p] && problems[p]->has_rows_of(*problems[first]) &&
          (others.empty() || others[p]->has_rows_of(*others[first]))) {
        alike.push_back(p);
        done[p] = true;
      }
    work(alike);
  }
}

std::vector<LeastSquares> LeastSquares::restricted(std::span<const LeastSquares* const> problems,
                                                   std::span<const std::size_t> unknowns) {
  std::vector<LeastSquares> result(problems.size(), LeastSquares(1));
  for_alike(problems, {}, [&](const std::vector<std::size_t>& alike) {
    const LeastSquares all = joined(problems, alike).restricted(unknowns);
    for (std::size_t v = 0; v < alike.size(); ++v) {
      result[alike[v]] = all.of(static_cast<int>(v));
      result[alike[v]].rows_ = problems[alike[v]]->rows_;
    }
  });
  return result;
}

void LeastSquares::merge(std::span<LeastSquares* const> problems, std::span<const LeastSquares* const> others) {
  const std::vector<const LeastSquares*> before(problems.begin(), problems.end());
  for_alike(before, others, [&](const std::vector<std::size_t>& alike) {
    LeastSquares all = joined(before, alike);
    all.merge(joined(others, alike));
    for (std::size_t v = 0; v < alike.size(); ++v) {
      const long rows = problems[alike[v]]->rows_ + others[alike[v]]->rows_;
      *problems[alike[v]] = all.of(static_cast<int>(v));
      problems[alike[v]]->rows_ = rows;
    }
  });
}

/// Some of them beside each other.
LeastSquares LeastSquares::joined(std::span<const LeastSquares* const> problems, std::span<const std::size_t> which) {
  LeastSquares result = *problems[which.front()];
  result.values_ = static_cast<int>(which.size());
  for (const std::size_t p : which.subspan(1))
    result.triangle_.insert(result.triangle_.end(),
                            problems[p]->triangle_.end() - static_cast<std::ptrdiff_t>(result.height()),
                            problems[p]->triangle_.end());
  return result;
}

void LeastSquares::copy_column(std::size_t j, double factor, RowColumns& rows, std::size_t to) const {
  for (std::size_t i = 0; i < height(); ++i) rows.column(to)[i] = factor * triangle_[j * height() + i];
}

LeastSquares LeastSquares::of(int value) const {
  if (value < 0 || value >= values_)
    throw std::invalid_argument("column " + std::to_string(value) + " of " + std::to_string(values_) + " of values");
  LeastSquares result(unknowns_);
  const auto unknowns_end = triangle_.begin() + static_cast<std::ptrdiff_t>((height() - 1) * height());
  std::copy(triangle_.begin(), unknowns_end, result.triangle_.begin());
  std::copy_n(unknowns_end + static_cast<std::ptrdiff_t>(height()) * value, height(),
              result.triangle_.end() - static_cast<std::ptrdiff_t>(height()));
  result.rows_ = rows_;
  return result;
}

bool LeastSquares::has_rows_of(const LeastSquares& other) const {
  if (unknowns_ != other.unknowns_) return false;
  const std::size_t size = (height() - 1) * height();
  return this == &other || std::memcmp(triangle_.data(), other.triangle_.data(), size * sizeof(double)) == 0 ||
         std::equal(triangle_.data(), triangle_.data() + size, other.triangle_.data());  // 0 and -0 are the same
}

LeastSquares LeastSquares::beside(std::span<const LeastSquares* const> problems, std::span<const double> divisors) {
  if (problems.empty() || divisors.size() != problems.size())
    throw std::invalid_argument(std::to_string(divisors.size()) + " divisors for " + std::to_string(problems.size()) +
                                " problems");
  LeastSquares result = *problems[0];
  result.values_ = static_cast<int>(problems.size());
  result.triangle_.resize(result.height() * (result.height() - 1));
  for (std::size_t v = 0; v < problems.size(); ++v) {
    if (!problems[v]->has_rows_of(*problems[0]) || problems[v]->values_ != 1)
      throw std::invalid_argument("problem " + std::to_string(v + 1) + " has other rows than the first");
    for (std::size_t i = 0; i < result.height(); ++i)
      result.triangle_.push_back(problems[v]->triangle_[result.height() * (result.height() - 1) + i] / divisors[v]);
  }
  return result;
}

double LeastSquares::residual_norm(std::span<const double> x) const {
  if (x.size() + 1 != height())
    throw std::invalid_argument(std::to_string(x.size()) + " values for " + std::to_string(unknowns_) + " unknowns");
  const Eigen::Map<const MatrixXd> triangle(triangle_.data(), index(height()), index(height()));
  VectorXd extended(index(height()));
  extended << Vector(x.data(), unknowns_), -1;
  return VectorXd(triangle.triangularView<Eigen::Upper>() * extended).stableNorm();
}

std::vector<double> LeastSquares::normal_matrix() const {
  const Eigen::Map<const MatrixXd> triangle(triangle_.data(), index(height()), index(height()));
  const MatrixXd r = triangle.topLeftCorner(unknowns_, unknowns_).triangularView<Eigen::Upper>();
  return numbers_of(r.transpose() * r);
}

std::vector<double> LeastSquares::normal_vector() const {
  const Eigen::Map<const MatrixXd> triangle(triangle_.data(), index(height()), index(height()));
  const VectorXd product = triangle.topLeftCorner(unknowns_, unknowns_).triangularView<Eigen::Upper>().transpose() *
                           triangle.col(unknowns_).head(unknowns_);
  return numbers_of(product);
}

std::vector<double> LeastSquares::state() const {
  if (values_ != 1) throw std::invalid_argument(std::to_string(values_) + " columns of values, a state has one");
  std::vector<double> result;
  result.reserve(state_size(unknowns_));
  for (std::size_t row = 0; row < height(); ++row)
    for (std::size_t column = row; column < height(); ++column) result.push_back(triangle_[column * height() + row]);
  result.push_back(static_cast<double>(rows_));
  return result;
}

LeastSquares LeastSquares::from_state(int unknowns, std::span<const double> state) {
  LeastSquares result(unknowns);
  const std::size_t width = result.width();
  if (state.size() != state_size(unknowns))
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

Solution LeastSquares::solve(double tolerance, SvdCache* known) const {
  return solve_over(std::array{1.0}, rows_, tolerance, known);
}

Solution LeastSquares::solve_over(std::span<const double> factors, long rows, double tolerance, SvdCache* known) const {
  if (!(tolerance >= 0 && tolerance < 1))
    throw std::invalid_argument("rank tolerance " + shortest(tolerance) + " is not in [0, 1)");
  const Index n = unknowns_, powers = index(factors.size()) / values_;
  if (powers < 1 || powers > values_ || powers * values_ != index(factors.size()))
    throw std::invalid_argument(std::to_string(factors.size()) + " factors for " + std::to_string(values_) +
                                " columns of values");
  const Eigen::Map<const MatrixXd> triangle(triangle_.data(), n + 1, n + values_);
  MatrixXd columns = triangle.topRightCorner(n, values_);
  const dense::Svd outer =
      dense::full_svd(dense::triangle(Eigen::Map<const RowMajor>(factors.data(), values_, powers), columns));
  SvdCache none;
  const dense::Svd& inner = (known ? *known : none).of(triangle.topLeftCorner(n, n));
  const MatrixXd projected = inner.u.transpose() * columns.leftCols(powers) * outer.u;

  const std::vector<SingularPair> pairs = pairs_by_falling_value(outer.s, inner.s);
  const Index size = index(pairs.size());
  MatrixXd v(size, size);
  VectorXd values(size), right(size);
  for (Index q = 0; q < size; ++q) {
    const auto [factor, unknown, value] = pairs[static_cast<std::size_t>(q)];
    for (Index p = 0; p < powers; ++p) v.col(q).segment(p * n, n) = outer.v(p, factor) * inner.v.col(unknown);
    values(q) = value;
    right(q) = projected(unknown, factor);
  }
  Solution solution = solution_of(std::move(v), values, right, tolerance);
  solution.rows = rows;
  solution.residual_norm = std::hypot(triangle.bottomRightCorner(1, values_).stableNorm(),
                                      columns.rightCols(values_ - powers).stableNorm(), solution.residual_norm);
  return solution;
}

}  // namespace mmbrdf
