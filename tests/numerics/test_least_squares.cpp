// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/numerics/least_squares.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "given/cases.hpp"

using namespace mmbrdf;

namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

// Of well-conditioned problems with numbers up to some ten and fewer than 100 rows.
constexpr double rounding = 1e-13;

using Numbers = std::vector<double>;

struct Problem {
  std::size_t unknowns = 1;
  Numbers rows, values, weights;  // as for add(); weights empty or one for each row
  std::size_t count() const { return values.size(); }
};

// inRange() alone would begin with numbers near −1 only.
double any_number() { return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(-1000000, 1000001)) * 1e-6; }

Numbers any_numbers(std::size_t count) {
  Numbers result(count);
  for (double& number : result) number = any_number();
  return result;
}

Problem any_problem(std::size_t unknowns, std::size_t count) {
  return {unknowns, any_numbers(unknowns * count), any_numbers(count), {}};
}

/// Random numbers plus a unit matrix on top: every column is independent of the others by a margin.
Problem any_determined_problem() {
  const auto unknowns = *rc::gen::inRange<std::size_t>(1, 31);  // the solver changes its method at 16
  Problem problem = any_problem(unknowns, *rc::gen::inRange(3 * unknowns, 6 * unknowns + 40));
  for (std::size_t j = 0; j < unknowns; ++j) problem.rows[j * unknowns + j] += 3;
  return problem;
}

LeastSquares accumulated(const Problem& problem) {
  LeastSquares result(static_cast<int>(problem.unknowns));
  result.add(problem.rows, problem.values, problem.weights);
  return result;
}

/// Rows of the problem, those named by `which` and in that order.
Problem chosen(const Problem& problem, const std::vector<std::size_t>& which) {
  Problem result{problem.unknowns, {}, {}, {}};
  for (const std::size_t row : which) {
    const auto first = problem.rows.begin() + static_cast<std::ptrdiff_t>(row * problem.unknowns);
    result.rows.insert(result.rows.end(), first, first + static_cast<std::ptrdiff_t>(problem.unknowns));
    result.values.push_back(problem.values[row]);
    if (!problem.weights.empty()) result.weights.push_back(problem.weights[row]);
  }
  return result;
}

std::vector<std::size_t> any_order(std::size_t count) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[*rc::gen::inRange<std::size_t>(0, i)]);
  return order;
}

double largest_difference(const Numbers& a, const Numbers& b) {
  if (a.size() != b.size()) return infinity;
  double result = 0;
  for (std::size_t i = 0; i < a.size(); ++i) result = std::max(result, std::abs(a[i] - b[i]));
  return result;
}

double largest(const Numbers& numbers) { return largest_difference(numbers, Numbers(numbers.size())); }

/// Whether two problems are one: the same x, covariance, rank, residual and number of rows.
bool agree(const Solution& a, const Solution& b, double tolerance) {
  return largest_difference(a.x, b.x) <= tolerance * std::max(1.0, largest(a.x)) &&
         largest_difference(a.inverse, b.inverse) <= tolerance * std::max(1.0, largest(a.inverse)) &&
         largest_difference(a.singular_values, b.singular_values) <= tolerance * a.singular_values[0] &&
         std::abs(a.residual_norm - b.residual_norm) <= tolerance * std::max(1.0, a.residual_norm) &&
         a.rank == b.rank && a.rows == b.rows;
}

/// a b for square matrices, row-major.
Numbers product(const Numbers& a, const Numbers& b, std::size_t n) {
  Numbers result(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t k = 0; k < n; ++k) result[i * n + j] += a[i * n + k] * b[k * n + j];
  return result;
}

Numbers normal_matrix(const Problem& problem) {  // AᵀA
  const std::size_t n = problem.unknowns;
  Numbers result(n * n);
  for (std::size_t row = 0; row < problem.count(); ++row)
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) result[i * n + j] += problem.rows[row * n + i] * problem.rows[row * n + j];
  return result;
}

double residual_norm(const Problem& problem, const Numbers& x) {
  double sum = 0;
  for (std::size_t row = 0; row < problem.count(); ++row) {
    double residual = -problem.values[row];
    for (std::size_t j = 0; j < problem.unknowns; ++j) residual += problem.rows[row * problem.unknowns + j] * x[j];
    sum += residual * residual;
  }
  return std::sqrt(sum);
}

