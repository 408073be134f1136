// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarization/analysis.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "given/published.hpp"
#include "given/random_mueller.hpp"
#include "mmbrdf/files/samples_file.hpp"

using namespace mmbrdf;

namespace {

// Numbers of matrices with M11 = 1 that come from a few hundred rounded operations.
constexpr double rounding = 2e-14;

const Mueller perfect_depolarizer = diagonal(1, 0, 0, 0);
const Mueller quarter_wave_plate = mueller_of({1, 0, 0, {0, 1}});

/// A polarizer that passes light along e1.
Mueller polarizer() {
  Mueller m;
  for (const int i : {0, 1})
    for (const int j : {0, 1}) m(i, j) = 0.5;
  return m;
}

RandomMueller any_source() { return RandomMueller(*rc::gen::arbitrary<std::uint64_t>()); }

/// With M11 = 1.
Mueller any_realizable() { return normalized(any_source().realizable()); }

Mueller sum(const CloudeDecomposition& parts) {
  Mueller m;
  for (std::size_t q = 0; q < 4; ++q) m = m + parts.weights[q] * parts.components[q];
  return m;
}

double frobenius(const Mueller& m) {
  double squares = 0;
  for (const double element : m.elements) squares += element * element;
  return std::sqrt(squares);
}

/// What must not depend on the axes: depolarization, purity, entropy, diattenuation, polarizance, eigenvalues.
std::array<double, 9> invariants(const Mueller& m) {
  const std::array<double, 4> l = coherency_eigenvalues(m);
  return {depolarization(m), purity(m), entropy(m), diattenuation(m), polarizance(m), l[0], l[1], l[2], l[3]};
}

void expect_same_invariants(const Mueller& a, const Mueller& b) {
  const auto x = invariants(a), y = invariants(b);
  // The entropy of rounding, −ε log₄ ε for each eigenvalue, is 25 ε.
  for (std::size_t i = 0; i < x.size(); ++i) RC_ASSERT(std::abs(x[i] - y[i]) < (i == 2 ? 1e-12 : rounding));
}

}  // namespace

TEST(Depolarization, IsZeroForAPerfectDepolarizerAndOneForPolarizerAndRetarder) {
  EXPECT_EQ(depolarization(0.3 * perfect_depolarizer), 0);
  EXPECT_NEAR(depolarization(polarizer()), 1, 1e-15);
  EXPECT_NEAR(depolarization(quarter_wave_plate), 1, 1e-15);
  EXPECT_NEAR(depolarization(diagonal(2, 1, 1, 1)), 0.5, 1e-15);  // Eq. 21 corrected: √3 / (√3 · 2)
}

TEST(Diattenuation, OfAPolarizerIsOneAlongItsAxisAndOfARetarderZero) {
  EXPECT_EQ(diattenuation_vector(polarizer()), (std::array<double, 3>{1, 0, 0}));
  EXPECT_NEAR(diattenuation(quarter_wave_plate), 0, 1e-15);
  Mueller m = diagonal(2, 0, 0, 0);
  m(0, 2) = 1;   // more of incident light between e1 and e2 is scattered,
  m(3, 0) = -1;  // and it is right-handed then
  EXPECT_EQ(diattenuation_vector(m), (std::array<double, 3>{0, 0.5, 0}));
  EXPECT_EQ(polarizance_vector(m), (std::array<double, 3>{0, 0, -0.5}));
  EXPECT_EQ(diattenuation(m), 0.5);
  EXPECT_EQ(polarizance(m), 0.5);
}

RC_GTEST_PROP(Diattenuation, IsThePolarizanceOfTheExchangedMatrixAndAtMostOne, ()) {
  const Mueller m = any_realizable();
  RC_ASSERT(std::abs(diattenuation(m) - polarizance(exchanged(m))) < 1e-15);
  RC_ASSERT(diattenuation(m) <= 1 + rounding);
  RC_ASSERT(polarizance(m) <= 1 + rounding);
}

