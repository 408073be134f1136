// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarimetry/polarimeter.hpp"
#include "mmbrdf/polarimetry/reduction.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include "given/cases.hpp"
#include "given/random_mueller.hpp"
#include "mmbrdf/polarization/elements.hpp"

namespace mmbrdf {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double best_plate = radians(131.81);
// Elements up to 1 through inverses of condition up to 10: some ten roundings of 1e-16 each.
constexpr double rounding = 1e-13;

std::vector<double> in_radians(std::vector<double> azimuths) {
  for (double& azimuth : azimuths) azimuth = radians(azimuth);
  return azimuths;
}

const std::vector<double> best_azimuths = in_radians({-51.69, -15.12, 15.12, 51.69});

Polarimeter best() { return ideal_polarimeter(best_plate, best_azimuths); }

/// Six generator states and five analysis states, none of them symmetric to another.
Polarimeter overdetermined() {
  Polarimeter result = ideal_polarimeter(2.2, in_radians({-70, -48, -13, 11, 40, 66}));
  result.analyzer = ideal_polarimeter(2.4, in_radians({-60, -35, 5, 25, 62})).analyzer;
  return result;
}

Mueller random_mueller() {
  Mueller m;
  for (double& element : m.elements) element = between(-1, 1);
  return m;
}

const Mueller example{{0.8, 0.1, -0.05, 0.02, 0.07, 0.4, 0.03, -0.06, 0.01, -0.02, -0.3, 0.2, 0.03, 0.05, -0.25, -0.2}};

double condition_of(double retardance_deg, const std::vector<double>& azimuths) {
  return condition_number(ideal_polarimeter(radians(retardance_deg), azimuths).generator);
}

double best_condition(double retardance_deg, int states) {
  return condition_of(retardance_deg, optimal_angles(radians(retardance_deg), states));
}

/// A component of the states: those of w_1, w_2, …, then those of a_1, a_2, …
double& component(Polarimeter& polarimeter, std::size_t number) {
  const std::size_t generators = polarimeter.generator.size();
  return number / 4 < generators ? polarimeter.generator[number / 4][number % 4]
                                 : polarimeter.analyzer[number / 4 - generators][number % 4];
}

std::size_t components(const Polarimeter& p) { return 4 * (p.generator.size() + p.analyzer.size()); }

/// With a correlation of a half between neighbours; row-major.
std::vector<double> some_covariance(std::size_t size, double sigma) {
  std::vector<double> result(size * size);
  for (std::size_t i = 0; i < size; ++i) {
    result[i * size + i] = sigma * sigma;
    if (i + 1 < size) result[i * size + i + 1] = result[(i + 1) * size + i] = 0.5 * sigma * sigma;
  }
  return result;
}

}  // namespace

// ---- states ---------------------------------------------------------------------------------------------------------

// Computed with an independent prototype: two of the four states of each arm, at -51.69 and -15.12 degrees, in its
// order; the others are their mirror images. All of its 16 digits but the last.
TEST(IdealPolarimeter, HasTheStatesOfThePrototype) {
  const std::array<Stokes, 2> generator{{{1, -0.5774131002462572, 0.3752109847820057, 0.7251281463044471},
                                         {1, 0.5772738236353774, -0.7251513465535576, 0.3753804165602585}}};
  const std::array<Stokes, 2> analyzer{{{0.5, -0.2887065501231286, 0.18760549239100285, -0.36256407315222355},
                                        {0.5, 0.2886369118176887, -0.3625756732767788, -0.18769020828012925}}};
  const Polarimeter p = best();
  ASSERT_EQ(p.readings(), 16U);
  for (std::size_t s = 0; s < 2; ++s)
    for (std::size_t k = 0; k < 4; ++k) {
      const double sign = k < 2 ? 1 : -1;  // of the mirror image
      EXPECT_NEAR(p.generator[s][k], generator[s][k], 1e-15);
      EXPECT_NEAR(p.generator[3 - s][k], sign * generator[s][k], 1e-15);
      EXPECT_NEAR(p.analyzer[s][k], analyzer[s][k], 1e-15);
      EXPECT_NEAR(p.analyzer[3 - s][k], sign * analyzer[s][k], 1e-15);
    }
}

