// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/quantities/quantities.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "given/cases.hpp"
#include "given/random_mueller.hpp"

namespace mmbrdf {
namespace {

TEST(Quantities, HaveNamesOfTheirOwnAndAreFoundByThem) {
  std::set<std::string_view> names;
  for (const Quantity& q : quantities()) {
    EXPECT_TRUE(names.insert(q.name).second) << q.name;
    EXPECT_EQ(&quantity(q.name), &q);
    EXPECT_FALSE(q.meaning.empty()) << q.name;
  }
  EXPECT_EQ(message_of([] { quantity("albedo"); }), "quantity 'albedo' is not known");
}

TEST(Quantities, ThatTakeLightComeLast) {
  const auto all = quantities(), of_matrices = quantities(false);
  EXPECT_EQ(of_matrices.data(), all.data());
  for (const Quantity& q : all) EXPECT_EQ(q.takes_light, &q >= &*of_matrices.end()) << q.name;
}

// Their slopes are tested by Sensitivity.IsTheSlopeOfTheQuantity.
RC_GTEST_PROP(Quantities, WithoutLightDoNotDependOnIt, ()) {
  RandomMueller random(*rc::gen::arbitrary<std::uint64_t>());
  const Mueller m = random.pure(0) + random.pure(0);
  for (const Quantity& q : quantities(false)) {
    RC_ASSERT(q.value(m, {1, 1, 0, 0}) == q.value(m, {2, 0, 0, -1}));
    RC_ASSERT(q.gradient(m, {1, 1, 0, 0}) == q.gradient(m, {2, 0, 0, -1}));
  }
}

// (1 − 0.6) / (1 + 0.6). Nothing is co-polarized behind what turns s into p.
TEST(Quantities, HaveTheDepolarizationRatioOfTheTextbook) {
  const Quantity& ratio = quantity("depolarization_ratio");
  EXPECT_NEAR(ratio.value(diagonal(1, 0.6, -0.6, -0.4), {}), 0.25, 1e-15);
  EXPECT_EQ(ratio.value(diagonal(1, 0, 0, 0), {}), 1);
  EXPECT_EQ(ratio.value(identity(), {}), 0);
  EXPECT_EQ(message_of([&] { ratio.value(diagonal(1, -1, -1, 1), {}); }), "f_ss + f_pp = 0, must be positive");
  EXPECT_THROW(ratio.value(diagonal(-1, 2, 0, 0), {}), std::invalid_argument);
}

// What light of opposite polarizations leaves nearly nothing of: the ratio is beyond the largest double, and so was half
// of its gradient.
TEST(Quantities, HaveAFiniteDepolarizationRatioOfTheLargestMatricesThereAre) {
  constexpr double largest = std::numeric_limits<double>::max();
  const Quantity& ratio = quantity("depolarization_ratio");
  EXPECT_EQ(ratio.value(diagonal(largest, 0, 0, 0), {}), 1);
  const Mueller nearly = diagonal(largest, -std::nextafter(largest, 0), 0, 0);
  EXPECT_TRUE(std::isfinite(ratio.value(nearly, {})));
  for (const double slope : ratio.gradient(nearly, {}).elements) EXPECT_TRUE(std::isfinite(slope));
}

// The half of unpolarized light that a polarizer along s lets through is s-polarized: (1, 1, 0, 0) / 2.
TEST(Quantities, OfTheScatteredLightAreItsStokesVector) {
  Mueller polarizer;
  for (const auto& [row, column] : {std::pair(0, 0), {0, 1}, {1, 0}, {1, 1}}) polarizer(row, column) = 0.5;
  const Stokes unpolarized{3, 0, 0, 0};
  EXPECT_EQ(quantity("scattered_S1").value(polarizer, unpolarized), 1.5);
  EXPECT_EQ(quantity("scattered_S2").value(polarizer, unpolarized), 1.5);
  EXPECT_EQ(quantity("scattered_S3").value(polarizer, unpolarized), 0);
  EXPECT_EQ(quantity("scattered_S4").value(polarizer, unpolarized), 0);
  for (const char* name : {"scattered_S1", "scattered_S4"})
    for (const Stokes& light : {Stokes{1, 1, 1, 0}, Stokes{0, 0, 0, 0}})
      EXPECT_NE(message_of([&] { quantity(name).gradient(polarizer, light); }), "nothing was thrown");
}

TEST(Quantities, HaveTheAngleOfLinearPolarizationFromSTowardsP) {
  const Quantity& angle = quantity("orientation_deg");
  EXPECT_THROW(angle.value(diagonal(-1, -1, -1, -1), {1, 0, 1, 0}), std::invalid_argument);
  EXPECT_EQ(angle.value(identity(), {1, 1, 0, 0}), 0);
  EXPECT_EQ(angle.value(identity(), {2, 0, 1, 1}), 45);
  EXPECT_EQ(angle.value(identity(), {1, 0, -1, 0}), -45);
  for (const double rounding : {0.0, 1e-16, -1e-16}) EXPECT_EQ(angle.value(identity(), {1, -1, rounding, 0}), 90);
  for (const Stokes& light : {Stokes{1, 0, 0, 1}, Stokes{1, 1e-16, -1e-16, 0}})
    EXPECT_EQ(message_of([&] { angle.gradient(identity(), light); }), "the scattered light has no linear polarization");
}

}  // namespace
}  // namespace mmbrdf
