// SPDX-License-Identifier: BSD-3-Clause
// Problems of least squares: random ones, and what is asked of their solutions.
#pragma once

#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "mmbrdf/numerics/least_squares.hpp"

namespace mmbrdf {

inline constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
inline constexpr double infinity = std::numeric_limits<double>::infinity();

// Of well-conditioned problems with numbers up to some ten and fewer than 100 rows.
inline constexpr double rounding = 1e-13;

using Numbers = std::vector<double>;

struct Problem {
  std::size_t unknowns = 1;
  Numbers rows, values, weights;  // as for add(); weights empty or one for each row
  std::size_t count() const { return values.size(); }
};

// inRange() alone would begin with numbers near −1 only.
inline double any_number() { return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(-1000000, 1000001)) * 1e-6; }

inline Numbers any_numbers(std::size_t count) {
  Numbers result(count);
  for (double& number : result) number = any_number();
  return result;
}

inline Problem any_problem(std::size_t unknowns, std::size_t count) {
  return {unknowns, any_numbers(unknowns * count), any_numbers(count), {}};
}

/// Random numbers plus a unit matrix on top: every column is independent of the others by a margin.
inline Problem any_determined_problem() {
  const auto unknowns = *rc::gen::inRange<std::size_t>(1, 31);  // the solver changes its method at 16
  Problem problem = any_problem(unknowns, *rc::gen::inRange(3 * unknowns, 6 * unknowns + 40));
  for (std::size_t j = 0; j < unknowns; ++j) problem.rows[j * unknowns + j] += 3;
  return problem;
}

inline LeastSquares accumulated(const Problem& problem) {
  LeastSquares result(static_cast<int>(problem.unknowns));
  result.add(problem.rows, problem.values, problem.weights);
  return result;
}

/// Rows of the problem, those named by `which` and in that order.
inline Problem chosen(const Problem& problem, const std::vector<std::size_t>& which) {
  Problem result{problem.unknowns, {}, {}, {}};
  for (const std::size_t row : which) {
    const auto first = problem.rows.begin() + static_cast<std::ptrdiff_t>(row * problem.unknowns);
    result.rows.insert(result.rows.end(), first, first + static_cast<std::ptrdiff_t>(problem.unknowns));
    result.values.push_back(problem.values[row]);
    if (!problem.weights.empty()) result.weights.push_back(problem.weights[row]);
  }
  return result;
}

inline std::vector<std::size_t> any_order(std::size_t count) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[*rc::gen::inRange<std::size_t>(0, i)]);
  return order;
}

inline double largest_difference(const Numbers& a, const Numbers& b) {
  if (a.size() != b.size()) return infinity;
  double result = 0;
  for (std::size_t i = 0; i < a.size(); ++i) result = std::max(result, std::abs(a[i] - b[i]));
  return result;
}

inline double largest(const Numbers& numbers) { return largest_difference(numbers, Numbers(numbers.size())); }

/// Whether two problems are one: the same x, covariance, rank, residual and number of rows.
inline bool agree(const Solution& a, const Solution& b, double tolerance) {
  return largest_difference(a.x, b.x) <= tolerance * std::max(1.0, largest(a.x)) &&
         largest_difference(a.inverse, b.inverse) <= tolerance * std::max(1.0, largest(a.inverse)) &&
         largest_difference(a.singular_values, b.singular_values) <= tolerance * a.singular_values[0] &&
         std::abs(a.residual_norm - b.residual_norm) <= tolerance * std::max(1.0, a.residual_norm) &&
         a.rank == b.rank && a.rows == b.rows;
}

/// a b for square matrices, row-major.
inline Numbers product(const Numbers& a, const Numbers& b, std::size_t n) {
  Numbers result(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t k = 0; k < n; ++k) result[i * n + j] += a[i * n + k] * b[k * n + j];
  return result;
}

inline Numbers normal_matrix(const Problem& problem) {  // AᵀA
  const std::size_t n = problem.unknowns;
  Numbers result(n * n);
  for (std::size_t row = 0; row < problem.count(); ++row)
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) result[i * n + j] += problem.rows[row * n + i] * problem.rows[row * n + j];
  return result;
}

inline double residual_norm(const Problem& problem, const Numbers& x) {
  double sum = 0;
  for (std::size_t row = 0; row < problem.count(); ++row) {
    double residual = -problem.values[row];
    for (std::size_t j = 0; j < problem.unknowns; ++j) residual += problem.rows[row * problem.unknowns + j] * x[j];
    sum += residual * residual;
  }
  return std::sqrt(sum);
}

inline double dot(const Numbers& a, const Numbers& b) { return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); }

}  // namespace mmbrdf