TEST(DegreeOfPolarization, IsThatOfTheLightBehind) {
  EXPECT_NEAR(degree_of_polarization(Stokes{2, 0, 0.6, -0.8}), 0.5, 1e-15);
  EXPECT_EQ(degree_of_polarization(identity(), {2, 0, 0, 0}), 0);
  EXPECT_EQ(degree_of_polarization(polarizer(), {2, 0, 0, 0}), 1);
  EXPECT_EQ(degree_of_polarization(perfect_depolarizer, {1, 0, 0, 1}), 0);
  EXPECT_NEAR(degree_of_polarization(diagonal(1, 0.5, 0.4, 0.3), {1, 0, 0.6, 0.8}), std::hypot(0.24, 0.24), 1e-15);
  EXPECT_EQ(degree_of_polarization(1e300 * identity(), {1e300, 1e300, 0, 0}), 1);
}

TEST(DegreeOfPolarization, IsZeroBehindCrossedPolarizersWhichLeaveNoLight) {
  EXPECT_EQ(degree_of_polarization(polarizer(), {1, -1, 0, 0}), 0);
  EXPECT_EQ(degree_of_polarization(Mueller{}, {1, 0, 0, 0}), 0);
  for (double angle = 0.1; angle < 3; angle += 0.1) {  // here rounding leaves some light, and of either sign
    const Mueller turned = rotator(-angle) * polarizer() * rotator(angle);
    EXPECT_EQ(degree_of_polarization(turned, rotator(-angle) * Stokes{1, -1, 0, 0}), 0) << angle;
  }
}

TEST(DegreeOfPolarization, RefusesLightThatCannotExist) {
  const double nan_value = std::numeric_limits<double>::quiet_NaN();
  for (const Stokes& light :
       {Stokes{0, 0, 0, 0}, Stokes{-1, 0, 0, 0}, Stokes{1, 0.8, 0.6, 0.1}, Stokes{1, 0, 0, 1 + 1e-9},
        Stokes{nan_value, 0, 0, 0}, Stokes{1, 0, nan_value, 0}, Stokes{1e-300, 1e300, 0, 0}}) {
    EXPECT_THROW(degree_of_polarization(identity(), light), std::invalid_argument);
    EXPECT_THROW(degree_of_polarization(light), std::invalid_argument);
  }
  EXPECT_NO_THROW(degree_of_polarization(identity(), {1, 0.8, 0.6, 1e-8}));  // 5e-17 too long
  // A matrix that makes light of negative intensity cannot exist either.
  EXPECT_THROW(degree_of_polarization(diagonal(-1, 0, 0, 0), {1, 0, 0, 0}), std::invalid_argument);
}

RC_GTEST_PROP(DegreeOfPolarization, IsAtMostOneBehindAMatrixThatCanExist, ()) {
  RandomMueller source = any_source();
  const Mueller m = normalized(source.realizable());
  const Stokes field = stokes_behind(source.jones(), 1, 0);
  if ((m * field)[0] < 1e-3 * field[0]) return;  // rounding is all of it
  RC_ASSERT(degree_of_polarization(m, field) <= 1 + 1e-10);
  RC_ASSERT(degree_of_polarization(std::ldexp(1, 800) * m, field) == degree_of_polarization(m, field));
}

TEST(PolarizedBrdf, TellsIncidentFromScatteredPolarization) {
  Mueller s_to_p;  // takes incident s and makes p of it
  s_to_p(0, 0) = s_to_p(0, 1) = 0.5;
  s_to_p(1, 0) = s_to_p(1, 1) = -0.5;
  const PolarizedBrdf f = co_and_cross_polarized(s_to_p);
  EXPECT_EQ(f.sp, 1);
  EXPECT_EQ(f.ss, 0);
  EXPECT_EQ(f.ps, 0);
  EXPECT_EQ(f.pp, 0);
  EXPECT_EQ(co_and_cross_polarized(polarizer()).ss, 1);
  EXPECT_EQ(co_and_cross_polarized(diagonal(0.3, 0, 0, 0)).ps, 0.15);
}

RC_GTEST_PROP(PolarizedBrdf, IsTheIntensityBetweenTwoPolarizers, ()) {
  const Mueller m = any_realizable();
  const PolarizedBrdf f = co_and_cross_polarized(m);
  const auto between = [&](double a, double b) {
    const Stokes out = m * Stokes{1, a, 0, 0};
    return (out[0] + b * out[1]) / 2;
  };
  RC_ASSERT(std::abs(f.ss - between(1, 1)) < rounding);
  RC_ASSERT(std::abs(f.sp - between(1, -1)) < rounding);
  RC_ASSERT(std::abs(f.ps - between(-1, 1)) < rounding);
  RC_ASSERT(std::abs(f.pp - between(-1, -1)) < rounding);
  RC_ASSERT(std::min({f.ss, f.sp, f.ps, f.pp}) > -rounding);
  RC_ASSERT(std::abs(f.ss + f.sp + f.ps + f.pp - 2 * m(0, 0)) < rounding);
}