RC_GTEST_PROP(IdealPolarimeter, MakesPolarizedStatesThatItsAnalyzerMirrors, ()) {
  const double retardance = between(-pi, pi), azimuth = between(-pi, pi);
  const Polarimeter p = ideal_polarimeter(retardance, std::vector<double>{azimuth});
  const Stokes &w = p.generator[0], &a = p.analyzer[0];
  RC_ASSERT(std::abs(std::hypot(w[1], w[2], w[3]) - w[0]) <= rounding);
  // Light that returns through the plate: its handedness is the other one.
  RC_ASSERT(std::abs(2 * a[1] - w[1]) <= rounding && std::abs(2 * a[2] - w[2]) <= rounding);
  RC_ASSERT(std::abs(2 * a[3] + w[3]) <= rounding);
}

TEST(ConditionNumber, IsRoot3AtTheBestPlateAndAngles) {
  // The angles have four digits: their effect on the condition is below 1e-3.
  EXPECT_NEAR(condition_number(best().generator), std::sqrt(3), 1e-3);
  EXPECT_NEAR(condition_number(best().analyzer), std::sqrt(3), 1e-3);
}

// A retardance that is as 1/λ, 131.81 degrees at 532 nm, with the angles kept. Computed with an independent prototype.
TEST(ConditionNumber, GrowsAwayFromTheWavelengthOfThePlate) {
  EXPECT_NEAR(condition_of(131.81 * 532 / 351, best_azimuths), 3.9, 0.05);
  EXPECT_NEAR(condition_of(131.81 * 532 / 633, best_azimuths), 2.2, 0.05);
  EXPECT_NEAR(condition_of(131.81 * 532 / 1064, best_azimuths), 7.0, 0.05);
}

TEST(ConditionNumber, IsInfiniteForFewerThanFourIndependentStates) {
  const double infinite = std::numeric_limits<double>::infinity();
  std::vector<Stokes> states = best().generator;
  states[3] = states[2];
  EXPECT_EQ(condition_number(states), infinite);
  states.pop_back();
  EXPECT_EQ(condition_number(states), infinite);
  EXPECT_EQ(condition_number({}), infinite);
  EXPECT_EQ(condition_number(ideal_polarimeter(pi, in_radians({-60, -20, 10, 40, 70})).generator), infinite);
  states = best().generator;
  states[1][2] = nan_value;
  EXPECT_EQ(condition_number(states), infinite);
}

// ---- angles ---------------------------------------------------------------------------------------------------------

// Best four-state conditions, computed with an independent prototype, to its digits.
TEST(OptimalAngles, OfFourStatesHaveTheConditionsOfThePrototype) {
  const std::pair<double, double> facts[] = {{90, 3.27},  {110, 2.23}, {120, 1.94},    {126.9, 1.81},
                                             {140, 1.98}, {150, 2.54}, {131.81, 1.732}};
  for (const auto& [retardance, condition] : facts)
    EXPECT_NEAR(best_condition(retardance, 4), condition, 0.0051) << retardance;
}

// Sabatke et al., Opt. Lett. 25, 802 (2000).
TEST(OptimalAngles, OfFourStatesOfTheBestPlateAreThoseOfSabatke) {
  const std::vector<double> angles = optimal_angles(best_plate, 4);
  ASSERT_EQ(angles.size(), 4U);
  // The plate is given with five digits: 0.005 degrees of it move the angles as much.
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(degrees(angles[k]), degrees(best_azimuths[k]), 0.01);
}

// √3 needs states that are a spherical 2-design: there are some of four and of six points, none of five. √(10/3) is
// what the search finds for five.
TEST(OptimalAngles, OfMoreStatesComeNearRoot3WhereSymmetryLetsThem) {
  EXPECT_NEAR(best_condition(131.81, 6), std::sqrt(3), 1e-4);
  EXPECT_NEAR(best_condition(131.81, 5), std::sqrt(10.0 / 3), 1e-4);
}

