// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarization/decompositions.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "given/random_mueller.hpp"
#include "mmbrdf/polarization/analysis.hpp"

using namespace mmbrdf;

namespace {

constexpr double pi = std::numbers::pi;

// Of orthogonality and symmetry of a factor with element 11 equal to 1.
constexpr double rounding = 1e-13;

Mueller product(const LuChipman& f) { return f.depolarizer * f.retarder * f.diattenuator; }
Mueller product(const SymmetricDecomposition& f) {
  return f.diattenuator2 * f.retarder2 * f.depolarizer * transpose(f.retarder1) * f.diattenuator1;
}

/// Largest difference relative to M11.
template <class Factors>
double miss(const Factors& factors, const Mueller& m) {
  return largest(product(factors) - m) / m(0, 0);
}

/// Of the lower right 3 × 3 block.
double determinant(const Mueller& m) {
  return m(1, 1) * (m(2, 2) * m(3, 3) - m(2, 3) * m(3, 2)) - m(1, 2) * (m(2, 1) * m(3, 3) - m(2, 3) * m(3, 1)) +
         m(1, 3) * (m(2, 1) * m(3, 2) - m(2, 2) * m(3, 1));
}

void expect_retarder(const Mueller& m) {
  EXPECT_LT(largest(m * transpose(m) - identity()), rounding);
  EXPECT_NEAR(determinant(m), 1, rounding);
  for (const int i : {1, 2, 3}) EXPECT_TRUE(m(0, i) == 0 && m(i, 0) == 0);
}

void expect_diattenuator(const Mueller& m) {
  EXPECT_LT(largest(m - transpose(m)), rounding * m(0, 0));
  EXPECT_TRUE(realizable(m));
  EXPECT_NEAR(depolarization(m), 1, rounding);
  EXPECT_LE(diattenuation(m), 1 + rounding);
}

/// A diattenuator with this vector, as the textbook has it.
Mueller diattenuator(double d1, double d2, double d3) {
  const std::array<double, 3> d{d1, d2, d3};
  const double square = d1 * d1 + d2 * d2 + d3 * d3, a = std::sqrt(1 - square);
  Mueller m = diagonal(1, a, a, a);
  for (int i = 0; i < 3; ++i) {
    const auto row = static_cast<std::size_t>(i);
    m(0, i + 1) = m(i + 1, 0) = d[row];
    for (int j = 0; j < 3; ++j) m(i + 1, j + 1) += (1 - a) * d[row] * d[static_cast<std::size_t>(j)] / square;
  }
  return m;
}

/// With the phase of e2 ahead of that of e1, axes turned by angle.
Mueller retarder(double phase, double angle) {
  const Mueller wave = mueller_of({1, 0, 0, std::polar(1.0, phase)});
  return rotator(-angle) * wave * rotator(angle);
}

Mueller polarizer(double angle) {
  Mueller m;
  for (const int i : {0, 1})
    for (const int j : {0, 1}) m(i, j) = 0.5;
  return rotator(-angle) * m * rotator(angle);
}

/// (1, p)(1, d)ᵀ.
Mueller dyad(const std::array<double, 3>& p, const std::array<double, 3>& d) {
  const Stokes column{1, p[0], p[1], p[2]}, row{1, d[0], d[1], d[2]};
  Mueller m;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) m(i, j) = column[static_cast<std::size_t>(i)] * row[static_cast<std::size_t>(j)];
  return m;
}

}  // namespace

TEST(LuChipman, FactorsOfTenThousandRandomMatricesMultiplyBack) {
  RandomMueller source(1);
  double worst = 0;
  for (int i = 0; i < 10000; ++i) {
    const Mueller m = source.realizable();
    const LuChipman factors = lu_chipman(m);
    worst = std::max(worst, miss(factors, m));
    if (i % 10 != 0) continue;
    expect_retarder(factors.retarder);
    expect_diattenuator(factors.diattenuator);
    EXPECT_LT(largest(transpose(factors.depolarizer) - factors.depolarizer -
                      (transpose(dyad(polarizance_vector(factors.depolarizer), {})) -
                       dyad(polarizance_vector(factors.depolarizer), {}))),
              1e-15);  // symmetric but for its first column
  }
  EXPECT_LT(worst, lu_chipman_error);
}