RC_GTEST_PROP(Coherency, OfAJonesMatrixIsHalfTheProductOfItsElements, ()) {
  const Jones j = any_source().jones();
  const Coherency t = coherency(mueller_of(j));
  for (std::size_t row = 0; row < 4; ++row)
    for (std::size_t column = 0; column < 4; ++column)
      RC_ASSERT(std::abs(t[4 * row + column] - 0.5 * j[row] * std::conj(j[column])) < 40 * rounding);
}

RC_GTEST_PROP(Coherency, HasTheIntensityAsTraceAndLeadsBackToTheMatrix, ()) {
  RandomMueller source = any_source();
  Mueller m;
  for (double& element : m.elements) element = source.between(-1, 1);
  const Coherency t = coherency(m);
  double squares = 0;
  for (const auto& element : t) squares += std::norm(element);
  RC_ASSERT(std::abs(t[0] + t[5] + t[10] + t[15] - m(0, 0)) < rounding);
  RC_ASSERT(std::abs(squares - std::pow(frobenius(m), 2) / 4) < rounding);
  RC_ASSERT(largest(from_coherency(t) - m) < rounding);
}

TEST(Coherency, HasFourEqualEigenvaluesForAPerfectDepolarizerAndOneForAPolarizer) {
  for (const double eigenvalue : coherency_eigenvalues(2 * perfect_depolarizer))
    EXPECT_NEAR(eigenvalue, 0.5, eigenvalue_error);
  const auto eigenvalues = coherency_eigenvalues(polarizer());
  for (const std::size_t q : {0U, 1U, 2U}) EXPECT_NEAR(eigenvalues[q], 0, eigenvalue_error);
  EXPECT_NEAR(eigenvalues[3], 0.5, eigenvalue_error);
}

RC_GTEST_PROP(Coherency, HasTheEigenvaluesOfADiagonalMatrixInClosedForm, ()) {
  RandomMueller source = any_source();
  const double a = source.between(-1, 1), b = source.between(-1, 1), c = source.between(-1, 1);
  std::array<double, 4> expected{(1 + a + b + c) / 4, (1 + a - b - c) / 4, (1 - a + b - c) / 4, (1 - a - b + c) / 4};
  std::sort(expected.begin(), expected.end());
  const auto eigenvalues = coherency_eigenvalues(diagonal(1, a, b, c));
  for (std::size_t q = 0; q < 4; ++q) RC_ASSERT(std::abs(eigenvalues[q] - expected[q]) < eigenvalue_error);
}

RC_GTEST_PROP(Invariants, AreTheSameInTurnedAxesOfEitherBeam, ()) {
  RandomMueller source = any_source();
  const Mueller m = normalized(source.realizable());
  expect_same_invariants(m, rotator(source.between(-7, 7)) * m * rotator(source.between(-7, 7)));
}

RC_GTEST_PROP(Invariants, AreTheSameInAllConventions, ()) {
  const Mueller m = any_realizable();
  using enum StokesConvention;
  for (const StokesConvention to :
       {s_first_right, p_first_left, p_first_right, p_first_left_handed_axes_left, p_first_left_handed_axes_right})
    expect_same_invariants(m, convert(m, germer2017, to));
}

RC_GTEST_PROP(Invariants, DoNotDependOnTheMagnitude, ()) {
  const Mueller m = any_realizable();
  for (const double factor : {std::ldexp(1, -800), std::ldexp(1, 800)}) {
    RC_ASSERT(depolarization(factor * m) == depolarization(m));
    RC_ASSERT(entropy(factor * m) == entropy(m));
    RC_ASSERT(realizability_margin(factor * m) == realizability_margin(m));
    RC_ASSERT(coherency_eigenvalues(factor * m)[3] == factor * coherency_eigenvalues(m)[3]);
    RC_ASSERT(nearest_realizable(factor * m).matrix == factor * nearest_realizable(m).matrix);
  }
}

