// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/samples/comparison.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "given/cases.hpp"
#include "given/not_measured.hpp"
#include "given/published.hpp"
#include "given/random_model.hpp"
#include "mmbrdf/files/coefficients_file.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/files/samples_file.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/samples/simulation.hpp"

namespace mmbrdf {
namespace {

const std::vector<double> green{0.532};

std::vector<Sample> simulated(const Model& model, int count) {
  return simulate(model, green, random_geometries(count, 3));
}

TEST(Comparison, OfSamplesIsThatOfAModelThatHasTheFirst) {
  const Model model = material("ptfe-532");
  std::vector<Sample> samples = simulated(model, 100);
  const std::vector<Sample> first = samples;
  samples[17].f11 *= 1.5;
  samples[42].normalized(2, 1) -= 0.25;
  const Comparison pairs = compare(first, samples), of_model = compare(model, samples);
  EXPECT_EQ(pairs.samples, 100);
  EXPECT_NEAR(pairs.f11_relative.rms, of_model.f11_relative.rms, 1e-14);
  EXPECT_NEAR(polarization_rms(pairs), polarization_rms(of_model), 1e-14);
  EXPECT_EQ(largest(pairs).geometry, samples[17].geometry);
  EXPECT_THROW(compare(std::span(first).first(3), samples), std::invalid_argument);
}

/// Fitted to 50 degrees of the detector.
Model fitted_to_50_degrees() {
  Model result = material("ptfe-532");
  result.validity.theta_r_max = radians(50);
  return result;
}

const Geometry inner{{0.8, 0}, {0.8, 0}}, outer{{0.8, 0}, {1.0, 0}};

TEST(Comparison, LeavesOutWhatIsBeyondTheFit) {
  const std::vector<Sample> all = simulate(material("ptfe-532"), green, std::vector{inner, outer});
  std::vector<Sample> samples = all;
  EXPECT_EQ(leave_out_beyond(fitted_to_50_degrees(), samples), 1U);
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_EQ(samples[0].geometry, inner);
  Model unknown = fitted_to_50_degrees();
  unknown.validity = {};
  EXPECT_EQ(leave_out_beyond(unknown, samples = all), 0U);
}

// Files give degrees: 57.295779513 of them are a little more than a radian.
TEST(Comparison, GoesAsFarAsItIsSaidWhereverTheFitEnds) {
  const std::vector<Sample> all = simulate(material("ptfe-532"), green, std::vector{inner, outer});
  std::vector<Sample> samples = all;
  for (const double theta_max : {radians(90), 1.0, 1 - 1e-12}) {
    EXPECT_EQ(leave_out_beyond(fitted_to_50_degrees(), samples = all, theta_max), 0U);
    EXPECT_EQ(leave_out_beyond(theta_max, samples = all), 0U);
  }
  EXPECT_EQ(leave_out_beyond(fitted_to_50_degrees(), samples = all, 0.9), 1U);
  EXPECT_EQ(leave_out_beyond(0.9, samples = all), 1U);
  EXPECT_EQ(samples[0].geometry, inner);
}

TEST(Comparison, OfModelsIsWhereBothWereFitted) {
  const Model wide = material("ptfe-532"), narrow = fitted_to_50_degrees();
  for (const auto& [first, second] : {std::pair(wide, narrow), std::pair(narrow, wide)}) {
    const std::vector<Sample> samples = samples_to_compare(first, second, green, std::vector{inner, outer});
    ASSERT_EQ(samples.size(), 1U);
    EXPECT_EQ(samples[0].geometry, inner);
    EXPECT_EQ(samples[0].f11, simulate(second, green, std::vector{inner})[0].f11);
    EXPECT_EQ(samples_to_compare(first, second, green, std::vector{inner, outer}, radians(90)).size(), 2U);
  }
}

// At 633 nm there are no samples of directions beyond 30 degrees; the angles of the validity are those of all wavelengths.
TEST(Comparison, OfModelsLeavesOutADirectionAtTheWavelengthsAtWhichItWasNotFitted) {
  const std::vector<double> both{0.532, 0.633};
  std::vector<Sample> samples = simulate(material("ptfe"), both, random_geometries(600, 1, radians(80)), 0.01);
  std::erase_if(samples, [](const Sample& s) {
    return s.wavelength > 0.6 && std::max(s.geometry.incident.theta, s.geometry.reflected.theta) > radians(30);
  });
  const Model narrow = fit(samples, {.orders = {3, 2}}).model;
  const std::vector<Sample> found =
      samples_to_compare(narrow, material("ptfe"), both, std::vector{Geometry{{0.3, 0}, {0.3, 2}}, inner});
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[1].geometry, inner);
  EXPECT_EQ(found[2].wavelength, 0.633);
}

TEST(Comparison, FindsWhatWasAddedToOneSampleAndWhere) {
  const Model model = material("ptfe-532");
  std::vector<Sample> samples = simulated(model, 100);
  samples[17].f11 *= 1.5;
  samples[42].normalized(2, 1) -= 0.25;
  const Comparison c = compare(model, samples);
  EXPECT_EQ(c.samples, 100);
  // All else is what simulating and comparing round differently.
  constexpr double rounding = 1e-15;
  EXPECT_NEAR(c.f11_relative.largest, 0.5, rounding);
  EXPECT_NEAR(c.f11_relative.rms, 0.05, rounding);  // √(0.5² / 100)
  EXPECT_NEAR(c.f11_relative.mean, 0.005, rounding);
  EXPECT_NEAR(c.f11.largest, samples[17].f11 / 3, rounding);
  EXPECT_EQ(c.f11.geometry, samples[17].geometry);
  EXPECT_NEAR(c.normalized[9].mean, -0.0025, rounding);  // samples − model, with its sign
  EXPECT_NEAR(c.normalized[9].largest, 0.25, rounding);
  EXPECT_EQ(c.normalized[9].geometry, samples[42].geometry);
  EXPECT_EQ(c.normalized[9].wavelength, 0.532);
  EXPECT_LE(c.normalized[6].largest, rounding);
  EXPECT_NEAR(polarization_rms(c), 0.025 / std::sqrt(15), rounding);
  EXPECT_EQ(largest(c).geometry, samples[17].geometry);
}

TEST(Comparison, MeansTheElementsThatAreKnown) {
  const Model model = material("ptfe-532");
  Elements others = all_but_f11;
  others.reset(5);
  std::vector<Sample> samples = without(others, simulated(model, 20));
  for (Sample& sample : samples) sample.normalized(1, 1) += 0.1;
  EXPECT_NEAR(polarization_rms(compare(model, samples)), 0.1, 1e-15);  // rounding
}

TEST(Comparison, OfWhatIsEqualIsLargestAtTheFirstSample) {
  const std::vector<Sample> samples = simulated(material("ptfe-532"), 5);
  const Comparison equal = compare(samples, samples);
  for (const Difference& one : {equal.f11, equal.f11_relative, equal.normalized[5], largest(equal)}) {
    EXPECT_EQ(one.largest, 0);
    EXPECT_EQ(one.wavelength, 0.532);
    EXPECT_EQ(one.geometry, samples[0].geometry);
  }
}

RC_GTEST_PROP(Comparison, OfTwoModelsTheOtherWayRoundHasTheOtherSign, (unsigned seed)) {
  const Model a = random_model(Family::isotropic, {3, 2}, 1, seed),
              b = random_model(Family::isotropic, {3, 2}, 1, ~seed);
  const std::vector<double> wavelengths{0.4, 0.5};
  const std::vector<Geometry> geometries = random_geometries(20, seed);
  const Comparison ab = compare(a, b, wavelengths, geometries), ba = compare(b, a, wavelengths, geometries);
  RC_ASSERT(ab.samples == 40);
  for (std::size_t e = 1; e < 16; ++e) {
    RC_ASSERT(std::abs(ab.normalized[e].mean + ba.normalized[e].mean) < 1e-14);  // sums of 40 numbers below 10
    RC_ASSERT(std::abs(ab.normalized[e].rms - ba.normalized[e].rms) < 1e-14);
    RC_ASSERT(ab.normalized[e].rms <= ab.normalized[e].largest * (1 + 1e-14));
  }
}

TEST(Comparison, IsAtTheWavelengthsThatBothModelsKnow) {
  const Model all = material("ptfe"), one = material("ptfe-532");
  EXPECT_EQ(common_wavelengths(all, one), std::vector{0.532});
  EXPECT_TRUE(common_wavelengths(material("ptfe-351"), one).empty());
  EXPECT_EQ(common_wavelengths(Model{}, one), std::vector{0.532});
  EXPECT_EQ(common_wavelengths(all, Model{}), all.validity.wavelengths);
}

// An extrapolation, or a sample as dark as its noise.
TEST(Comparison, HasF11AloneWhereTheModelHasNothingToDivideBy) {
  const Model model = material("ptfe-532");
  std::vector<Sample> samples = simulated(model, 40);
  Model dark = model;  // f11 less by that of the first sample, and more: modes of order 0 are 1/π times a constant
  const Geometry normal{};
  const double slope = [&] {
    Model one = model;
    for (double& a : one.blocks.front().coefficients) a = 0;
    one.blocks.front().coefficients.front() = 1;
    return prepare(one, 0.532).f11(normal);
  }();
  const auto brightest = std::ranges::max_element(samples, {}, &Sample::f11);
  dark.blocks.front().coefficients.front() -= 1.0000001 * brightest->f11 / slope;
  EXPECT_EQ(message_of([&] { compare(dark, samples); }), "f11 of the model is positive at none of the samples");
  dark.blocks.front().coefficients.front() += 1e-3 / slope;
  const auto is_dark = [&](const Sample& s) { return prepare(dark, 0.532).f11(s.geometry) <= 0; };
  const Comparison found = compare(dark, samples);
  EXPECT_EQ(found.dark, std::ranges::count_if(samples, is_dark));
  EXPECT_GT(found.dark, 0);
  EXPECT_NEAR(found.f11.mean, brightest->f11 - 1e-3, 1e-6);  // of all samples
  EXPECT_EQ(dark_line(found), "f11 of the model is not positive at " + std::to_string(found.dark) +
                                  " of 40 samples: there f11 alone is compared");
  std::erase_if(samples, is_dark);
  const Comparison bright = compare(dark, samples);
  EXPECT_EQ(bright.normalized[5].rms, found.normalized[5].rms);
  EXPECT_EQ(bright.f11_relative.rms, found.f11_relative.rms);
  EXPECT_EQ(dark_line(bright), "");
}

TEST(Comparison, RefusesWhatHasNoAnswer) {
  const Model model = material("ptfe-532");
  EXPECT_NE(message_of([&] { compare(model, {}); }).find("no samples"), std::string::npos);
  Model negative = model;
  for (double& a : negative.blocks.front().coefficients) a = -a;
  EXPECT_EQ(message_of([&] { compare(negative, simulated(model, 1)); }),
            "f11 of the model is positive at none of the samples");
  std::vector<Sample> huge = simulated(model, 2);
  huge[1].normalized(3, 3) = 1e200;
  EXPECT_NE(message_of([&] { compare(model, huge); }).find("element 44"), std::string::npos);
  huge[1].normalized(3, 3) = std::numeric_limits<double>::infinity();
  EXPECT_NE(message_of([&] { compare(model, huge); }).find("sample 2: m44"), std::string::npos);
  const std::vector<Sample> none, three = simulated(model, 3), two(three.begin(), three.end() - 1);
  EXPECT_EQ(message_of([&] { compare(none, none); }), "no samples");
  EXPECT_EQ(message_of([&] { compare(three, two); }), "samples to compare must be as many");
  EXPECT_EQ(message_of([&] { compare(two, three); }), "samples to compare must be as many");
}

// Theory 2.3: neither model was fitted to the random directions. Printed digits.
TEST(PublishedComparison, WithRandomDirectionsGivesTheKnownResiduals) {
  const std::string file = published("PTFE.data.random.csv");
  if (file.empty()) GTEST_SKIP() << absent("PTFE.data.random.csv");
  const std::vector<Sample> samples = read_samples(file);
  const Model coefficients = read_coefficients(published("PTFE.532.coeff.csv"));
  EXPECT_NEAR(polarization_rms(compare(material("ptfe-532"), samples)), 0.01121, 5e-6);
  EXPECT_NEAR(polarization_rms(compare(coefficients, samples)), 0.01134, 5e-6);
  EXPECT_NEAR(polarization_rms(compare(as_printed(coefficients), samples)), 0.01753, 5e-6);
}

}  // namespace
}  // namespace mmbrdf