TEST(LuChipman, FactorsOfEverySingularFamilyMultiplyBack) {
  RandomMueller source(2);
  for (int i = 0; i < 2000; ++i) {
    const double p = source.between(0, 1), x = source.between(-1, 1), angle = source.between(0, pi);
    const std::array<double, 3> vector{x * p, std::sqrt(1 - x * x) * p, 0};
    const std::array<double, 3> axis{std::cos(angle), 0, std::sin(angle)};
    const double near = angle + pi + std::pow(10, source.between(-17, -5));
    for (const Mueller& m :
         {dyad(vector, axis), dyad(axis, vector), dyad(axis, axis), dyad(vector, vector), dyad({}, axis),
          dyad(axis, {}), dyad(axis, {-axis[0], 0, -axis[2]}), dyad(axis, {std::cos(near), 0, std::sin(near)}),
          diagonal(1, x, 0, 0), diagonal(1, 0, p, 0), retarder(angle, x) * diagonal(1, p, x * (1 - p), 0),
          polarizer(angle) * retarder(x, 0) * polarizer(angle + p), dyad(vector, axis) + 1e-15 * identity(),
          diagonal(1, p / 3, -p / 3, p / 3) * retarder(x, angle)}) {
      ASSERT_TRUE(realizable(m));
      const LuChipman factors = lu_chipman(m);
      ASSERT_LT(miss(factors, m), lu_chipman_error);
      expect_retarder(factors.retarder);
      expect_diattenuator(factors.diattenuator);
    }
  }
}

TEST(LuChipman, LeavesPureFactorsAsTheyAre) {
  const Mueller d = diattenuator(0.3, -0.5, 0.2), r = retarder(1.1, 0.4);
  EXPECT_LT(largest(lu_chipman(2 * d).diattenuator - 2 * d), 1e-14);
  EXPECT_LT(largest(lu_chipman(2 * d).retarder - identity()), 1e-14);
  EXPECT_LT(largest(lu_chipman(r).retarder - r), 1e-14);
  EXPECT_LT(largest(lu_chipman(r).depolarizer - identity()), 1e-14);
}

RC_GTEST_PROP(LuChipman, FindsTheThreeFactorsOfAProduct, ()) {
  RandomMueller source(*rc::gen::arbitrary<std::uint64_t>());
  const Mueller axes = retarder(source.between(0, 3), source.between(0, 3));
  Mueller depolarizer = axes *
                        diagonal(1, source.between(0.6, 0.7), source.between(0.4, 0.5), source.between(0.4, 0.5)) *
                        transpose(axes);
  depolarizer(1, 0) = 0.05;
  depolarizer(3, 0) = -0.02;
  const Mueller r = retarder(source.between(0.1, 3), source.between(0, 3));
  const Mueller d = diattenuator(source.between(-0.5, 0.5), source.between(-0.5, 0.5), source.between(0.1, 0.5));
  const LuChipman found = lu_chipman(depolarizer * r * d);
  RC_ASSERT(largest(found.depolarizer - depolarizer) < rounding);
  RC_ASSERT(largest(found.retarder - r) < rounding);
  RC_ASSERT(largest(found.diattenuator - d) < rounding);
}

TEST(LuChipman, OfAnIdealPolarizerIsADiattenuatorAlone) {
  const LuChipman factors = lu_chipman(polarizer(0.7));
  EXPECT_LT(largest(factors.depolarizer - identity()), 1e-14);
  EXPECT_LT(largest(factors.retarder - identity()), 1e-14);
  EXPECT_LT(largest(factors.diattenuator - polarizer(0.7)), 1e-14);
}

TEST(LuChipman, OfAPerfectDepolarizerTurnsNothing) {
  const LuChipman factors = lu_chipman(diagonal(0.3, 0, 0, 0));
  EXPECT_EQ(factors.depolarizer, diagonal(1, 0, 0, 0));
  EXPECT_EQ(factors.retarder, identity());
  EXPECT_EQ(factors.diattenuator, 0.3 * identity());
}

TEST(LuChipman, OfRankOneTurnsTheOneDirectionThatIsLeftAsLittleAsPossible) {
  Mueller m = diagonal(1, 0, 0, 0);  // light along e1 comes out between e1 and e2, nothing else is polarized
  m(2, 1) = 0.5;
  const LuChipman factors = lu_chipman(m);
  EXPECT_NEAR(retardance(factors.retarder), pi / 2, 1e-14);
  EXPECT_NEAR(factors.retarder(2, 1), 1, 1e-14);
  EXPECT_NEAR(factors.retarder(3, 3), 1, 1e-14);
  EXPECT_LT(largest(factors.depolarizer - diagonal(1, 0, 0.5, 0)), 1e-14);
}

