// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarimetry/goniometer.hpp"
#include "mmbrdf/polarimetry/reduction.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "given/cases.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/model/prepared.hpp"

using namespace mmbrdf;

namespace {

GoniometerOptions silent() {
  GoniometerOptions options;
  options.gain_change = 0;
  options.noise = {};
  return options;
}

const std::array<Geometry, 3> geometries{{{{0.7, 0}, {0.5, 3.1}}, {{0.2, 1}, {1.2, 2}}, {{0, 0}, {0.3, 0.4}}}};

}  // namespace

TEST(Goniometer, WithoutImperfectionsIsTheIdealPolarimeter) {
  GoniometerOptions options = silent();
  options.imperfections = {0, 0, 0, 0, 0, 0};
  const Goniometer goniometer(options, 1);
  const Polarimeter ideal = ideal_polarimeter(options.retardance, optimal_angles(options.retardance, 4));
  for (std::size_t s = 0; s < 4; ++s)
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(goniometer.polarimeter().generator[s][k], ideal.generator[s][k], 1e-14);  // rounding
      EXPECT_NEAR(goniometer.polarimeter().analyzer[s][k], ideal.analyzer[s][k], 1e-14);
    }
}

TEST(Goniometer, IsAnotherForAnotherSeedAndStillWellConditioned) {
  const Polarimeter a = Goniometer(silent(), 1).polarimeter(), b = Goniometer(silent(), 2).polarimeter(),
                    again = Goniometer(silent(), 1).polarimeter();
  EXPECT_EQ(a.generator, again.generator);
  EXPECT_NE(a.generator, b.generator);
  EXPECT_NE(a.analyzer, b.analyzer);
  for (const Polarimeter& p : {a, b}) EXPECT_LT(condition_number(p.generator), 2.5);
}

// The first draws of the imperfections, of references and of readings once were the same numbers.
TEST(Goniometer, DrawsImperfectionsReferencesAndReadingsApart) {
  GoniometerOptions options = silent();
  options.imperfections = {radians(3), 0, 0, 0, 0, 0};
  options.noise.relative = 1e-3;
  constexpr int seeds = 200;
  std::array<std::vector<double>, 3> draws;
  for (unsigned long seed = 0; seed < seeds; ++seed) {
    const Goniometer goniometer(options, seed);
    const Polarimeter& p = goniometer.polarimeter();
    const double exact = readings(p, identity())[0];
    draws[0].push_back(p.generator[0][3]);  // falls with the retardance
    draws[1].push_back(goniometer.references(0.532, 1, seed)[0].readings[0] / exact);
    draws[2].push_back(goniometer.readings(identity(), seed)[0] / exact);
  }
  const auto covariance = [&](std::size_t a, std::size_t b) {
    double sum = 0, mean_a = 0, mean_b = 0;
    for (std::size_t k = 0; k < seeds; ++k) {
      mean_a += draws[a][k] / seeds;
      mean_b += draws[b][k] / seeds;
      sum += draws[a][k] * draws[b][k] / seeds;
    }
    return sum - mean_a * mean_b;
  };
  for (const auto& [a, b] : {std::pair<std::size_t, std::size_t>(0, 1), {0, 2}, {1, 2}})
    EXPECT_LT(std::abs(covariance(a, b)), 4 / std::sqrt(1. * seeds) * std::sqrt(covariance(a, a) * covariance(b, b)))
        << a << b;
}

