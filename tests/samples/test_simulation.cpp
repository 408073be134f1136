// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/samples/simulation.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "given/cases.hpp"

using namespace mmbrdf;

namespace {

/// A smooth model that depends on everything: f11 close to 1/π, polarization up to some hundredths.
Model small_model() {
  Model model;
  model.powers = 1;
  for (const Block& block : blocks(Family::isotropic, Orders{2, 2})) {
    FittedBlock fitted{block, {}, {}, 0, 0};
    for (std::size_t i = 0; i < 2 * block.modes.size(); ++i)
      fitted.coefficients.push_back(0.05 * std::cos(1.7 * static_cast<double>(i + model.blocks.size())));
    if (block.name == "11") fitted.coefficients.front() = 2;  // of K_0^0 K_0^0 = 1/2π
    model.blocks.push_back(fitted);
  }
  return model;
}

const std::vector<double> two_wavelengths{0.6, 0.5};

bool equal(const Sample& a, const Sample& b) {
  return a.wavelength == b.wavelength && a.geometry == b.geometry && a.f11 == b.f11 && a.normalized == b.normalized;
}

/// What noise did to one element, in units of its standard deviation, at many repetitions of a geometry.
struct Deviations {
  std::vector<double> f11, m14, m33;
};

Deviations deviations(const Geometry& geometry, int count, double speckle) {
  const Model model = small_model();
  const std::vector<Geometry> geometries(static_cast<std::size_t>(count), geometry);
  const std::vector<double> wavelength{0.5};
  const Sample exact = simulate(model, wavelength, {&geometry, 1}).front();
  Deviations result;
  for (const Sample& sample : simulate(model, wavelength, geometries, speckle, 5)) {
    result.f11.push_back((sample.f11 / exact.f11 - 1) / speckle);
    result.m14.push_back((sample.normalized(0, 3) - exact.normalized(0, 3)) / speckle);
    result.m33.push_back((sample.normalized(2, 2) - exact.normalized(2, 2)) / speckle);
  }
  return result;
}

double mean_product(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum / static_cast<double>(a.size());
}

}  // namespace

TEST(Simulation, WithoutNoiseGivesTheValuesOfTheModelWavelengthByWavelength) {
  const std::vector<Geometry> geometries = random_geometries(20, 3);
  const std::vector<Sample> samples = simulate(small_model(), two_wavelengths, geometries);
  ASSERT_EQ(samples.size(), 40U);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Sample& sample = samples[i];
    EXPECT_EQ(sample.wavelength, two_wavelengths[i / 20]);
    EXPECT_EQ(sample.geometry, geometries[i % 20]);
    const Mueller m = prepare(small_model(), sample.wavelength).evaluate(sample.geometry);
    EXPECT_EQ(sample.f11, m(0, 0));
    EXPECT_EQ(sample.normalized, normalized(m));
  }
  EXPECT_FALSE(samples[0].normalized == samples[20].normalized);
}

TEST(Simulation, OfTheSameSeedIsTheSame) {
  const std::vector<Geometry> geometries = random_geometries(20, 3);
  const auto simulated = [&](unsigned long seed) {
    return simulate(small_model(), two_wavelengths, geometries, 0.01, seed);
  };
  const std::vector<Sample> first = simulated(1), again = simulated(1), other = simulated(2);
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_TRUE(equal(first[i], again[i]));
    EXPECT_FALSE(equal(first[i], other[i]));
  }
}

TEST(Simulation, KeepsElement11AtOne) {
  for (const Sample& sample : simulate(small_model(), two_wavelengths, random_geometries(20, 3), 0.01))
    EXPECT_EQ(sample.normalized(0, 0), 1);
}

TEST(Simulation, HasNoiseOfTheSpeckleLaw) {
  const int count = 20000;
  for (const auto& [theta_i, theta_r, expected] :
       {std::array{0.0, 60.0, std::numbers::sqrt2},  // √(1 / ½)
        std::array{60.0, 0.0, 1 / std::numbers::sqrt2}, std::array{40.0, 40.0, 1.0}}) {
    const Deviations d = deviations({{radians(theta_i), 0}, {radians(theta_r), 2}}, count, 0.01);
    // A variance from n numbers is off by √(2/n) of itself: five times that.
    const double variance = expected * expected, off = 5 * variance * std::sqrt(2.0 / count);
    EXPECT_NEAR(mean_product(d.f11, d.f11), variance, off);
    EXPECT_NEAR(mean_product(d.m14, d.m14), variance, off);
    EXPECT_NEAR(mean_product(d.m33, d.m33), variance, off);
  }
}