RC_GTEST_PROP(Invariants, OfSubnormalMatricesAreThoseOfLargerOnesToTheSmallestNumber, ()) {
  constexpr double smallest = std::numeric_limits<double>::denorm_min();
  RandomMueller source = any_source();
  const int exponent = -1060 - source.below(15);
  Mueller small = source.anything(), large;
  small = source.below(2) ? small : source.realizable();
  for (std::size_t e = 0; e < 16; ++e) {
    small.elements[e] = std::ldexp(std::clamp(small.elements[e], -1e3, 1e3), exponent);
    large.elements[e] = std::ldexp(small.elements[e], -exponent);  // exact
  }
  const CloudeDecomposition parts = cloude_decomposition(small), expected = cloude_decomposition(large);
  for (std::size_t q = 0; q < 4; ++q) {
    RC_ASSERT(std::abs(parts.weights[q] - std::ldexp(expected.weights[q], exponent)) <= smallest);
    RC_ASSERT(parts.components[q] == expected.components[q]);
  }
  if (small(0, 0) < 0) return;
  const Projection nearest = nearest_realizable(small), of_large = nearest_realizable(large);
  for (std::size_t e = 0; e < 16; ++e)
    RC_ASSERT(std::abs(nearest.matrix.elements[e] - std::ldexp(of_large.matrix.elements[e], exponent)) <= smallest);
  RC_ASSERT(std::abs(nearest.change - std::ldexp(of_large.change, exponent)) <= smallest);
}

RC_GTEST_PROP(Purity, OfAJonesMatrixIsOneWithASingleEigenvalue, ()) {
  RandomMueller source = any_source();
  const Mueller m = normalized(source.pure(source.below(RandomMueller::kinds)));
  const auto eigenvalues = coherency_eigenvalues(m);
  RC_ASSERT(std::abs(depolarization(m) - 1) < rounding);
  RC_ASSERT(std::abs(purity(m) - 1) < rounding);
  RC_ASSERT(entropy(m) < 1e-12);
  RC_ASSERT(std::abs(eigenvalues[3] - 1) < rounding);
  for (const std::size_t q : {0U, 1U, 2U}) RC_ASSERT(std::abs(eigenvalues[q]) < rounding);
  RC_ASSERT(realizable(m));
}

RC_GTEST_PROP(Purity, IsTheSumOfTheSquaredEigenvaluesAndLiesBetweenAQuarterAndOne, ()) {
  const Mueller m = any_realizable();
  double squares = 0;
  for (const double eigenvalue : coherency_eigenvalues(m)) squares += eigenvalue * eigenvalue;
  RC_ASSERT(std::abs(purity(m) - squares) < rounding);
  RC_ASSERT(purity(m) >= 0.25);
  RC_ASSERT(purity(m) <= 1 + rounding);
  RC_ASSERT(entropy(m) >= 0);
  RC_ASSERT(entropy(m) <= 1);
}

TEST(Entropy, IsOneForAPerfectDepolarizerAndOneHalfForTwoEqualParts) {
  EXPECT_NEAR(entropy(perfect_depolarizer), 1, 1e-15);
  EXPECT_NEAR(entropy(diagonal(1, 1, 0, 0)), 0.5, 1e-13);  // eigenvalues ½, ½, 0, 0
  EXPECT_EQ(purity(diagonal(1, 1, 0, 0)), 0.5);
}

RC_GTEST_PROP(Depolarization, OfAMixtureIsAtMostThatOfItsParts, ()) {
  RandomMueller source = any_source();
  const Mueller a = source.realizable(), b = source.realizable();
  const Mueller x = source.between(0, 1) * normalized(a), y = source.between(0, 1) * normalized(b);
  if (x(0, 0) + y(0, 0) == 0) return;
  const double w = x(0, 0) / (x(0, 0) + y(0, 0));
  RC_ASSERT(depolarization(x + y) <= w * depolarization(a) + (1 - w) * depolarization(b) + rounding);
  RC_ASSERT(entropy(x + y) >= w * entropy(a) + (1 - w) * entropy(b) - 1e-12);
  RC_ASSERT(realizable(x + y));
}

