// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/numerics/least_squares.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>
#include "given/cases.hpp"
#include "given/problems.hpp"

namespace mmbrdf {
namespace {

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

}  // namespace
}  // namespace mmbrdf