// Factors of any size that a law of noise allows: positive, with mean 1 and the deviation that is said.
TEST(Goniometer, ReadsNothingNegativeHoweverLargeItsRelativeNoise) {
  GoniometerOptions options = silent();
  options.noise.relative = 0.3;
  options.speckle = most_noise;
  const Goniometer goniometer(options, 6);
  const PreparedModel model = prepare(material("ptfe-532"), 0.532);
  const std::vector<Geometry> same(2000, Geometry{{radians(60), 0}, {radians(60), 2}});
  const auto noisy = goniometer.readings(model, same, 7);
  const auto exact = Goniometer(silent(), 6).readings(model, std::span(same).first(1), 7)[0];
  double sum = 0, squares = 0;
  for (const std::vector<double>& one : noisy)
    for (std::size_t r = 0; r < 16; ++r) {
      EXPECT_GT(one[r], 0);
      sum += one[r] / exact[r] / 32000;
      squares += std::pow(one[r] / exact[r], 2) / 32000;
    }
  EXPECT_NEAR(sum, 1, 4 * std::sqrt(1.18 / 32000));  // of the product, (1 + 1) (1 + 0.09) − 1
  EXPECT_NEAR(squares, 2 * 1.09, 0.2);               // fourth moments of lognormal factors are 2⁶ and more
}

TEST(Goniometer, ReadsNothingNegativeWithoutAdditiveNoise) {
  for (unsigned long seed = 0; seed < 40; ++seed)
    for (const Reference& reference : Goniometer({}, seed).references(0.532, 18, seed))
      for (const double reading : reference.readings) EXPECT_GE(reading, 0) << seed;
}

TEST(Goniometer, ReadsWafersAtThirtyToSeventyFiveDegreesAndPolarizersAllRound) {
  const std::vector<Reference> references = Goniometer(silent(), 3).references(0.532, 4, 1);
  std::vector<double> angles;
  for (const Reference& reference : references) angles.push_back(degrees(reference.angle));
  const std::vector<double> expected{0, 0, 0, 0, 0, 45, 90, 135, 30, 45, 60, 75};
  ASSERT_EQ(angles.size(), expected.size());
  for (std::size_t i = 0; i < angles.size(); ++i) EXPECT_NEAR(angles[i], expected[i], 1e-12) << i;
  EXPECT_NEAR(degrees(Goniometer(silent(), 3).references(0.532, 1, 1)[2].angle), 30, 1e-12);
}

TEST(Goniometer, ReadsNothingAtNinetyDegrees) {
  const PreparedModel model = prepare(material("ptfe-532"), 0.532);
  const auto read = [&](double theta_r_deg) {
    const std::vector<Geometry> one{{{radians(30), 0}, {radians(theta_r_deg), std::numbers::pi}}};
    return Goniometer(silent(), 3).readings(model, one, 1);
  };
  for (const double theta_r_deg : {90.0, 89.9999999999}) EXPECT_THROW(read(theta_r_deg), std::invalid_argument);
  EXPECT_NO_THROW(read(89.9));
}

// The whole way back: readings of a model without noise, reduced with the true instrument, are its matrices.
TEST(Goniometer, ReadingsOfAModelReduceToItsSamples) {
  const Goniometer goniometer(silent(), 3);
  const PreparedModel model = prepare(material("ptfe-532"), 0.532);
  const Reduction reduction(goniometer.polarimeter());
  const auto all = goniometer.readings(model, geometries, 4);
  for (std::size_t g = 0; g < geometries.size(); ++g) {
    const Sample found = sample(reduction.mueller(all[g]), 0.532, geometries[g], goniometer.options().solid_angle);
    const Mueller expected = model.evaluate(geometries[g]);
    EXPECT_NEAR(found.f11, expected(0, 0), 1e-13);  // rounding, times condition numbers
    for (std::size_t e = 0; e < 16; ++e)
      EXPECT_NEAR(found.normalized.elements[e], normalized(expected).elements[e], 1e-13) << g << ' ' << e;
  }
}

TEST(Goniometer, HasTheNoiseThatItsOptionsSay) {
  GoniometerOptions options = silent();
  options.noise.relative = 1e-3;
  const Goniometer goniometer(options, 5);
  const std::vector<double> exact = readings(goniometer.polarimeter(), identity());
  double sum = 0;
  constexpr int repetitions = 500;
  for (unsigned long seed = 0; seed < repetitions; ++seed) {
    const std::vector<double> noisy = goniometer.readings(identity(), seed);
    for (std::size_t r = 0; r < 16; ++r) sum += std::pow((noisy[r] / exact[r] - 1) / 1e-3, 2);
  }
  EXPECT_NEAR(sum / (16 * repetitions), 1, 4 * std::sqrt(2. / (16 * repetitions)));
}