RC_GTEST_PROP(Cloude, ComponentsAreJonesMatricesThatSumToTheMatrix, ()) {
  RandomMueller source = any_source();
  Mueller m = normalized(source.realizable());
  if (source.below(2) == 0)  // the sum holds for matrices that cannot exist, too
    for (double& element : m.elements) element = source.between(-1, 1);
  const CloudeDecomposition parts = cloude_decomposition(m);
  RC_ASSERT(std::is_sorted(parts.weights.rbegin(), parts.weights.rend()));
  RC_ASSERT(largest(sum(parts) - m) < 1e-14);
  for (const Mueller& component : parts.components) {
    RC_ASSERT(component(0, 0) == 1);
    RC_ASSERT(std::abs(depolarization(component) - 1) < rounding);
    RC_ASSERT(realizable(component));
  }
}

TEST(Cloude, FindsThePartsOfWhichAMatrixIsMade) {
  const Mueller waves = 0.7 * quarter_wave_plate + 0.3 * diagonal(1, 1, -1, -1);
  const CloudeDecomposition parts = cloude_decomposition(waves);  // these two are not orthogonal:
  EXPECT_LT(parts.weights[2], 1e-15);
  const CloudeDecomposition apart = cloude_decomposition(0.7 * identity() + 0.3 * diagonal(1, 1, -1, -1));
  EXPECT_NEAR(apart.weights[0], 0.7, 1e-14);
  EXPECT_NEAR(apart.weights[1], 0.3, 1e-14);
  EXPECT_LT(largest(apart.components[0] - identity()), 1e-14);
  EXPECT_LT(largest(apart.components[1] - diagonal(1, 1, -1, -1)), 1e-14);
}

TEST(Realizable, AreTextbookMatricesAndTheZeroMatrix) {
  for (const Mueller& m : {perfect_depolarizer, polarizer(), quarter_wave_plate, identity(), Mueller{}})
    EXPECT_TRUE(realizable(m));
  EXPECT_NEAR(realizability_margin(perfect_depolarizer), 0.25, 1e-15);
  EXPECT_NEAR(realizability_margin(polarizer()), 0, rounding);
  EXPECT_NEAR(realizability_margin(2 * diagonal(1, -1, -1, -1)), -0.5, rounding);  // λ = (1 − 3)/4, whatever M11
}

TEST(Realizable, AreNotTheTransposeOfJonesFieldsNorIntensitiesBelowZero) {
  EXPECT_FALSE(realizable(diagonal(1, 1, 1, -1)));  // complex conjugation of the field
  EXPECT_FALSE(realizable(diagonal(-1, 0, 0, 0)));
  EXPECT_FALSE(realizable(diagonal(0, 1e-300, 0, 0)));
  EXPECT_FALSE(realizable(-1e-300 * identity()));
}

TEST(Realizable, IsToldFromAMatrixJustOutside) {
  for (const double beyond : {1e-3, 1e-6, 1e-9, 1e-11}) {
    const double x = 1.0 / 3;  // diag(1, −x, −x, −x) is the limit
    const Mueller inside = diagonal(1, -x + beyond, -x, -x), outside = diagonal(1, -x - beyond, -x, -x);
    EXPECT_TRUE(realizable(inside)) << beyond;
    EXPECT_FALSE(realizable(outside)) << beyond;
    EXPECT_NEAR(realizability_margin(outside), -beyond / 4, 1e-15);
    const Projection nearest = nearest_realizable(outside);
    EXPECT_TRUE(realizable(nearest.matrix));
    EXPECT_GT(nearest.change, beyond / 4);
    EXPECT_LT(nearest.change, beyond);  // the inside is not farther than that
    EXPECT_NEAR(nearest.change, frobenius(nearest.matrix - outside), 1e-15);
  }
}

RC_GTEST_PROP(Projection, ChangesNothingInAMatrixThatCanExist, ()) {
  const Mueller m = any_source().realizable();
  const Projection nearest = nearest_realizable(m);
  RC_ASSERT(nearest.matrix == m);
  RC_ASSERT(nearest.change == 0);
}

RC_GTEST_PROP(Projection, KeepsTheIntensityAndIsIdempotent, ()) {
  RandomMueller source = any_source();
  Mueller m;
  for (double& element : m.elements) element = source.between(-1, 1);
  m(0, 0) = std::pow(10, source.between(-6, 1));
  const Projection nearest = nearest_realizable(m);
  RC_ASSERT(nearest.matrix(0, 0) == m(0, 0));
  RC_ASSERT(realizable(nearest.matrix));
  RC_ASSERT((nearest.change == 0) == realizable(m));
  RC_ASSERT(std::abs(nearest.change - frobenius(nearest.matrix - m)) < rounding);
  const Projection again = nearest_realizable(nearest.matrix);
  RC_ASSERT(again.matrix == nearest.matrix);
  RC_ASSERT(again.change == 0);
}

