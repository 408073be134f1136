// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/numerics/least_squares.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>
#include "given/cases.hpp"
#include "given/problems.hpp"

namespace mmbrdf {
namespace {

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

}  // namespace
}  // namespace mmbrdf