double dot(const Numbers& a, const Numbers& b) { return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); }

}  // namespace

// ---- what it solves -------------------------------------------------------------------------------------------------

// A line through (0, 1), (1, 3), (2, 4), (3, 4) by hand: y = 1.5 + x, residuals −0.5, 0.5, 0.5, −0.5.
TEST(LeastSquares, FitsALineAsByHand) {
  LeastSquares line(2);
  line.add(Numbers{1, 0, 1, 1, 1, 2, 1, 3}, Numbers{1, 3, 4, 4});
  const Solution solution = line.solve();
  EXPECT_NEAR(solution.x[0], 1.5, rounding);
  EXPECT_NEAR(solution.x[1], 1, rounding);
  EXPECT_NEAR(solution.residual_norm, 1, rounding);
  EXPECT_EQ(solution.rows, 4);
  EXPECT_EQ(solution.rank, 2);
  EXPECT_EQ(solution.degrees_of_freedom(), 2);
  EXPECT_NEAR(solution.variance(), 0.5, rounding);
  // AᵀA = [4 6; 6 14], of determinant 20
  EXPECT_LE(largest_difference(solution.inverse, {0.7, -0.3, -0.3, 0.2}), rounding);
  EXPECT_TRUE(solution.null_space.empty());
}

RC_GTEST_PROP(LeastSquares, FindsTheUnknownsThatMadeTheValues, ()) {
  Problem problem = any_determined_problem();
  const Numbers x = any_numbers(problem.unknowns);
  for (std::size_t row = 0; row < problem.count(); ++row)
    problem.values[row] = std::inner_product(
        x.begin(), x.end(), problem.rows.begin() + static_cast<std::ptrdiff_t>(row * problem.unknowns), 0.0);
  const Solution solution = accumulated(problem).solve();
  RC_ASSERT(largest_difference(solution.x, x) <= rounding);
  RC_ASSERT(solution.residual_norm <= rounding);
}

// The minimum: no step in the direction of any unknown makes the residual smaller, Aᵀ(A x − b) = 0.
RC_GTEST_PROP(LeastSquares, LeavesAResidualThatIsOrthogonalToEveryColumn, ()) {
  const Problem problem = any_determined_problem();
  const std::size_t n = problem.unknowns;
  const Solution solution = accumulated(problem).solve();
  Numbers gradient(n);
  for (std::size_t row = 0; row < problem.count(); ++row) {
    double residual = -problem.values[row];
    for (std::size_t j = 0; j < n; ++j) residual += problem.rows[row * n + j] * solution.x[j];
    for (std::size_t j = 0; j < n; ++j) gradient[j] += problem.rows[row * n + j] * residual;
  }
  RC_ASSERT(largest(gradient) <= 10 * rounding);
}

RC_GTEST_PROP(LeastSquares, KnowsTheResidualNormOfItsSolutionAndOfAnyOtherX, ()) {
  const Problem problem = any_problem(*rc::gen::inRange<std::size_t>(1, 9), *rc::gen::inRange<std::size_t>(0, 30));
  const LeastSquares all = accumulated(problem);
  const Solution solution = all.solve();
  const Numbers x = any_numbers(problem.unknowns);
  RC_ASSERT(std::abs(all.residual_norm(x) - residual_norm(problem, x)) <= rounding);
  RC_ASSERT(std::abs(all.residual_norm(solution.x) - solution.residual_norm) <=
            rounding * std::max(1.0, largest(solution.x)));
}

// Läuchli: AᵀA is [1+ε² 1 1; …], which is the singular matrix of ones in double precision. The condition of A, 1.7e9,
// times 1.1e-16 is an error of 2e-7.
TEST(LeastSquares, GivesTheNormalEquationsOfItsRows) {
  LeastSquares all(2);
  all.add(Numbers{1, 2, 3, 5}, Numbers{1, -1}, Numbers{1, 4});
  const Numbers matrix = all.normal_matrix(), right = all.normal_vector();
  const Numbers expected_matrix{37, 62, 62, 104}, expected_right{-11, -18};  // Σ w x xᵀ and Σ w x y
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(matrix[i], expected_matrix[i], 1e-12);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(right[i], expected_right[i], 1e-12);
}