TEST(OptimalAngles, RiseSymmetricAboutZeroAndAreTheSameEachTime) {
  for (const int states : {4, 5, 7}) {
    const std::vector<double> angles = optimal_angles(2, states);
    EXPECT_EQ(angles, optimal_angles(2, states));
    ASSERT_EQ(angles.size(), static_cast<std::size_t>(states));
    EXPECT_TRUE(std::is_sorted(angles.begin(), angles.end()));
    for (std::size_t k = 0; k < angles.size(); ++k) EXPECT_EQ(angles[k], -angles[angles.size() - 1 - k]);
    EXPECT_LE(angles.back(), pi / 2);
  }
}

TEST(OptimalAngles, RefusePlatesAndNumbersOfStatesWithoutAny) {
  EXPECT_EQ(message_of([] { optimal_angles(2, 3); }), "3 states are not in 4...16");
  EXPECT_THROW(optimal_angles(2, 17), std::invalid_argument);
  EXPECT_EQ(message_of([] { optimal_angles(pi, 4); }), "a retardance of 180 degrees makes no four independent states");
  EXPECT_THROW(optimal_angles(0, 4), std::invalid_argument);
  EXPECT_THROW(optimal_angles(nan_value, 4), std::invalid_argument);
}

// ---- readings and their reduction -----------------------------------------------------------------------------------

TEST(Readings, StandInRowsOfAnAnalysisState) {
  const Polarimeter p = overdetermined();
  const std::vector<double> b = readings(p, example);
  ASSERT_EQ(b.size(), 30U);
  const Stokes out = example * p.generator[4];
  double reading = 0;
  for (std::size_t k = 0; k < 4; ++k) reading += p.analyzer[2][k] * out[k];
  EXPECT_NEAR(b[2 * 6 + 4], reading, 1e-15);  // one rounding
}

TEST(ReadingNoise, AddsItsThreeVariances) {
  EXPECT_DOUBLE_EQ(variance({0.3, 0, 0}, 5), 0.09);
  EXPECT_DOUBLE_EQ(variance({0, 0.2, 0}, -5), 1);
  EXPECT_DOUBLE_EQ(variance({0, 0, 0.1}, -5), 0.25);
  EXPECT_DOUBLE_EQ(variance({0.3, 0.2, 0.1}, 5), 1.34);
}

RC_GTEST_PROP(Reduction, OfTheReadingsOfAMatrixIsTheMatrix, ()) {
  const Mueller m = random_mueller();
  for (const Polarimeter& p : {best(), overdetermined()})
    RC_ASSERT(largest(Reduction(p).mueller(readings(p, m)) - m) <= rounding);
}

// A unit beam at the best angles, the same σ in each reading.
TEST(Reduction, SpreadsTheNoiseOfReadingsAsThePrototype) {
  const double sigma = 0.01;
  const MuellerCovariance c = Reduction(best()).from_readings(std::vector<double>(16, sigma * sigma));
  for (std::size_t e = 0; e < 16; ++e) {
    const int sides = (e / 4 > 0) + (e % 4 > 0);
    const double expected = sides == 0 ? 0.25 : sides == 1 ? 0.75 : 2.25;
    EXPECT_NEAR(c(e, e) / (sigma * sigma), expected, 2e-3) << e;  // angles of four digits
  }
}

TEST(Reduction, HasTheCovarianceOfMonteCarloDrawsOfReadings) {
  const Polarimeter p = overdetermined();
  const Reduction reduction(p);
  const std::vector<double> exact = readings(p, example);
  std::vector<double> variances;
  for (const double b : exact) variances.push_back(variance({1e-3, 1e-6, 1e-2}, b));
  const MuellerCovariance predicted = reduction.from_readings(variances);
  constexpr int draws = 20000;
  std::mt19937_64 engine(1);
  std::normal_distribution<double> normal;
  MuellerCovariance seen;
  for (int draw = 0; draw < draws; ++draw) {
    std::vector<double> b = exact;
    for (std::size_t k = 0; k < b.size(); ++k) b[k] += std::sqrt(variances[k]) * normal(engine);
    const Mueller error = reduction.mueller(b) - example;
    for (std::size_t e = 0; e < 16; ++e)
      for (std::size_t o = 0; o < 16; ++o) seen(e, o) += error.elements[e] * error.elements[o] / draws;
  }
  // The variance of a product of two normal errors is at most 2 (σ σ')²: five standard deviations of the mean.
  for (std::size_t e = 0; e < 16; ++e)
    for (std::size_t o = 0; o < 16; ++o)
      EXPECT_NEAR(seen(e, o), predicted(e, o), 5 * std::sqrt(2.0 / draws * predicted(e, e) * predicted(o, o)));
}

