// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/numerics/least_squares.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "given/problems.hpp"

namespace mmbrdf {
namespace {

// x + y = 2 twice: the shortest solution is (1, 1), and x − y is not determined.
TEST(LeastSquares, TakesTheShortestOfManySolutions) {
  LeastSquares sum(2);
  sum.add(Numbers{1, 1, 1, 1}, Numbers{2, 2});
  const Solution solution = sum.solve();
  EXPECT_EQ(solution.rank, 1);
  EXPECT_LE(largest_difference(solution.x, {1, 1}), rounding);
  EXPECT_LE(largest_difference(solution.inverse, {0.125, 0.125, 0.125, 0.125}), rounding);
  EXPECT_EQ(solution.null_space.size(), 2u);
  EXPECT_NEAR(std::abs(solution.null_space[0]), std::sqrt(0.5), rounding);
  EXPECT_NEAR(solution.null_space[0] + solution.null_space[1], 0, rounding);
  EXPECT_NEAR(solution.condition(), 1, rounding);
  EXPECT_TRUE(solution.estimable(Numbers{1, 1}));
  EXPECT_TRUE(solution.estimable(Numbers{-3e5, -3e5}));
  EXPECT_FALSE(solution.estimable(Numbers{1, -1}));
  EXPECT_FALSE(solution.estimable(Numbers{1, 0}));
}

TEST(LeastSquares, SolvesFewerRowsThanUnknownsByTheShortestVector) {
  LeastSquares one(2);
  one.add(Numbers{3, 4}, Numbers{5});
  const Solution solution = one.solve();
  EXPECT_LE(largest_difference(solution.x, {0.6, 0.8}), rounding);
  EXPECT_EQ(solution.rank, 1);
  EXPECT_NEAR(solution.residual_norm, 0, rounding);
  EXPECT_EQ(solution.degrees_of_freedom(), 0);
  EXPECT_EQ(solution.variance(), 0);
}

TEST(LeastSquares, OfRowsOfZerosDeterminesNothing) {
  for (const int unknowns : {1, 7, 40, 60}) {
    LeastSquares rows(unknowns);
    for (int r = 0; r < 3; ++r) rows.add(Numbers(static_cast<std::size_t>(unknowns)), std::array{2.0});
    const Solution s = rows.solve(1e-10);
    EXPECT_EQ(s.rank, 0);
    EXPECT_EQ(s.x, Numbers(s.x.size()));
    EXPECT_EQ(s.inverse, Numbers(s.inverse.size()));
    EXPECT_EQ(s.condition(), 0);
    EXPECT_NEAR(s.residual_norm, std::sqrt(12), 1e-14);
  }
}

TEST(LeastSquares, WithoutRowsDeterminesNothing) {
  const LeastSquares empty(3);
  const Solution solution = empty.solve();
  EXPECT_EQ(solution.x, Numbers(3));
  EXPECT_EQ(solution.singular_values, Numbers(3));
  EXPECT_EQ(solution.inverse, Numbers(9));
  EXPECT_EQ(solution.rank, 0);
  EXPECT_EQ(solution.rows, 0);
  EXPECT_EQ(solution.condition(), 0);
  EXPECT_EQ(solution.residual_norm, 0);
  EXPECT_EQ(solution.variance(), 0);
  EXPECT_EQ(solution.null_space.size(), 9u);
  EXPECT_FALSE(solution.estimable(Numbers{0, 0, 1}));
  EXPECT_TRUE(solution.estimable(Numbers{0, 0, 0}));  // 0ᵀx is 0 whatever x
  EXPECT_EQ(empty.residual_norm(Numbers{1, 2, 3}), 0);
  LeastSquares merged = empty;
  merged.merge(empty);
  merged.add({}, {});
  EXPECT_EQ(merged.state(), empty.state());
}

/// A problem of fewer independent columns than unknowns: its rows are combinations of `rank` random ones.
Problem any_deficient_problem(std::size_t& rank) {
  const auto unknowns = *rc::gen::inRange<std::size_t>(2, 31);
  rank = *rc::gen::inRange<std::size_t>(1, unknowns);
  Numbers basis = any_numbers(rank * unknowns);
  for (std::size_t j = 0; j < rank; ++j) basis[j * unknowns + j] += 4;
  const std::size_t count = *rc::gen::inRange(3 * rank, 40 + 3 * rank);
  Problem problem{unknowns, Numbers(count * unknowns), any_numbers(count), {}};
  for (std::size_t row = 0; row < count; ++row)
    for (std::size_t q = 0; q < rank; ++q) {
      const double factor = any_number() + (row % rank == q ? 2 : 0);
      for (std::size_t j = 0; j < unknowns; ++j) problem.rows[row * unknowns + j] += factor * basis[q * unknowns + j];
    }
  return problem;
}

// Penrose: with G = AᵀA and P = G⁺, G P G = G, P G P = P, and P G is symmetric. x = P Aᵀ b.
RC_GTEST_PROP(LeastSquares, OfAnyRankHasThePseudoInverseForACovariance, ()) {
  std::size_t rank = 0;
  const Problem problem = any_deficient_problem(rank);
  const std::size_t n = problem.unknowns;
  const Solution solution = accumulated(problem).solve();
  RC_ASSERT(solution.rank == static_cast<int>(rank));
  const Numbers g = normal_matrix(problem), &p = solution.inverse, pg = product(p, g, n);
  const double tolerance = rounding * std::pow(solution.condition(), 2);
  RC_ASSERT(largest_difference(product(g, pg, n), g) <= tolerance * largest(g));
  RC_ASSERT(largest_difference(product(pg, p, n), p) <= tolerance * largest(p));
  Numbers right(n), x(n);
  for (std::size_t row = 0; row < problem.count(); ++row)
    for (std::size_t j = 0; j < n; ++j) right[j] += problem.rows[row * n + j] * problem.values[row];
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      RC_ASSERT(std::abs(pg[i * n + j] - pg[j * n + i]) <= tolerance);
      x[i] += p[i * n + j] * right[j];
    }
  RC_ASSERT(largest_difference(solution.x, x) <= tolerance * std::max(1.0, largest(p) * largest(right)));
}

RC_GTEST_PROP(LeastSquares, OfFullRankHasTheInverseForACovariance, ()) {
  const Problem problem = any_determined_problem();
  const std::size_t n = problem.unknowns;
  const Solution solution = accumulated(problem).solve();
  Numbers unit(n * n);
  for (std::size_t j = 0; j < n; ++j) unit[j * n + j] = 1;
  RC_ASSERT(solution.rank == static_cast<int>(n));
  RC_ASSERT(largest_difference(product(solution.inverse, normal_matrix(problem), n), unit) <=
            rounding * std::pow(solution.condition(), 2));
}

RC_GTEST_PROP(LeastSquares, KnowsWhatItsRowsDoNotDetermine, ()) {
  std::size_t rank = 0;
  const Problem problem = any_deficient_problem(rank);
  const std::size_t n = problem.unknowns;
  const LeastSquares all = accumulated(problem);
  const Solution solution = all.solve();
  RC_ASSERT(solution.null_space.size() == (n - rank) * n);
  for (std::size_t a = 0; a < n - rank; ++a) {
    const auto start = solution.null_space.begin() + static_cast<std::ptrdiff_t>(a * n);
    const Numbers direction(start, start + static_cast<std::ptrdiff_t>(n));
    RC_ASSERT(std::abs(dot(direction, direction) - 1) <= rounding);
    RC_ASSERT(std::abs(dot(direction, solution.x)) <= rounding * std::max(1.0, largest(solution.x)));
    RC_ASSERT(!solution.estimable(direction));
    Numbers moved = solution.x;
    for (std::size_t j = 0; j < n; ++j) moved[j] += direction[j];
    RC_ASSERT(std::abs(all.residual_norm(moved) - solution.residual_norm) <=
              rounding * std::max(1.0, all.residual_norm(Numbers(n))));
    for (std::size_t b = 0; b < a; ++b)
      RC_ASSERT(std::abs(std::inner_product(direction.begin(), direction.end(),
                                            solution.null_space.begin() + static_cast<std::ptrdiff_t>(b * n), 0.0)) <=
                rounding);
  }
  // What a row measures is determined, and so is any sum of rows.
  const Numbers row(problem.rows.begin(), problem.rows.begin() + static_cast<std::ptrdiff_t>(n));
  RC_ASSERT(solution.estimable(row));
}

// Theory 4.7: 1e-8 of the length is the limit.
TEST(LeastSquares, CallsEstimableWhatIsOffByLessThanTheLimit) {
  LeastSquares first(2);
  first.add(Numbers{1, 0}, Numbers{1});
  const Solution solution = first.solve();
  EXPECT_TRUE(solution.estimable(Numbers{1, 0.9e-8}));
  EXPECT_TRUE(solution.estimable(Numbers{1e9, 9}));
  EXPECT_FALSE(solution.estimable(Numbers{1, 1.1e-8}));
  EXPECT_FALSE(solution.estimable(Numbers{nan_value, 0}));
}

TEST(LeastSquares, CountsSingularValuesAboveTheToleranceTimesTheLargest) {
  LeastSquares diagonal(3);
  diagonal.add(Numbers{0, 1, 0, 0, 0, 1e-4, 100, 0, 0}, Numbers{1, 1, 1});
  const Solution all = diagonal.solve();
  EXPECT_LE(largest_difference(all.singular_values, {100, 1, 1e-4}), rounding);
  EXPECT_EQ(all.rank, 3);
  EXPECT_NEAR(all.condition(), 1e6, 1e-6);
  const Solution two = diagonal.solve(1e-5);
  EXPECT_EQ(two.rank, 2);
  EXPECT_NEAR(two.condition(), 100, 1e-10);
  EXPECT_LE(largest_difference(two.x, {0.01, 1, 0}), rounding);
  EXPECT_NEAR(two.residual_norm, 1, rounding);  // the third row is given up
  EXPECT_EQ(diagonal.solve(0.5).rank, 1);
  EXPECT_EQ(diagonal.solve(0).rank, 3);
}

}  // namespace
}  // namespace mmbrdf