TEST(LeastSquares, SolvesALaeuchliMatrixWhoseNormalEquationsAreSingular) {
  const double eps = 1e-9;
  ASSERT_EQ(1 + eps * eps, 1);
  const Problem laeuchli{3, {1, 1, 1, eps, 0, 0, 0, eps, 0, 0, 0, eps}, {6, eps, 2 * eps, 3 * eps}, {}};
  std::vector<std::size_t> order{0, 1, 2, 3};
  do {
    const Solution solution = accumulated(chosen(laeuchli, order)).solve();
    EXPECT_EQ(solution.rank, 3);
    EXPECT_LE(largest_difference(solution.x, {1, 2, 3}), 1e-6);
    EXPECT_NEAR(solution.condition() * eps, std::sqrt(3.0), 1e-6);
  } while (std::next_permutation(order.begin(), order.end()));
}

// Numbers of every size: sums of squares must not overflow or vanish.
TEST(LeastSquares, SolvesProblemsOfAnyMagnitude) {
  for (const std::size_t n : {std::size_t{2}, std::size_t{20}})
    for (const double size : {1e-300, 1e-200, 1e-100, 1e100, 1e150, 1e200, 1e300}) {
      Problem problem{n, {}, {}, {}};
      for (std::size_t row = 0; row < 3 * n; ++row) {
        double sum = 0;
        for (std::size_t j = 0; j < n; ++j) {
          problem.rows.push_back(size * (std::cos(static_cast<double>(row * j)) + (row == j ? 3 : 0)));
          sum += problem.rows.back();
        }
        problem.values.push_back(sum);
      }
      const LeastSquares all = accumulated(problem);
      const Solution solution = all.solve();
      EXPECT_EQ(solution.rank, static_cast<int>(n)) << size;
      EXPECT_LE(largest_difference(solution.x, Numbers(n, 1.0)), rounding) << size;
      EXPECT_LE(solution.residual_norm / size, 10 * rounding) << size;
      EXPECT_NEAR(all.residual_norm(Numbers(n, 2.0)) / all.residual_norm(Numbers(n)), 1, rounding) << size;
    }
}

// ---- how the rows arrive --------------------------------------------------------------------------------------------

// Rows in another order, in blocks of any size, among any number of accumulators, which are saved, loaded and merged.
RC_GTEST_PROP(LeastSquares, DoesNotDependOnHowTheRowsArrive, ()) {
  const Problem problem = any_determined_problem();
  const Solution expected = accumulated(problem).solve();

  std::vector<LeastSquares> parts(*rc::gen::inRange<std::size_t>(1, 6),
                                  LeastSquares(static_cast<int>(problem.unknowns)));
  const Problem shuffled = chosen(problem, any_order(problem.count()));
  for (std::size_t row = 0; row < problem.count();) {
    std::vector<std::size_t> block;
    for (auto size = *rc::gen::inRange<std::size_t>(1, 12); size > 0 && row < problem.count(); --size)
      block.push_back(row++);
    const Problem next = chosen(shuffled, block);
    parts[*rc::gen::inRange<std::size_t>(0, parts.size())].add(next.rows, next.values);
  }
  LeastSquares merged(static_cast<int>(problem.unknowns));
  for (const std::size_t part : any_order(parts.size()))
    merged.merge(LeastSquares::from_state(merged.unknowns(), parts[part].state()));
  RC_ASSERT(agree(merged.solve(), expected, 1e-12));
}

TEST(LeastSquares, MergesWithItself) {
  const Problem problem{2, {1, 0, 1, 1, 1, 2}, {1, 3, 4}, {}};
  LeastSquares twice = accumulated(problem), doubled = accumulated(problem);
  doubled.merge(doubled);
  twice.add(problem.rows, problem.values);
  EXPECT_TRUE(agree(doubled.solve(), twice.solve(), rounding));
}

TEST(LeastSquares, HoldsTheSameNumbersHoweverManyRowsCame) {
  for (const int n : {1, 2, 7, 40}) {
    LeastSquares all(n);
    const Numbers row(static_cast<std::size_t>(n), 0.5), value{1};
    const auto size = static_cast<std::size_t>(n * (n + 1) / 2 + n + 2);
    EXPECT_EQ(all.state().size(), size);
    for (int q = 0; q < 3000; ++q) all.add(row, value);
    EXPECT_EQ(all.state().size(), size);
    EXPECT_EQ(all.rows(), 3000);
  }
}