// The matrix that readings of the true instrument give in a reduction by another one, by central differences.
TEST(Reduction, HasSlopesThatAreFiniteDifferences) {
  const double step = 1e-5;  // its square times third derivatives of order 10: 1e-9
  for (const Polarimeter& p : {best(), overdetermined()}) {
    const std::vector<double> b = readings(p, example), slopes = Reduction(p).slopes(example);
    const std::size_t count = components(p);
    ASSERT_EQ(slopes.size(), 16 * count);
    for (std::size_t k = 0; k < count; ++k) {
      Polarimeter above = p, below = p;
      component(above, k) += step;
      component(below, k) -= step;
      const Mueller rise = Reduction(above).mueller(b) - Reduction(below).mueller(b);
      for (std::size_t e = 0; e < 16; ++e)
        EXPECT_NEAR(rise.elements[e] / (2 * step), slopes[e * count + k], 1e-8) << e << " over " << k;
    }
  }
}

TEST(Reduction, HasTheCovarianceOfTheInstrumentByItsSlopes) {
  const Polarimeter p = overdetermined();
  const std::size_t count = components(p);
  const std::vector<double> given = some_covariance(count, 1e-3);
  const Reduction reduction(p, given);
  const std::vector<double> slopes = reduction.slopes(example);
  const MuellerCovariance c = reduction.from_instrument(example);
  for (std::size_t e = 0; e < 16; ++e)
    for (std::size_t o = 0; o < 16; ++o) {
      double sum = 0;
      for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < count; ++k)
          sum += slopes[e * count + i] * given[i * count + k] * slopes[o * count + k];
      EXPECT_NEAR(c(e, o), sum, 1e-18);  // rounding of some 1e-5
    }
  EXPECT_EQ(Reduction(p).from_instrument(example).values, MuellerCovariance{}.values);
}

TEST(Reduction, RefusesAnInstrumentThatIsNone) {
  const auto refusal = [](const std::function<void(Polarimeter&)>& spoil) {
    Polarimeter p = best();
    spoil(p);
    return message_of([&] { Reduction{p}; });
  };
  EXPECT_EQ(refusal([](Polarimeter& p) { p.generator.clear(); }), "generator: no states");
  EXPECT_EQ(refusal([](Polarimeter& p) {
              p.pairs = {{0, 4}};
            }),
            "generator state 1, analyzer state 5: the instrument has 4 generator and 4 analyzer states");
  EXPECT_EQ(refusal([](Polarimeter& p) { p.analyzer[0][2] = nan_value; }), "analyzer: a state is not finite");
}

// Elements of the fourth row or column need circular states; three linear ones determine the nine others.
TEST(Reduction, OfFewerStatesSaysWhichElementsTheyDetermine) {
  const std::vector<std::string> linear{"s", "p", "+45"}, circular{"s", "p", "+45", "L"}, one{"s"}, none{"u"};
  const auto determined = [](const Polarimeter& p) { return element_names(~Reduction(p).undetermined()); };
  EXPECT_EQ(determined(ideal_polarimeter(linear, linear)), "11, 12, 13, 21, 22, 23, 31, 32 and 33");
  EXPECT_EQ(determined(ideal_polarimeter(circular, linear)), "11, 12, 13, 14, 21, 22, 23, 24, 31, 32, 33 and 34");
  EXPECT_EQ(determined(ideal_polarimeter(none, linear)), "11, 21 and 31");
  EXPECT_EQ(determined(ideal_polarimeter(none, none)), "11");
  EXPECT_EQ(Reduction(ideal_polarimeter(linear, linear)).rank(), 9);
  EXPECT_TRUE(Reduction(ideal_polarimeter(one, one)).undetermined().all());  // 11 + 12 + 21 + 22 alone
  EXPECT_TRUE(Reduction({{Stokes{}}, {Stokes{}}}).undetermined().all());
  const Reduction reduction(ideal_polarimeter(linear, linear));
  const std::vector<double> read = readings(ideal_polarimeter(linear, linear), example);
  const Mueller m = reduction.mueller(read);
  const MuellerCovariance c = reduction.from_readings(std::vector<double>(9, 1e-6));
  for (std::size_t e = 0; e < 16; ++e) {
    if (reduction.undetermined()[e]) {
      EXPECT_TRUE(std::isnan(m.elements[e]) && std::isnan(c(e, e)) && std::isnan(c(e, 0)));
    } else {
      EXPECT_NEAR(m.elements[e], example.elements[e], 1e-15);
      EXPECT_GT(c(e, e), 0);
    }
  }
}

