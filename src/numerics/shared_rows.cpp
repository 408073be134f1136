// SPDX-License-Identifier: BSD-3-Clause
#include "numerics/shared_rows.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "numerics/dense.hpp"
#include "numerics/eigen_index.hpp"

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A combination of a singular vector of the factors and one of the triangle.
struct Pair {
  Index factor, unknown;
  double value;  // singular value: the product of both
};

std::vector<Pair> pairs_by_falling_value(const VectorXd& of_factors, const VectorXd& of_unknowns) {
  std::vector<Pair> pairs;
  for (Index f = 0; f < of_factors.size(); ++f)
    for (Index u = 0; u < of_unknowns.size(); ++u) pairs.push_back({f, u, of_factors(f) * of_unknowns(u)});
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.value > b.value; });
  return pairs;
}

std::vector<double> numbers_of(const MatrixXd& m) { return {m.data(), m.data() + m.size()}; }

}  // namespace

const Decompositions::Svd& Decompositions::of(const MatrixXd& triangle) {
  for (const Svd& svd : known_)
    if (svd.triangle.rows() == triangle.rows() && svd.triangle == triangle) return svd;
  dense::Svd svd = dense::full_svd(triangle);
  known_.push_back({triangle, std::move(svd.u), std::move(svd.v), std::move(svd.s)});
  return known_.back();
}

SharedRows::SharedRows(std::size_t unknowns, std::size_t values)
    : triangle_(MatrixXd::Zero(index(unknowns + 1), index(unknowns + values))) {}

SharedRows::SharedRows(const LeastSquares& problem) : SharedRows(static_cast<std::size_t>(problem.unknowns()), 1) {
  const std::vector<double> state = problem.state();
  auto next = state.begin();
  for (Index row = 0; row < triangle_.rows(); ++row)
    for (Index column = row; column < triangle_.cols(); ++column) triangle_(row, column) = *next++;
}

void SharedRows::add(RowColumns& rows, Shape shape) {
  if (shape == Shape::triangle && index(rows.rows()) == triangle_.rows() && (triangle_.array() == 0).all()) {
    for (std::size_t j = 0; j < rows.columns(); ++j)
      std::copy_n(rows.column(j), rows.rows(), triangle_.col(index(j)).data());
    return;
  }
  fold(triangle_.data(), static_cast<std::size_t>(count()), rows, shape);
}

bool SharedRows::has_unknowns_of(const SharedRows& other) const { return unknowns() == other.unknowns(); }

LeastSquares SharedRows::of(std::size_t value, long rows) const {
  std::vector<double> state;
  const Index n = count(), column = n + index(value);
  state.reserve(static_cast<std::size_t>((n + 1) * (n + 2) / 2 + 1));
  for (Index row = 0; row <= n; ++row) {
    for (Index j = row; j < n; ++j) state.push_back(triangle_(row, j));
    state.push_back(triangle_(row, column));
  }
  state.push_back(static_cast<double>(rows));
  return LeastSquares::from_state(static_cast<int>(n), state);
}

Solution SharedRows::solve(const MatrixXd& factors, long rows, double tolerance, Decompositions& known) const {
  const Index n = count(), powers = factors.cols();
  MatrixXd values = triangle_.topRightCorner(n, factors.rows());
  const dense::Svd outer = dense::full_svd(dense::triangle(factors, values));
  const Decompositions::Svd& inner = known.of(unknowns());
  const MatrixXd projected = inner.u.transpose() * values.leftCols(powers) * outer.u;

  const std::vector<Pair> pairs = pairs_by_falling_value(outer.s, inner.s);
  const auto is_kept = [&](const Pair& pair) { return pair.value > tolerance * pairs.front().value; };
  const Index size = index(pairs.size()), rank = std::count_if(pairs.begin(), pairs.end(), is_kept);
  MatrixXd v(size, size);
  VectorXd right(size);
  for (Index q = 0; q < size; ++q) {
    const Pair& pair = pairs[static_cast<std::size_t>(q)];
    for (Index p = 0; p < powers; ++p) v.col(q).segment(p * n, n) = outer.v(p, pair.factor) * inner.v.col(pair.unknown);
    right(q) = projected(pair.unknown, pair.factor);
  }

  Solution solution;
  for (const Pair& pair : pairs) solution.singular_values.push_back(pair.value);
  solution.rank = static_cast<int>(rank);
  solution.rows = rows;
  solution.null_space = numbers_of(v.rightCols(size - rank));
  solution.residual_norm =
      std::hypot(triangle_.bottomRightCorner(1, factors.rows()).stableNorm(),
                 values.rightCols(factors.rows() - powers).stableNorm(), right.tail(size - rank).stableNorm());
  for (Index q = 0; q < rank; ++q) v.col(q) /= pairs[static_cast<std::size_t>(q)].value;
  const auto kept = v.leftCols(rank);
  const VectorXd x = kept * right.head(rank);
  solution.x.assign(x.data(), x.data() + size);
  MatrixXd inverse = MatrixXd::Zero(size, size);  // symmetric to the last bit
  inverse.selfadjointView<Eigen::Lower>().rankUpdate(kept);
  inverse.triangularView<Eigen::StrictlyUpper>() = inverse.transpose();
  solution.inverse = numbers_of(inverse);
  return solution;
}

}  // namespace mmbrdf