RC_GTEST_PROP(LeastSquares, ComesBackFromItsStateBitForBit, ()) {
  const Problem problem = any_problem(*rc::gen::inRange<std::size_t>(1, 9), *rc::gen::inRange<std::size_t>(0, 30));
  const LeastSquares saved = accumulated(problem);
  const LeastSquares loaded = LeastSquares::from_state(saved.unknowns(), saved.state());
  RC_ASSERT(loaded.state() == saved.state());
  RC_ASSERT(loaded.rows() == saved.rows());
  RC_ASSERT(loaded.solve().x == saved.solve().x);
}

// A rotation of the rows changes AᵀA, Aᵀb and bᵀb by roundings only: these are kept over 200 000 rows.
TEST(LeastSquares, StaysAccurateOverManyRows) {
  LeastSquares line(2);
  Numbers rows, values;
  constexpr int count = 200000;
  for (int q = 0; q < count; ++q) {
    const double x = 2.0 * q / (count - 1) - 1, misfit = q % 2 == 0 ? 1 : -1;
    rows.insert(rows.end(), {1, x});
    values.push_back(3 - 2 * x + misfit);
  }
  line.add(rows, values);
  const Solution solution = line.solve();
  // The misfit has mean 0 and the slope −Σ(±x)/Σx² = 3/count in all.
  EXPECT_NEAR(solution.x[0], 3, 1e-11);
  EXPECT_NEAR(solution.x[1], -2 - 3.0 / count, 1e-9);
  EXPECT_NEAR(solution.variance(), 1, 1e-4);
  EXPECT_NEAR(solution.inverse[0] * count, 1, 1e-11);
}

// ---- weights --------------------------------------------------------------------------------------------------------

RC_GTEST_PROP(LeastSquares, CountsARowOfWeightThreeAsThreeRows, ()) {
  Problem weighted = any_determined_problem();
  std::vector<std::size_t> repeated;
  for (std::size_t row = 0; row < weighted.count(); ++row) {
    const int times = *rc::gen::inRange(row < weighted.unknowns ? 1 : 0, 5);
    weighted.weights.push_back(times);
    repeated.insert(repeated.end(), static_cast<std::size_t>(times), row);
  }
  Problem plain = weighted;
  plain.weights.clear();
  Solution expected = accumulated(chosen(plain, repeated)).solve();
  expected.rows = static_cast<long>(weighted.count());  // but for those of weight 0, each row is one
  expected.rows -= std::count(weighted.weights.begin(), weighted.weights.end(), 0.0);
  RC_ASSERT(agree(accumulated(weighted).solve(), expected, rounding));
}

// ---- rank -----------------------------------------------------------------------------------------------------------

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

// ---- polynomials of something the rows share ------------------------------------------------------------------------

RC_GTEST_PROP(LeastSquares, RepeatsItsUnknownsAsIfEachRowHadBeenRepeated, ()) {
  const Problem problem = any_problem(*rc::gen::inRange<std::size_t>(1, 6), *rc::gen::inRange<std::size_t>(0, 40));
  const Numbers factors = any_numbers(*rc::gen::inRange<std::size_t>(1, 4));
  const double value_factor = any_number();
  Problem expanded{problem.unknowns * factors.size(), {}, {}, {}};
  for (std::size_t row = 0; row < problem.count(); ++row) {
    for (const double factor : factors)
      for (std::size_t j = 0; j < problem.unknowns; ++j)
        expanded.rows.push_back(factor * problem.rows[row * problem.unknowns + j]);
    expanded.values.push_back(value_factor * problem.values[row]);
  }
  const LeastSquares found = accumulated(problem).repeated(factors, value_factor), expected = accumulated(expanded);
  RC_ASSERT(found.rows() == expected.rows());
  RC_ASSERT(found.unknowns() == expected.unknowns());
  // All there is in a problem is ‖A x − b‖ as a function of x.
  for (int q = 0; q < 5; ++q) {
    const Numbers x = any_numbers(expanded.unknowns);
    RC_ASSERT(std::abs(found.residual_norm(x) - expected.residual_norm(x)) <= rounding);
  }
}