// All pairs of six states: 36 linear and circular combinations.
TEST(Reduction, OfSixStatesOfEachArmIsTheMatrix) {
  const std::vector<std::string> six{"s", "p", "+45", "-45", "L", "R"};
  const Polarimeter p = ideal_polarimeter(six, six);
  EXPECT_NEAR(Reduction(p).condition(), 3, 1e-14);  // 3^(1/2) of each arm
  EXPECT_LE(largest(Reduction(p).mueller(readings(p, example)) - example), 1e-15);
}

TEST(Reduction, LosesNothingToAStateThatIsMuchBrighter) {
  const std::vector<std::string> six{"s", "p", "+45", "-45", "L", "R"};
  Polarimeter p = ideal_polarimeter(six, six);
  for (double& component : p.generator[2]) component *= 1e5;
  EXPECT_TRUE(Reduction(p).undetermined().none());
  EXPECT_EQ(Reduction(p).rank(), 16);
}

// The same solution whether a grid is taken apart into its arms or not, with pairs in any order.
RC_GTEST_PROP(Reduction, OfAGridIsThatOfItsPairs, ()) {
  const Polarimeter grid = best();
  std::vector<StatePair> pairs;
  for (std::size_t j = 0; j < 16; ++j) pairs.push_back(grid.pair((5 * j + 3) % 16));
  const Polarimeter listed = reading(grid, pairs);
  const Mueller m = random_mueller();
  const Reduction a(grid), b(listed);
  RC_ASSERT(largest(a.mueller(readings(grid, m)) - b.mueller(readings(listed, m))) <= 1e-14);
  RC_ASSERT(std::abs(a.condition() / b.condition() - 1) < 1e-12);
  const std::vector<double> variances(16, 1e-6);
  RC_ASSERT(std::abs(a.from_readings(variances)(5, 5) / b.from_readings(variances)(5, 5) - 1) < 1e-12);
}

TEST(Reduction, RefusesACovarianceThatIsNone) {
  const auto refusal = [](const std::vector<double>& covariance) {
    return message_of([&] { Reduction(best(), covariance); });
  };
  std::vector<double> covariance = some_covariance(32, 1e-3);
  EXPECT_EQ(refusal(covariance), "nothing was thrown");
  EXPECT_EQ(refusal({1, 2}), "the covariance of the instrument has 2 numbers, expected 1024");
  covariance[1] *= 2;
  EXPECT_EQ(refusal(covariance), "the covariance of the instrument is not symmetric and finite");
  covariance[1] = covariance[32] = 2e-6;  // a correlation of 2
  EXPECT_NE(refusal(covariance), "nothing was thrown");
  covariance.assign(covariance.size(), 1e308);  // eigenvalues overflow
  EXPECT_NE(refusal(covariance), "nothing was thrown");
}

TEST(Reduction, RefusesReadingsAndVariancesThatAreNone) {
  const Reduction reduction(best());
  std::vector<double> values(16, 0.1);
  values[7] = nan_value;
  EXPECT_EQ(message_of([&] { reduction.mueller(values); }), "a reading is not finite");
  EXPECT_THROW(reduction.from_readings(values), std::invalid_argument);
  values[7] = -0.1;
  EXPECT_EQ(message_of([&] { reduction.from_readings(values); }), "variance -0.1, must be finite and not negative");
  values.pop_back();
  EXPECT_EQ(message_of([&] { reduction.mueller(values); }), "15 readings, the instrument has 16");
  EXPECT_EQ(message_of([&] { reduction.from_readings(values); }), "15 variances, the instrument has 16 readings");
}

