// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarization/mueller.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <stdexcept>

using namespace mmbrdf;

namespace {

constexpr double pi = std::numbers::pi;

// Sums of four products of numbers up to 1 are rounded a few times, each by at most 1.1e-16.
constexpr double rounding = 2e-15;

double largest(const Mueller& m) {
  double result = 0;
  for (double element : m.elements) result = std::max(result, std::abs(element));
  return result;
}

double any_number() { return *rc::gen::inRange(-1000000, 1000001) * 1e-6; }

Mueller any_matrix() {
  Mueller m;
  for (double& element : m.elements) element = any_number();
  return m;
}

/// docs/conventions.md: the Stokes vector of a field with the complex amplitudes (E1, E2).
Stokes of_field(std::complex<double> e1, std::complex<double> e2) {
  const std::complex<double> product = std::conj(e1) * e2;
  return {std::norm(e1) + std::norm(e2), std::norm(e1) - std::norm(e2), 2 * product.real(), 2 * product.imag()};
}

const auto every_convention = {StokesConvention::germer2017,
                               StokesConvention::s_first_right,
                               StokesConvention::p_first_left,
                               StokesConvention::p_first_right,
                               StokesConvention::p_first_left_handed_axes_left,
                               StokesConvention::p_first_left_handed_axes_right};

}  // namespace

TEST(Mueller, IsStoredRowByRow) {
  Mueller m;
  m(1, 2) = 7;
  EXPECT_EQ(m.elements[6], 7);
  EXPECT_EQ(element_name(6), "23");
}

TEST(Mueller, MatrixTimesMatrixIsOneAfterTheOther) {
  Mueller polarizer;  // passes e1
  for (int i : {0, 1})
    for (int j : {0, 1}) polarizer(i, j) = 0.5;
  const Mueller swapped = diagonal(1, -1, 1, -1);
  EXPECT_EQ((swapped * polarizer) * (Stokes{1, 0, 0, 0}), (Stokes{0.5, -0.5, 0, 0}));
  EXPECT_EQ((polarizer * swapped) * (Stokes{1, 1, 0, 0}), (Stokes{0, 0, 0, 0}));
}

RC_GTEST_PROP(Mueller, ProductAppliesTheRightFactorFirst, ()) {
  const Mueller a = any_matrix(), b = any_matrix();
  const Stokes s{any_number(), any_number(), any_number(), any_number()};
  const Stokes once = (a * b) * s, twice = a * (b * s);
  for (std::size_t i = 0; i < 4; ++i) RC_ASSERT(std::abs(once[i] - twice[i]) < 16 * rounding);
}

RC_GTEST_PROP(Mueller, TransposeReversesProducts, ()) {
  const Mueller a = any_matrix(), b = any_matrix();
  RC_ASSERT(largest(transpose(a * b) - transpose(b) * transpose(a)) < rounding);
}

TEST(Mueller, AddsSubtractsAndScalesEachElement) {
  const Mueller a = diagonal(1, 2, 3, 4), b = diagonal(4, 3, 2, 1);
  EXPECT_EQ(a + b, 5 * identity());
  EXPECT_EQ(2 * a - a, a);
}

TEST(Mueller, NormalizedHasElement11EqualToOne) {
  EXPECT_EQ(normalized(diagonal(4, 2, 1, -1)), diagonal(1, 0.5, 0.25, -0.25));
}

TEST(Mueller, WithoutIntensityCannotBeNormalized) {
  EXPECT_THROW(normalized(diagonal(0, 1, 1, 1)), std::invalid_argument);
  EXPECT_THROW(normalized(diagonal(1e-300, 1e9, 1, 1)), std::invalid_argument);
  EXPECT_THROW(normalized(diagonal(std::numeric_limits<double>::quiet_NaN(), 1, 1, 1)), std::invalid_argument);
  EXPECT_THROW(normalized(diagonal(std::numeric_limits<double>::infinity(), 1, 1, 1)), std::invalid_argument);
}

TEST(Mueller, TurningTheAxesBy45DegreesMakesLightAlongTheFirstAxisMinusDiagonal) {
  const Stokes s = rotator(pi / 4) * Stokes{1, 1, 0, 0};
  EXPECT_NEAR(s[1], 0, rounding);
  EXPECT_NEAR(s[2], -1, rounding);
}

TEST(Mueller, TurningTheAxesBy90DegreesChangesTheSignsOfTheLinearComponents) {
  EXPECT_LT(largest(rotator(pi / 2) - diagonal(1, -1, -1, 1)), rounding);
}

RC_GTEST_PROP(Mueller, RotatorDescribesTheSameFieldInTurnedAxes, ()) {
  const std::complex<double> e1{any_number(), any_number()}, e2{any_number(), any_number()};
  const double a = 7 * any_number();
  const Stokes expected = of_field(std::cos(a) * e1 + std::sin(a) * e2, -std::sin(a) * e1 + std::cos(a) * e2);
  const Stokes s = rotator(a) * of_field(e1, e2);
  for (std::size_t i = 0; i < 4; ++i) RC_ASSERT(std::abs(s[i] - expected[i]) < 4 * rounding);  // |S| ≤ 4
}

RC_GTEST_PROP(Mueller, RotatorsAddTheirAnglesAndTransposeToTheInverse, ()) {
  const double a = 7 * any_number(), b = 7 * any_number();
  RC_ASSERT(largest(rotator(a) * rotator(b) - rotator(a + b)) < 2 * rounding);  // 2 (a + b) ≤ 28 is rounded by 1.8e-15
  RC_ASSERT(rotator(-a) == transpose(rotator(a)));
  RC_ASSERT(rotator(std::cos(2 * a), std::sin(2 * a)) == rotator(a));
}