// Of a closed convex set the nearest point P to x is the one with (x − P)·(y − P) ≤ 0 for all y of the set.
RC_GTEST_PROP(Projection, IsTheNearestMatrixOfThatIntensity, ()) {
  RandomMueller source = any_source();
  Mueller m;
  for (double& element : m.elements) element = source.between(-1, 1);
  m(0, 0) = 1;
  const Mueller nearest = nearest_realizable(m).matrix;
  for (int i = 0; i < 20; ++i) {
    const Mueller other = normalized(source.pure(0)) - nearest, away = m - nearest;
    double product = 0;
    for (std::size_t k = 0; k < 16; ++k) product += other.elements[k] * away.elements[k];
    RC_ASSERT(product < 10 * rounding);
  }
}

TEST(Projection, OfNoIntensityIsTheZeroMatrixAndOfANegativeOneIsRefused) {
  const Projection dark = nearest_realizable(diagonal(0, 3, 4, 0));
  EXPECT_EQ(dark.matrix, Mueller{});
  EXPECT_NEAR(dark.change, 5, 1e-14);
  EXPECT_EQ(nearest_realizable(Mueller{}).change, 0);
  EXPECT_THROW(nearest_realizable(diagonal(-1, 0, 0, 0)), std::invalid_argument);
}

TEST(Analysis, RefusesMatricesWithoutIntensityAndNamesIt) {
  const std::vector<std::function<double(const Mueller&)>> functions{
      depolarization, [](const Mueller& m) { return diattenuation(m); }, polarizance, realizability_margin, purity,
      entropy};
  for (const auto& function : functions)
    for (const Mueller& m : {Mueller{}, diagonal(0, 1, 0, 0), diagonal(-2.5, 1, 0, 0)}) {
      try {
        function(m);
        ADD_FAILURE() << "M11 = " << m(0, 0) << " was accepted";
      } catch (const std::invalid_argument& error) {
        EXPECT_NE(std::string(error.what()).find(m(0, 0) == 0 ? "M11 = 0" : "M11 = -2.5"), std::string::npos)
            << error.what();
      }
    }
}

TEST(Analysis, RefusesNumbersThatAreNotFiniteAndNamesTheElement) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Mueller m = identity();
    m(2, 3) = bad;
    EXPECT_THROW(depolarization(m), std::invalid_argument);
    EXPECT_THROW(diattenuation(m), std::invalid_argument);
    EXPECT_THROW(polarizance(m), std::invalid_argument);
    EXPECT_THROW(degree_of_polarization(m, {1, 0, 0, 0}), std::invalid_argument);
    EXPECT_THROW(coherency(m), std::invalid_argument);
    EXPECT_THROW(coherency_eigenvalues(m), std::invalid_argument);
    EXPECT_THROW(realizability_margin(m), std::invalid_argument);
    EXPECT_THROW(purity(m), std::invalid_argument);
    EXPECT_THROW(entropy(m), std::invalid_argument);
    EXPECT_THROW(cloude_decomposition(m), std::invalid_argument);
    EXPECT_THROW(nearest_realizable(m), std::invalid_argument);
    try {
      (void)realizable(m);
      ADD_FAILURE();
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("M34"), std::string::npos) << error.what();
    }
  }
}

TEST(Analysis, CoAndCrossPolarizedBrdfsAskForFourElementsAndAreUnknownWithoutThem) {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  Mueller m = diagonal(1, 0.5, unknown, unknown);
  m(0, 2) = unknown;
  EXPECT_EQ(co_and_cross_polarized(m).ss, 0.75);
  EXPECT_EQ(co_and_cross_polarized(m).sp, 0.25);
  for (double* element : {&m(0, 0), &m(0, 1), &m(1, 0), &m(1, 1)}) {
    const double known = std::exchange(*element, unknown);
    const PolarizedBrdf f = co_and_cross_polarized(m);
    for (const double value : {f.ss, f.sp, f.ps, f.pp}) EXPECT_TRUE(std::isnan(value));
    *element = std::numeric_limits<double>::infinity();
    EXPECT_THROW(co_and_cross_polarized(m), std::invalid_argument);
    *element = known;
  }
}