TEST(Simulation, HasGaussianNoiseWithoutMeanAndIndependentForEachElement) {
  const int count = 20000;
  const Deviations d = deviations({{0.5, 0}, {0.5, 2}}, count, 0.01);
  const std::vector<double> ones(d.f11.size(), 1);
  const double off = 5 / std::sqrt(count);  // five standard deviations of the mean of numbers of variance 1
  for (const auto* values : {&d.f11, &d.m14, &d.m33}) {
    EXPECT_NEAR(mean_product(*values, ones), 0, off);
    int inside = 0;
    for (double value : *values) inside += std::abs(value) < 1;
    EXPECT_NEAR(inside / static_cast<double>(count), 0.6827, off);
  }
  EXPECT_NEAR(mean_product(d.f11, d.m14), 0, off);
  EXPECT_NEAR(mean_product(d.m14, d.m33), 0, off);
}

TEST(Simulation, NoiseIsNotMadeOfTheNumbersThatTheGeometriesOfThatSeedWereMadeOf) {
  const std::vector<Geometry> geometries = random_geometries(1, 1);
  const std::vector<double> wavelength{0.5};
  const double exact = simulate(small_model(), wavelength, geometries).front().f11;
  const double noise = (simulate(small_model(), wavelength, geometries, 1, 1).front().f11 / exact - 1);
  const Direction& from = geometries[0].incident;  // of the first two numbers of the seed
  const double first = std::pow(std::sin(from.theta) / std::sin(radians(75)), 2),
               second = from.phi / (2 * std::numbers::pi) + 0.5;
  const double made_of_them = std::sqrt(-2 * std::log(1 - first)) * std::cos(2 * std::numbers::pi * second) *
                              std::sqrt(std::cos(from.theta) / std::cos(geometries[0].reflected.theta));
  EXPECT_GT(std::abs(noise - made_of_them), 1e-6);
}

TEST(Simulation, OfNothingIsEmpty) {
  EXPECT_TRUE(simulate(small_model(), {}, random_geometries(3, 1)).empty());
  EXPECT_TRUE(simulate(small_model(), two_wavelengths, {}).empty());
}

TEST(Simulation, RefusesWhatIsInvalid) {
  const std::vector<Geometry> good = random_geometries(2, 1);
  const std::vector<Geometry> below{{{radians(95), 0}, {0, 0}}};
  EXPECT_EQ(message_of([&] { simulate(small_model(), two_wavelengths, below); }),
            "theta_i = 95 degrees, must be in 0...90");
  EXPECT_EQ(message_of([&] { simulate(small_model(), two_wavelengths, good, -0.5); }),
            "speckle = -0.5, must be finite and not negative");
  EXPECT_THROW(simulate(small_model(), two_wavelengths, good, std::numeric_limits<double>::quiet_NaN()),
               std::invalid_argument);
  EXPECT_THROW(simulate(small_model(), std::vector<double>{0}, good), std::invalid_argument);
  Model broken = small_model();
  broken.blocks.front().coefficients.pop_back();
  EXPECT_THROW(simulate(broken, {}, {}), std::invalid_argument);
}

TEST(Simulation, AtAGrazingDetectorHasNoNoise) {
  const std::vector<Geometry> grazing{{{0.1, 0}, {radians(90), 1}}};
  EXPECT_EQ(simulate(small_model(), two_wavelengths, grazing).size(), 2U);
  EXPECT_EQ(message_of([&] { simulate(small_model(), two_wavelengths, grazing, 0.01); }),
            "theta_r = 90 degrees, where the speckle noise is infinite");
}

TEST(Simulation, OfAModelThatIsNotPositiveIsRefused) {
  Model dark = small_model();
  for (double& coefficient : dark.blocks.front().coefficients) coefficient = 0;
  const std::vector<Geometry> geometries{{{radians(30), 0}, {radians(45), 1}}};
  EXPECT_EQ(message_of([&] { simulate(dark, std::vector<double>{0.5}, geometries); }),
            "f11 = 0 /sr at theta_i = 30, theta_r = 45 degrees, must be positive");
}