RC_GTEST_PROP(LeastSquares, RestrictedToSomeUnknownsIsTheProblemOfTheirColumns, ()) {
  const Problem problem = any_determined_problem();
  std::vector<std::size_t> kept = any_order(problem.unknowns);
  kept.resize(*rc::gen::inRange<std::size_t>(1, problem.unknowns + 1));
  Problem columns{kept.size(), {}, problem.values, {}};
  for (std::size_t row = 0; row < problem.count(); ++row)
    for (const std::size_t unknown : kept) columns.rows.push_back(problem.rows[row * problem.unknowns + unknown]);
  RC_ASSERT(agree(accumulated(problem).restricted(kept).solve(), accumulated(columns).solve(), rounding));
}

TEST(LeastSquares, RefusesUnknownsThatThereAreNot) {
  const LeastSquares two(2);
  EXPECT_THROW(two.restricted({}), std::invalid_argument);
  EXPECT_EQ(message_of([&] { two.restricted(std::array<std::size_t, 1>{2}); }), "unknown number 2 is not there");
  EXPECT_EQ(message_of([&] { two.restricted(std::array<std::size_t, 2>{1, 1}); }), "unknown number 1 comes twice");
}

/// Columns of values of the problem, the first its own.
LeastSquares with_values(const Problem& problem, const std::vector<Numbers>& columns) {
  LeastSquares result(static_cast<int>(problem.unknowns), static_cast<int>(columns.size()));
  Numbers values;
  for (std::size_t row = 0; row < problem.count(); ++row)
    for (const Numbers& column : columns) values.push_back(column[row]);
  result.add(problem.rows, values);
  return result;
}

RC_GTEST_PROP(LeastSquares, HoldsColumnsOfValuesAsIfEachWereAlone, ()) {
  Problem problem = any_determined_problem();
  const std::vector<Numbers> columns{problem.values, any_numbers(problem.count()), any_numbers(problem.count())};
  const LeastSquares all = with_values(problem, columns);
  std::vector<LeastSquares> alone;
  for (std::size_t v = 0; v < columns.size(); ++v) {
    problem.values = columns[v];
    alone.push_back(accumulated(problem));
    RC_ASSERT(all.of(static_cast<int>(v)).state() == alone[v].state());
    RC_ASSERT(alone[v].has_rows_of(alone[0]));
  }
  const std::array<const LeastSquares*, 3> problems{&alone[0], &alone[1], &alone[2]};
  const LeastSquares together = LeastSquares::beside(problems, Numbers{1, 1, 1});
  for (int v = 0; v < 3; ++v) RC_ASSERT(together.of(v).state() == all.of(v).state());
  problem.rows[0] += 1;
  RC_ASSERT(!accumulated(problem).has_rows_of(alone[0]));
}

RC_GTEST_PROP(LeastSquares, OfSeveralProblemsDoesWhatItDoesOfEachToTheLastBit, ()) {
  Problem problem = any_determined_problem(), other = any_problem(problem.unknowns, problem.count());
  std::vector<LeastSquares> problems, others;
  for (int p = 0; p < 5; ++p) {  // the first three share their rows, and of the others the last four
    problem.values = any_numbers(problem.count());
    other.values = any_numbers(other.count());
    if (p >= 3) problem.rows[0] += 1;
    if (p == 1) other.rows[0] += 1;
    problems.push_back(accumulated(problem));
    others.push_back(accumulated(other));
  }
  std::vector<std::size_t> kept = any_order(problem.unknowns);
  kept.resize(*rc::gen::inRange<std::size_t>(1, problem.unknowns + 1));
  std::vector<const LeastSquares*> from, beside;
  std::vector<LeastSquares*> into;
  std::vector<LeastSquares> merged = problems;
  for (std::size_t p = 0; p < problems.size(); ++p) {
    from.push_back(&problems[p]);
    beside.push_back(&others[p]);
    into.push_back(&merged[p]);
  }
  const std::vector<LeastSquares> restricted = LeastSquares::restricted(from, kept);
  LeastSquares::merge(into, beside);
  for (std::size_t p = 0; p < problems.size(); ++p) {
    RC_ASSERT(restricted[p].state() == problems[p].restricted(kept).state());
    problems[p].merge(others[p]);
    RC_ASSERT(merged[p].state() == problems[p].state());
  }
}