TEST(LuChipman, BehindADiattenuatorAPerfectDepolarizerTurnsNothingEither) {
  for (int i = 1; i < 50; ++i) {  // m' is 0 but for rounding
    const Mueller d = rotator(0.1 * i) * diattenuator(0.3, -0.5, 0.2) * rotator(-0.1 * i);
    EXPECT_LT(largest(lu_chipman(diagonal(1, 0, 0, 0) * retarder(i, 0.3) * d).retarder - identity()), 1e-15);
    EXPECT_LT(largest(lu_chipman(dyad({0.1, 0.2, 0.3}, diattenuation_vector(d))).retarder - identity()), 1e-15);
  }
}

TEST(LuChipman, OfADepolarizingAnalyzerTurnsItsAxisIntoThatOfTheLightBehind) {
  const LuChipman factors = lu_chipman(dyad({0, 0.5, 0}, {1, 0, 0}));
  EXPECT_LT(largest(factors.depolarizer - diagonal(1, 0.5, 0.5, 0.5)), 1e-15);
  EXPECT_NEAR(retardance(factors.retarder), pi / 2, 1e-15);
  EXPECT_LT(largest(factors.diattenuator - 2 * polarizer(0)), 1e-15);
}

TEST(LuChipman, GivesANegativeDeterminantToTheDepolarizerAsAWhole) {
  const LuChipman factors = lu_chipman(diagonal(1, 0.3, 0.3, -0.3));
  EXPECT_LT(largest(factors.depolarizer - diagonal(1, -0.3, -0.3, -0.3)), 1e-15);
  EXPECT_LT(largest(factors.retarder - diagonal(1, -1, -1, 1)), 1e-15);
}

TEST(LuChipman, OfRankTwoHasTheOnlyRotationThatIsLeft) {
  const LuChipman factors = lu_chipman(retarder(1.1, 0.4) * diagonal(1, 0.5, 0.4, 0));
  EXPECT_LT(largest(factors.retarder - retarder(1.1, 0.4)), 1e-14);
}

TEST(Retardance, IsTheAngleOfTheRotation) {
  for (const double phase : {0.0, 1e-9, 0.5, pi / 2, 3.0, pi - 1e-9, pi})
    for (const double angle : {0.0, 0.3, 2.0}) EXPECT_NEAR(retardance(retarder(phase, angle)), phase, 1e-14) << phase;
  EXPECT_NEAR(retardance(rotator(0.4)), 0.8, 1e-15);
  EXPECT_THROW(retardance(diagonal(1, 0.9, 0.9, 0.9)), std::invalid_argument);
  EXPECT_THROW(retardance(diagonal(1, 1, 1, -1)), std::invalid_argument);
  EXPECT_THROW(retardance(polarizer(0)), std::invalid_argument);
  EXPECT_THROW(retardance(Mueller{}), std::invalid_argument);
  EXPECT_THROW(retardance(-1 * identity()), std::invalid_argument);
}

TEST(DepolarizationPower, IsOneForAPerfectDepolarizerAndZeroForNone) {
  EXPECT_EQ(depolarization_power(diagonal(2, 0, 0, 0)), 1);
  EXPECT_EQ(depolarization_power(identity()), 0);
  EXPECT_NEAR(depolarization_power(diagonal(1, 0.6, 0.3, 0.3)), 0.6, 1e-15);
  EXPECT_NEAR(depolarization_power(diagonal(1, -0.6, -0.3, -0.3)), 0.6, 1e-15);
  EXPECT_THROW(depolarization_power(Mueller{}), std::invalid_argument);
}

// What is left beside a diattenuation of 1 - 1e-12 has a trace of up to 3.002.
TEST(DepolarizationPower, IsBetweenZeroAndOneBesideAnyDiattenuator) {
  RandomMueller source(3);
  for (int i = 0; i < 5000; ++i) {
    const double angle = source.between(0, 2 * pi), length = 1 - std::pow(10, source.between(-14, 0));
    const Mueller strong = diattenuator(length * std::cos(angle), length * std::sin(angle), 0);
    const double power = depolarization_power(lu_chipman(source.pure(3) * strong).depolarizer);
    EXPECT_TRUE(power >= 0 && power <= 1) << power;
  }
}

