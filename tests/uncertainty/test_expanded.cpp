// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/uncertainty/expanded.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "given/cases.hpp"
#include "given/least_squares.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/polarization/gradients.hpp"

namespace mmbrdf {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

// GUM 2008, table G.2, fraction 95 %, and Abramowitz and Stegun, table 26.10 for the third digit.
TEST(ExpandedUncertainty, HasTheCoverageFactorsOfStudentsDistribution) {
  for (const auto& [freedom, k] : {std::pair(1.0, 12.706),
                                   {2.0, 4.303},
                                   {3.0, 3.182},
                                   {4.0, 2.776},
                                   {5.0, 2.571},
                                   {10.0, 2.228},
                                   {20.0, 2.086},
                                   {50.0, 2.009},
                                   {100.0, 1.984},
                                   {1e5, 1.960}})
    EXPECT_NEAR(coverage_factor(freedom), k, 6e-4) << freedom;
  EXPECT_NEAR(coverage_factor(1), std::tan(0.475 * std::acos(-1.0)), 1e-8);  // Cauchy's distribution
  EXPECT_NEAR(coverage_factor(999999), coverage_factor(1000001), 1e-5);
  EXPECT_EQ(coverage_factor(infinite), 2);
}

// Abramowitz and Stegun 26.7.5 to ν⁻², of which the next term is 2.5 ν⁻³.
TEST(ExpandedUncertainty, HasTheCoverageFactorsOfManyDegreesOfFreedomToo) {
  const double x = 1.959963984540054, x3 = x * x * x, x5 = x3 * x * x;
  for (const double freedom : {101., 150., 400., 3e3, 1e5, 9e5}) {
    const double k = x + (x3 + x) / (4 * freedom) + (5 * x5 + 16 * x3 + 3 * x) / (96 * freedom * freedom);
    EXPECT_NEAR(coverage_factor(freedom), k, 3 / std::pow(freedom, 3) + 2e-9) << freedom;  // of the bisection
  }
}

// GUM 2008, G.4.1, note 3: gauge block, H.1.6.
TEST(ExpandedUncertainty, HasTheEffectiveDegreesOfFreedomOfTheGaugeBlock) {
  const ExpandedUncertainty u =
      expanded({{"standard", 25, 18}, {"difference", 9.7, 25.6}, {"expansion", 2.9, 50}, {"temperature", 16.6, 2}});
  EXPECT_NEAR(u.uncertainty, 31.7, 0.1);
  EXPECT_EQ(std::floor(u.freedom), 16);
  EXPECT_NEAR(u.expanded, u.coverage_factor * u.uncertainty, 1e-12);
}

TEST(ExpandedUncertainty, OfOneCauseHasItsDegreesOfFreedom) {
  EXPECT_NEAR(expanded({{"fit", 0.3, 17}, {"scale", 0, 3}}).freedom, 17, 1e-12);
  EXPECT_EQ(expanded({{"scale", 0.3}}).freedom, infinite);
  EXPECT_EQ(expanded({{"scale", 0.3}}).expanded, 0.6);
  EXPECT_EQ(expanded({}).expanded, 0);
}

TEST(ExpandedUncertainty, OfABudgetHasItsTerms) {
  const Model model = least_squares("ptfe-532");
  const std::vector<TypeBTerm> terms{{"plaque", ErrorOf::scale, 0.003, 8}, {"arm", ErrorOf::theta_r, 0.001}};
  const PreparedModel prepared = prepare(model, 0.532);
  const Budget all = budget(prepared, prepare_uncertainty(model, 0.532), terms, Geometry{{0.7, 0}, {0.4, 1}});
  Mueller f11;
  f11(0, 0) = 1;
  const std::vector<Contribution> parts = contributions(all, f11);
  ASSERT_EQ(parts.size(), 3U);
  EXPECT_EQ(parts[1].name, "plaque");
  EXPECT_EQ(parts[1].freedom, 8);
  EXPECT_NEAR(parts[1].uncertainty, 0.003 * prepared.f11({{0.7, 0}, {0.4, 1}}), 1e-12);
  EXPECT_NEAR(standard_uncertainty(parts), standard_uncertainty(f11, all.total), 1e-15);
}

TEST(ExpandedUncertainty, RefusesWhatMakesNoSense) {
  EXPECT_EQ(message_of([] { expanded({{"arm", -1}}); }), "uncertainty -1 of arm, must be 0 or more and finite");
  EXPECT_EQ(message_of([] { expanded({{"arm", INFINITY}}); }), "uncertainty inf of arm, must be 0 or more and finite");
  EXPECT_EQ(message_of([] { expanded({{"arm", NAN}}); }), "uncertainty nan of arm, must be 0 or more and finite");
  EXPECT_EQ(message_of([] { expanded({{"arm", 1, 0.5}}); }), "0.5 degrees of freedom of arm: must be 1 or more");
  EXPECT_THROW(coverage_factor(0), std::invalid_argument);
}

}  // namespace
}  // namespace mmbrdf