RC_GTEST_PROP(LeastSquares, SolvesOverColumnsOfValuesAsOverRowsThatAreRepeatedForEach, ()) {
  Problem problem = any_determined_problem();
  const std::vector<Numbers> columns{problem.values, any_numbers(problem.count()), any_numbers(problem.count())};
  const Numbers factors{1, 0.5, 1, 1, 1, 2};  // 1 and λ
  const long rows = 3 * static_cast<long>(problem.count());
  LeastSquares repeated(2 * static_cast<int>(problem.unknowns));
  for (std::size_t v = 0; v < 3; ++v) {
    problem.values = columns[v];
    repeated.merge_repeated(accumulated(problem), std::span(factors).subspan(2 * v, 2));
  }
  const Solution found = with_values(problem, columns).solve_over(factors, rows, 1e-10);
  RC_ASSERT(agree(found, repeated.solve(), 100 * rounding));
}

// Two groups of rows with λ = 1 and 2, coefficients linear in λ: together they are of full rank, alone they are not.
RC_GTEST_PROP(LeastSquares, FitsCoefficientsThatAreLinearInAWavelength, ()) {
  const Problem first = any_determined_problem();
  Problem second = any_problem(first.unknowns, first.count());
  for (std::size_t j = 0; j < first.unknowns; ++j) second.rows[j * first.unknowns + j] += 3;
  LeastSquares both = accumulated(first).repeated(Numbers{1, 1});
  RC_ASSERT(both.solve().rank == static_cast<int>(first.unknowns));
  both.merge(accumulated(second).repeated(Numbers{1, 2}));
  const Solution solution = both.solve(), at_1 = accumulated(first).solve(), at_2 = accumulated(second).solve();
  RC_ASSERT(solution.rank == static_cast<int>(2 * first.unknowns));
  for (std::size_t j = 0; j < first.unknowns; ++j) {
    RC_ASSERT(std::abs(solution.x[j] + solution.x[j + first.unknowns] - at_1.x[j]) <= 10 * rounding);
    RC_ASSERT(std::abs(solution.x[j] + 2 * solution.x[j + first.unknowns] - at_2.x[j]) <= 10 * rounding);
  }
}

// ---- bad input ------------------------------------------------------------------------------------------------------

TEST(LeastSquares, RefusesBadRowsAndStaysAsItWas) {
  LeastSquares some(2);
  some.add(Numbers{1, 2, 3, 4}, Numbers{5, 6});
  const Numbers before = some.state();
  const Numbers two{1, 1}, one{1}, negative{-1e-9}, none;
  const auto add = [&](const Numbers& rows, const Numbers& values, const Numbers& weights) {
    const std::string message = message_of([&] { some.add(rows, values, weights); });
    EXPECT_EQ(some.state(), before) << message;
    return message;
  };
  EXPECT_EQ(add({1, 2, 3}, one, none), "3 numbers in 1 rows of 2 unknowns");
  EXPECT_EQ(add(two, {}, none), "2 numbers in 0 rows of 2 unknowns");
  EXPECT_EQ(add(two, one, two), "2 weights for 1 rows");
  EXPECT_EQ(add({1, nan_value}, one, none), "row number 2 is not finite");
  EXPECT_EQ(add({infinity, 1}, one, none), "row number 1 is not finite");
  EXPECT_EQ(add(two, {nan_value}, none), "value number 1 is not finite");
  EXPECT_EQ(add(two, one, {nan_value}), "weight number 1 is not finite");
  EXPECT_EQ(add(two, one, {infinity}), "weight number 1 is not finite");
  EXPECT_EQ(add(two, one, negative), "weight -1e-09 is negative");
  // the last of many rows: nothing of those before it has been taken in
  Numbers rows(2000, 1.0);
  rows.back() = nan_value;
  EXPECT_EQ(add(rows, Numbers(1000, 1.0), none), "row number 2000 is not finite");
  EXPECT_EQ(message_of([&] { some.merge(LeastSquares(3)); }), "cannot merge 3 unknowns into 2");
  EXPECT_EQ(some.state(), before);
}