// Matrices with an eigenvalue that is nearly a multiple one, behind strong diattenuators, are why the promise is not
// 1e-12; some of them are refused.
TEST(SymmetricDecomposition, FactorsOfTenThousandRandomMatricesMultiplyBack) {
  RandomMueller source(3);
  int beyond = 0, refused = 0;
  for (int i = 0; i < 10000; ++i) {
    const Mueller m = source.realizable();
    try {
      const SymmetricDecomposition f = symmetric_decomposition(m);
      const double missed = miss(f, m);
      EXPECT_LT(missed, symmetric_error);
      if (missed > 1e-12) ++beyond;
      if (i % 10 != 0) continue;
      for (const Mueller& turn : {f.retarder1, f.retarder2}) expect_retarder(turn);
      for (const Mueller& weak : {f.diattenuator1, f.diattenuator2}) expect_diattenuator(weak);
      const Mueller& d = f.depolarizer;
      EXPECT_EQ(d, diagonal(d(0, 0), d(1, 1), d(2, 2), d(3, 3)));
      EXPECT_GE(d(1, 1), d(2, 2));
      EXPECT_GE(d(2, 2), std::abs(d(3, 3)));
    } catch (const std::invalid_argument&) {
      ++refused;
    }
  }
  EXPECT_LE(beyond, 100);
  EXPECT_LE(refused, 20);
}

RC_GTEST_PROP(SymmetricDecomposition, FindsTheDiattenuatorsAndTheDiagonalOfAProduct, ()) {
  RandomMueller source(*rc::gen::arbitrary<std::uint64_t>());
  const Mueller d1 = diattenuator(source.between(-0.5, 0.5), source.between(-0.5, 0.5), source.between(0.1, 0.5));
  const Mueller d2 = diattenuator(source.between(-0.5, 0.5), source.between(-0.5, 0.5), source.between(0.1, 0.5));
  const Mueller depolarizer = diagonal(1, source.between(0.7, 0.8), source.between(0.5, 0.6), source.between(0.5, 0.6));
  const Mueller r1 = retarder(source.between(0, 3), source.between(0, 3)), r2 = retarder(source.between(0, 3), 0.2);
  const SymmetricDecomposition found = symmetric_decomposition(d2 * r2 * depolarizer * transpose(r1) * d1);
  RC_ASSERT(largest(found.diattenuator1 - d1) < 1e-12);
  RC_ASSERT(largest(found.diattenuator2 - d2) < 1e-12);
  std::array<double, 3> diagonal_elements{depolarizer(1, 1), depolarizer(2, 2), depolarizer(3, 3)};
  std::sort(diagonal_elements.rbegin(), diagonal_elements.rend());
  RC_ASSERT(std::abs(found.depolarizer(0, 0) - 1) < 1e-12);
  for (int i = 0; i < 3; ++i)
    RC_ASSERT(std::abs(found.depolarizer(i + 1, i + 1) - diagonal_elements[static_cast<std::size_t>(i)]) < 1e-12);
}

TEST(SymmetricDecomposition, OfSingularMatricesIsWhatTheHeaderSays) {
  const SymmetricDecomposition dark = symmetric_decomposition(diagonal(0.3, 0, 0, 0));
  EXPECT_EQ(dark.depolarizer, diagonal(0.3, 0, 0, 0));
  EXPECT_EQ(diattenuation(dark.diattenuator1) + diattenuation(dark.diattenuator2), 0);

  const SymmetricDecomposition pure = symmetric_decomposition(retarder(1, 0.3) * diattenuator(0.3, 0.4, 0.5));
  EXPECT_EQ(diattenuation(pure.diattenuator1), 0);
  EXPECT_NEAR(diattenuation(pure.diattenuator2), std::sqrt(0.5), 1e-14);
  EXPECT_NEAR(pure.depolarizer(3, 3), pure.depolarizer(0, 0), 1e-14);

  const SymmetricDecomposition analyzer = symmetric_decomposition(dyad({0, 0.5, 0}, {1, 0, 0}));
  EXPECT_EQ(analyzer.depolarizer, diagonal(1, 0, 0, 0));
  EXPECT_NEAR(diattenuation(analyzer.diattenuator1), 1, 1e-15);
  EXPECT_NEAR(diattenuation(analyzer.diattenuator2), 0.5, 1e-15);

  const SymmetricDecomposition ideal = symmetric_decomposition(polarizer(0.2));
  EXPECT_LT(largest(ideal.depolarizer - 0.25 * identity()), 1e-15);
  EXPECT_LT(miss(ideal, polarizer(0.2)), 1e-14);
}