// Every number that comes out is finite, or the caller is told that there is none.
TEST(Analysis, MakesFiniteNumbersOfFiniteNumbers) {
  RandomMueller source(1);
  int answered = 0;
  const auto expect_finite = [&](const std::function<std::vector<double>()>& numbers) {
    try {
      for (const double number : numbers()) EXPECT_TRUE(std::isfinite(number));
      ++answered;
    } catch (const std::invalid_argument&) {
    }
  };
  const auto all = [](const auto& numbers) { return std::vector<double>(numbers.begin(), numbers.end()); };
  for (int i = 0; i < 20000; ++i) {
    const Mueller m = source.anything();
    expect_finite([&] {
      return std::vector{depolarization(m), diattenuation(m), polarizance(m), purity(m), entropy(m)};
    });
    expect_finite([&] { return std::vector{realizability_margin(m), realizable(m) ? 1.0 : 0.0}; });
    expect_finite([&] { return std::vector{degree_of_polarization(m, {1, 0.6, 0, 0.8})}; });
    expect_finite([&] {
      const PolarizedBrdf f = co_and_cross_polarized(m);
      return std::vector{f.ss, f.sp, f.ps, f.pp};
    });
    expect_finite([&] { return all(coherency_eigenvalues(m)); });
    expect_finite([&] { return all(from_coherency(coherency(m)).elements); });
    expect_finite([&] { return all(cloude_decomposition(m).weights); });
    for (const std::size_t q : {0U, 1U, 2U, 3U})
      expect_finite([&] { return all(cloude_decomposition(m).components[q].elements); });
    expect_finite([&] { return std::vector{nearest_realizable(m).change}; });
    expect_finite([&] { return all(nearest_realizable(m).matrix.elements); });
  }
  EXPECT_GT(answered, 100000);
}

// Values of an independent prototype, 12 digits printed.
TEST(Analysis, AgreesWithTheGoldenGeometries) {
  const std::string path = reference("golden_geometries.json");
  std::ifstream file(path);
  const nlohmann::json cases = nlohmann::json::parse(file)["cases"];
  ASSERT_EQ(cases.size(), 21U);
  for (const auto& golden : cases)
    for (const char* frame : {"m_xy", "m_sp", "m_plane"}) {
      Mueller m;
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) m(i, j) = golden[frame][static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
      const auto eigenvalues = coherency_eigenvalues(m);
      for (std::size_t q = 0; q < 4; ++q) EXPECT_NEAR(eigenvalues[q], golden["eig_coherency"][q], 4e-12);
      EXPECT_NEAR(depolarization(m), golden["GilBernabeu"], 4e-12);
    }
}

// Theory 6.2.
TEST(PublishedData, AreAllRealizable) {
  const std::string grid = published("PTFE.data.csv"), random = published("PTFE.data.random.csv");
  if (grid.empty() || random.empty()) GTEST_SKIP() << absent("PTFE.data.csv, PTFE.data.random.csv");
  const std::map<double, double> expected{{0.351, 0.1203}, {0.532, 0.1035}, {0.633, 0.1063}, {1.064, 0.1016}};
  std::map<double, double> smallest;
  std::map<double, int> count;
  for (const Sample& sample : read_samples(grid)) {
    const double margin = realizability_margin(sample.normalized);
    smallest[sample.wavelength] =
        std::min(smallest.contains(sample.wavelength) ? smallest[sample.wavelength] : 1, margin);
    ++count[sample.wavelength];
  }
  ASSERT_EQ(smallest.size(), 4U);
  for (const auto& [wavelength, margin] : expected) {
    EXPECT_EQ(count[wavelength], 1824) << wavelength;
    EXPECT_NEAR(smallest[wavelength], margin, 0.5e-4) << wavelength;
  }
  double smallest_random = 1;
  const auto samples = read_samples(random);
  for (const Sample& sample : samples)
    smallest_random = std::min(smallest_random, realizability_margin(sample.normalized));
  EXPECT_EQ(samples.size(), 1760U);
  EXPECT_NEAR(smallest_random, 0.156, 0.5e-3);
}