TEST(Mueller, FieldThatTurnsFromTheFirstToTheSecondAxisIsLeftHanded) {
  // exp(−iωt) (1, i) is (cos ωt, sin ωt): counter-clockwise for an observer who faces the source, as e1 × e2 = k.
  EXPECT_EQ(of_field(1, {0, 1}), (Stokes{2, 0, 0, 2}));
  EXPECT_EQ(of_field(1, {0, -1}), (Stokes{2, 0, 0, -2}));
}

TEST(Mueller, ExchangingSourceAndDetectorTransposesAndChangesTheSignsOf13And23And34) {
  const Mueller m{{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16}};
  EXPECT_EQ(exchanged(m), (Mueller{{1, 5, -9, 13, 2, 6, -10, 14, -3, -7, 11, -15, 4, 8, -12, 16}}));
}

TEST(Mueller, MirroringChangesTheSignsOfTheOffDiagonalBlocks) {
  const Mueller m{{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16}};
  EXPECT_EQ(mirrored(m), (Mueller{{1, 2, -3, -4, 5, 6, -7, -8, -9, -10, 11, 12, -13, -14, 15, 16}}));
}

RC_GTEST_PROP(Mueller, ExchangeAndMirrorAreTheirOwnInversesAndRespectProducts, ()) {
  const Mueller a = any_matrix(), b = any_matrix();
  RC_ASSERT(exchanged(exchanged(a)) == a);
  RC_ASSERT(mirrored(mirrored(a)) == a);
  RC_ASSERT(largest(exchanged(a * b) - exchanged(b) * exchanged(a)) < rounding);
  RC_ASSERT(mirrored(a * b) == mirrored(a) * mirrored(b));
}

RC_GTEST_PROP(Mueller, TheMirrorImageOfARotationTurnsTheOtherWay, ()) {
  const double a = any_number();
  RC_ASSERT(mirrored(rotator(a)) == rotator(-a));
  RC_ASSERT(exchanged(rotator(a)) == rotator(a));
}

TEST(StokesConvention, LightAlongTheFirstAxisIsPlusOneWhereSComesFirst) {
  const Stokes s_polarized{1, 1, 0, 0};
  using enum StokesConvention;
  EXPECT_EQ(convert(s_polarized, germer2017, s_first_right), s_polarized);
  for (StokesConvention p_first :
       {p_first_left, p_first_right, p_first_left_handed_axes_left, p_first_left_handed_axes_right})
    EXPECT_EQ(convert(s_polarized, germer2017, p_first), (Stokes{1, -1, 0, 0}));
}

TEST(StokesConvention, LeftHandedLightIsPlusOneWhereS4IsLeftMinusRight) {
  const Stokes left{1, 0, 0, 1}, right{1, 0, 0, -1};
  using enum StokesConvention;
  EXPECT_EQ(convert(left, germer2017, p_first_left), left);
  EXPECT_EQ(convert(left, germer2017, p_first_left_handed_axes_left), left);
  EXPECT_EQ(convert(right, germer2017, s_first_right), left);  // Hecht, Mitsuba: right-handed light has S4 = +1
  EXPECT_EQ(convert(right, germer2017, p_first_right), left);
  EXPECT_EQ(convert(right, germer2017, p_first_left_handed_axes_right), left);
}

TEST(StokesConvention, LightBetweenSAndPIsMinusOneInTheAxesPAndMinusS) {
  const Stokes from_s_towards_p{1, 0, 1, 0};
  using enum StokesConvention;
  EXPECT_EQ(convert(from_s_towards_p, germer2017, s_first_right), from_s_towards_p);
  EXPECT_EQ(convert(from_s_towards_p, germer2017, p_first_left), (Stokes{1, 0, -1, 0}));
  EXPECT_EQ(convert(from_s_towards_p, germer2017, p_first_right), (Stokes{1, 0, -1, 0}));
  EXPECT_EQ(convert(from_s_towards_p, germer2017, p_first_left_handed_axes_left), from_s_towards_p);
  EXPECT_EQ(convert(from_s_towards_p, germer2017, p_first_left_handed_axes_right), from_s_towards_p);
}

TEST(StokesConvention, AxesPAndMinusSAreSAndPTurnedBy90Degrees) {
  const Stokes s{1, 0.2, 0.3, 0.4};
  const Stokes converted = convert(s, StokesConvention::germer2017, StokesConvention::p_first_left);
  const Stokes rotated = rotator(pi / 2) * s;
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(converted[i], rotated[i], rounding);
}

TEST(StokesConvention, OppositeSignOfS4ChangesElements14And24And34AndTheirTransposes) {
  const Mueller m{{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16}};
  EXPECT_EQ(convert(m, StokesConvention::germer2017, StokesConvention::s_first_right),
            (Mueller{{1, 2, 3, -4, 5, 6, 7, -8, 9, 10, 11, -12, -13, -14, -15, 16}}));
}

RC_GTEST_PROP(StokesConvention, MatrixAndStokesVectorAreConvertedAlike, ()) {
  const Mueller m = any_matrix();
  const Stokes s{any_number(), any_number(), any_number(), any_number()};
  for (StokesConvention from : every_convention)
    for (StokesConvention to : every_convention) {
      RC_ASSERT(convert(m, from, to) * convert(s, from, to) == convert(m * s, from, to));
      RC_ASSERT(convert(convert(m, from, to), to, from) == m);
      RC_ASSERT((from != to || convert(m, from, to) == m));
    }
}

TEST(StokesConvention, ThatDoesNotExistIsRefused) {
  EXPECT_THROW(convert(identity(), static_cast<StokesConvention>(6), StokesConvention::germer2017),
               std::invalid_argument);
}