// Speckle is √(cos θi / cos θr) times what it is at the normal.
TEST(Goniometer, HasTheSpeckleOfItsGeometry) {
  GoniometerOptions options = silent();
  options.speckle = 0.01;
  const Goniometer goniometer(options, 6);
  const PreparedModel model = prepare(material("ptfe-532"), 0.532);
  const std::vector<Geometry> same(500, Geometry{{radians(60), 0}, {radians(75), 2}});
  const auto noisy = goniometer.readings(model, same, 7);
  const auto exact = Goniometer(silent(), 6).readings(model, same, 7);
  double sum = 0;
  for (std::size_t g = 0; g < same.size(); ++g)
    for (std::size_t r = 0; r < 16; ++r) sum += std::pow(noisy[g][r] / exact[g][r] - 1, 2);
  const double expected = 1e-4 * 0.5 / std::cos(radians(75));
  EXPECT_NEAR(sum / 8000 / expected, 1, 4 * std::sqrt(2. / 8000));
}

TEST(Goniometer, DriftRunsThroughAMeasurement) {
  GoniometerOptions options = silent();
  options.drift = 0.16;
  const std::vector<double> drifting = Goniometer(options, 8).readings(identity(), 9),
                            still = Goniometer(silent(), 8).readings(identity(), 9);
  for (int r = 0; r < 16; ++r)
    EXPECT_NEAR(drifting[static_cast<std::size_t>(r)] / still[static_cast<std::size_t>(r)], 1 + 0.01 * (r - 7.5),
                1e-14);
}

TEST(Goniometer, ChangesItsGainBetweenReferences) {
  GoniometerOptions options = silent();
  options.gain_change = 0.02;
  const auto changed = Goniometer(options, 8).references(0.532, 18, 9),
             same = Goniometer(silent(), 8).references(0.532, 18, 9);
  ASSERT_EQ(changed.size(), 54U);
  const double gain = changed[20].readings[0] / same[20].readings[0];
  EXPECT_GT(std::abs(gain - 1), 1e-4);
  for (std::size_t r = 0; r < 16; ++r) EXPECT_NEAR(changed[20].readings[r] / same[20].readings[r], gain, 1e-12);
}

TEST(Goniometer, RefusesWhatItCannotBe) {
  GoniometerOptions options;
  options.noise.dark = -1;
  EXPECT_THROW(Goniometer(options, 1), std::invalid_argument);
  for (double GoniometerOptions::*const relative : {&GoniometerOptions::speckle, &GoniometerOptions::gain_change}) {
    options = {};
    options.*relative = 1.001;
    EXPECT_EQ(message_of([&] { Goniometer(options, 1); }), "relative noise of 1.001, at most 1");
  }
  options = {};
  options.noise.relative = 1e300;
  EXPECT_THROW(Goniometer(options, 1), std::invalid_argument);
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double bad : {-1e-9, infinite, std::nan("")}) {
    options = {};
    options.imperfections.stray = bad;
    EXPECT_TRUE(
        message_of([&] { Goniometer(options, 1); }).ends_with(" where a number that is not negative is needed"));
  }
  for (double GoniometerOptions::*const any_sign :
       {&GoniometerOptions::retardance, &GoniometerOptions::polarizer_offset, &GoniometerOptions::drift}) {
    options = {};
    options.*any_sign = -infinite;
    EXPECT_EQ(message_of([&] { Goniometer(options, 1); }), "an option is not finite");
  }
  options = {};
  options.solid_angle = 0;
  EXPECT_THROW(Goniometer(options, 1), std::invalid_argument);
  const Goniometer goniometer({}, 1);
  EXPECT_THROW(goniometer.references(0.532, 0, 1), std::invalid_argument);
  const std::array<Geometry, 1> grazing{{{{0.5, 0}, {radians(90), 0}}}};
  EXPECT_THROW(goniometer.readings(prepare(material("ptfe-532"), 0.532), grazing, 1), std::invalid_argument);
}