// ---- samples --------------------------------------------------------------------------------------------------------

TEST(Normalized, CovarianceIsThatOfQuotientsByFiniteDifferences) {
  const MuellerCovariance given = Reduction(best()).from_readings(std::vector<double>(16, 1e-6));
  const MuellerCovariance c = normalized(given, example);
  const double step = 1e-5;
  std::array<Mueller, 16> slope;
  for (std::size_t k = 0; k < 16; ++k) {
    Mueller above = example, below = example;
    above.elements[k] += step;
    below.elements[k] -= step;
    slope[k] = (1 / (2 * step)) * (normalized(above) - normalized(below));
    slope[k](0, 0) = k == 0 ? 1 : 0;  // f11 itself
  }
  for (std::size_t e = 0; e < 16; ++e)
    for (std::size_t o = 0; o < 16; ++o) {
      double sum = 0;
      for (std::size_t i = 0; i < 16; ++i)
        for (std::size_t k = 0; k < 16; ++k) sum += slope[i].elements[e] * given(i, k) * slope[k].elements[o];
      EXPECT_NEAR(c(e, o), sum, 1e-14);  // variances of 1e-6, slopes to 1e-9
    }
  EXPECT_EQ(message_of([&] { normalized(given, Mueller{}); }), "M11 = 0, must be positive");
}

RC_GTEST_PROP(Sample, OfAMatrixIsItsBrdfInTheXyFrame, ()) {
  Mueller m = random_mueller();
  m(0, 0) = between(0.1, 1);
  const Geometry g{{between(0, 1.5), between(-pi, pi)}, {between(0, 1.5), between(-pi, pi)}};
  const double solid_angle = between(1e-5, 1e-2);
  const Sample s = sample(m, 0.532, g, solid_angle);
  RC_ASSERT(s.wavelength == 0.532 && s.geometry == g && !has_uncertainty(s));
  const double f11 = m(0, 0) / (solid_angle * std::cos(g.reflected.theta));
  RC_ASSERT(std::abs(s.f11 / f11 - 1) <= rounding);
  RC_ASSERT(s.normalized(0, 0) == 1);
  const Mueller back = change_frame(s.normalized, g, Frame::xy, Frame::scattering_plane);
  RC_ASSERT(largest(back - normalized(m)) <= 10 * frame_error * largest(normalized(m)));
}

// A perfect diffuser, f = 1/π, sends Ω cos θr / π into the receiver.
TEST(Sample, OfAPerfectDiffuserIsOneByPi) {
  const double solid_angle = 1.114e-4, theta_r = radians(60);
  Mueller m;
  m(0, 0) = solid_angle * std::cos(theta_r) / pi;
  const Sample s = sample(m, 0.633, {{0.3, 0}, {theta_r, 2}}, solid_angle);
  EXPECT_DOUBLE_EQ(s.f11, 1 / pi);
  EXPECT_EQ(s.normalized, diagonal(1, 0, 0, 0));
}

TEST(Sample, IsNotMadeOfWhatIsNone) {
  const Geometry g{{0.3, 0}, {0.5, 2}};
  EXPECT_EQ(message_of([&] { sample(example, 0.5, g, 0); }), "a solid angle of 0 sr, must be above 0 and at most 2 pi");
  EXPECT_EQ(message_of([&] { sample(example, 0.5, g, 6.3); }),
            "a solid angle of 6.3 sr, must be above 0 and at most 2 pi");
  EXPECT_THROW(sample(example, 0.5, g, nan_value), std::invalid_argument);
  EXPECT_EQ(message_of([&] { sample(Mueller{}, 0.5, g, 1e-4); }), "M11 = 0, must be positive");
  EXPECT_EQ(message_of([&] { sample(example, 0.5, {{0.3, 0}, {pi / 2, 2}}, 1e-4); }), "theta_r is 90 degrees");
  EXPECT_THROW(sample(example, 0.5, {{0.3, 0}, {2, 2}}, 1e-4), std::invalid_argument);
}

}  // namespace mmbrdf