// Dyads to rounding, by which no factor but these is determined; fast arithmetic finds others in some of them.
TEST(SymmetricDecomposition, HasADarkDepolarizerBesideAPolarizerToRounding) {
  for (int bits = 44; bits < 53; ++bits) {
    const double missing = std::ldexp(1, -bits);
    Mueller m = dyad({1 - missing, 0, 0}, {0, 0, 0});
    m(2, 2) = m(3, 3) = missing;
    EXPECT_EQ(symmetric_decomposition(m).depolarizer, diagonal(1, 0, 0, 0)) << bits;
    EXPECT_EQ(symmetric_decomposition(transpose(m)).depolarizer, diagonal(1, 0, 0, 0)) << bits;
  }
}

TEST(SymmetricDecomposition, HasNoDiattenuatorInFrontOfPureMatricesDownToPolarizersWithALeak) {
  RandomMueller source(5);
  for (int i = 0; i < 3000; ++i) {
    const auto a = source.complex(), b = source.complex(), c = source.complex(), d = source.complex();
    const double leak = std::pow(10, source.between(-7, 0));
    const Jones other = source.jones();
    const Mueller m = mueller_of(
        {a * c + leak * other[0], a * d + leak * other[1], b * c + leak * other[2], b * d + leak * other[3]});
    const SymmetricDecomposition f = symmetric_decomposition(m);
    ASSERT_EQ(f.diattenuator1, identity()) << leak;
    ASSERT_LT(miss(f, m), 1e-12) << leak;
  }
}

TEST(SymmetricDecomposition, GivesTheSignOfTheDeterminantToTheSmallestElement) {
  const SymmetricDecomposition f = symmetric_decomposition(diagonal(1, 0.4, 0.3, -0.2));
  EXPECT_LT(largest(f.depolarizer - diagonal(1, 0.4, 0.3, -0.2)), 1e-15);
}

// Ossikovski 2010, the canonical form of type II: its eigenvector (1, 1, 0, 0) is completely polarized.
TEST(SymmetricDecomposition, OfAMatrixWithoutADiagonalFormIsRefused) {
  for (const double a : {0.0, 0.3, 0.9}) {
    const Mueller m{{2, -1, 0, 0, 1, 0, 0, 0, 0, 0, a, 0, 0, 0, 0, a}};
    ASSERT_TRUE(realizable(m));
    EXPECT_THROW(symmetric_decomposition(m), std::invalid_argument);
    EXPECT_LT(miss(lu_chipman(m), m), lu_chipman_error);
  }
}

TEST(Decompositions, RefuseWhatCannotExistAndSayWhy) {
  const auto message = [](auto&& decompose, const Mueller& m) -> std::string {
    try {
      decompose(m);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  for (const Mueller& m : {Mueller{}, diagonal(-1, 0, 0, 0)}) {
    EXPECT_NE(message(lu_chipman, m).find("M11 = "), std::string::npos);
    EXPECT_NE(message(symmetric_decomposition, m).find("M11 = "), std::string::npos);
  }
  const Mueller conjugation = diagonal(1, 1, 1, -1);
  EXPECT_NE(message(lu_chipman, conjugation).find("nearest_realizable"), std::string::npos);
  EXPECT_NE(message(symmetric_decomposition, conjugation).find("nearest_realizable"), std::string::npos);
  EXPECT_LT(miss(lu_chipman(nearest_realizable(conjugation).matrix), nearest_realizable(conjugation).matrix),
            lu_chipman_error);
}

TEST(Decompositions, MakeFiniteNumbersOfFiniteNumbers) {
  RandomMueller source(4);
  int answered = 0;
  for (int i = 0; i < 5000; ++i) {
    Mueller m = source.anything();
    m(0, 0) = std::abs(m(0, 0));
    m = nearest_realizable(m).matrix;
    for (const Mueller& any : {source.anything(), m}) {
      try {
        const LuChipman l = lu_chipman(any);
        for (const Mueller& factor : {l.depolarizer, l.retarder, l.diattenuator})
          EXPECT_TRUE(std::isfinite(largest(factor)));
        ++answered;
        const SymmetricDecomposition f = symmetric_decomposition(any);
        for (const Mueller& factor : {f.diattenuator1, f.retarder1, f.depolarizer, f.retarder2, f.diattenuator2})
          EXPECT_TRUE(std::isfinite(largest(factor)));
      } catch (const std::invalid_argument&) {
      }
    }
  }
  EXPECT_GT(answered, 1000);
}