TEST(LeastSquares, RefusesImpossibleSizes) {
  EXPECT_EQ(message_of([] { LeastSquares(0); }), "unknowns = 0, must be in 1...2048");
  EXPECT_EQ(message_of([] { LeastSquares(-3); }), "unknowns = -3, must be in 1...2048");
  EXPECT_THROW(LeastSquares(LeastSquares::max_unknowns + 1), std::invalid_argument);
  LeastSquares two(2);
  EXPECT_THROW(two.residual_norm(Numbers{1}), std::invalid_argument);
  EXPECT_THROW(two.residual_norm(Numbers{1, 2, 3}), std::invalid_argument);
  EXPECT_THROW(two.solve().estimable(Numbers{1}), std::invalid_argument);
  for (const double tolerance : {-1e-3, 1.0, infinity, nan_value})
    EXPECT_THROW(two.solve(tolerance), std::invalid_argument) << tolerance;
}

TEST(LeastSquares, RefusesProblemsThatDoNotFitEachOther) {
  LeastSquares two(2), other(2), pair(2, 2);
  two.add(Numbers{1, 0, 0, 1}, Numbers{1, 2});
  other.add(Numbers{1, 0, 0, 2}, Numbers{1, 2});
  const std::array<const LeastSquares*, 2> problems{&two, &other};
  EXPECT_THROW(LeastSquares::beside(problems, Numbers{1, 1}), std::invalid_argument);
  EXPECT_THROW(LeastSquares::beside(problems, Numbers{1}), std::invalid_argument);
  EXPECT_THROW(LeastSquares::beside({}, {}), std::invalid_argument);
  EXPECT_THROW(pair.of(2), std::invalid_argument);
  EXPECT_THROW(pair.of(-1), std::invalid_argument);
  EXPECT_THROW(pair.merge(two), std::invalid_argument);
  EXPECT_THROW(pair.state(), std::invalid_argument);
  const std::array<const LeastSquares*, 2> different{&two, &pair};
  const std::array<LeastSquares*, 1> one{&two};
  EXPECT_THROW(LeastSquares::restricted(different, std::array<std::size_t, 1>{0}), std::invalid_argument);
  EXPECT_THROW(LeastSquares::merge(one, problems), std::invalid_argument);
  EXPECT_THROW(pair.solve(), std::invalid_argument);
  EXPECT_THROW(pair.solve_over(Numbers{1, 1, 1}, 2, 1e-10), std::invalid_argument);
  EXPECT_THROW(two.merge_repeated(other, Numbers{1, 1}), std::invalid_argument);
  EXPECT_THROW(LeastSquares(2, 0), std::invalid_argument);
}

TEST(LeastSquares, RefusesImpossibleRepetitions) {
  const LeastSquares two(2);
  EXPECT_THROW(two.repeated({}), std::invalid_argument);
  EXPECT_THROW(two.repeated(Numbers{1, nan_value}), std::invalid_argument);
  EXPECT_THROW(two.repeated(Numbers{1, infinity}), std::invalid_argument);
  EXPECT_THROW(two.repeated(Numbers{1}, nan_value), std::invalid_argument);
  EXPECT_THROW(two.repeated(Numbers(5000, 1.0)), std::invalid_argument);
  EXPECT_THROW(two.repeated(Numbers(10000, 1.0)), std::invalid_argument);
}

TEST(LeastSquares, RefusesNumbersThatAreNoState) {
  const Numbers state{1, 2, 3, 4, 5, 6, 7};  // 2 unknowns: 3 + 2 + 1 numbers of the triangle, then 7 rows
  EXPECT_EQ(LeastSquares::from_state(2, state).rows(), 7);
  const auto refused = [&](std::size_t place, double number) {
    Numbers changed = state;
    changed[place] = number;
    return message_of([&] { LeastSquares::from_state(2, changed); });
  };
  EXPECT_EQ(refused(3, nan_value), "state number 4 is not finite");
  EXPECT_EQ(refused(6, -1), "a state with -1 rows");
  EXPECT_EQ(refused(6, 2.5), "a state with 2.5 rows");
  EXPECT_NE(refused(6, 1e300), "nothing was thrown");
  EXPECT_EQ(message_of([&] { LeastSquares::from_state(3, state); }), "a state of 7 numbers for 3 unknowns");
  EXPECT_EQ(message_of([&] { LeastSquares::from_state(2, {}); }), "a state of 0 numbers for 2 unknowns");
  EXPECT_THROW(LeastSquares::from_state(0, state), std::invalid_argument);
}
