// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/quantities/significance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "given/least_squares.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/polarization/covariance.hpp"
#include "mmbrdf/samples/simulation.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"

namespace mmbrdf {
namespace {

const std::vector<double> green{0.532};

/// A fit to noise of its own; the truth is in the model, so that uncertainties are those of the noise.
Model fitted(unsigned long seed) {
  const Basis basis{.orders = {7, 4}};
  const std::vector<Sample> samples =
      simulate(material("ptfe-532"), green, random_geometries(600, seed, radians(70)), 0.01, seed);
  return fit(samples, basis, {}, Weights::speckle).model;
}

std::array<Significance, 16> between(const Model& first, const Model& second, const std::vector<Geometry>& at) {
  return significance(first, second, simulate(second, green, at));
}

// |d| / u of a normal distribution: 0.798 in the mean, 0.95 within 1.96. 300 directions of one fit are correlated: 142
// coefficients and sixteen elements.
TEST(Significance, OfFitsToTheSameTruthIsThatOfChance) {
  const auto found = between(fitted(1), fitted(2), random_geometries(300, 3, radians(60)));
  double mean = 0, within = 0;
  for (const Significance& s : found) {
    EXPECT_EQ(s.samples, 300);
    EXPECT_GE(s.largest, s.mean);
    mean += s.mean / 16;
    within += s.within / 16;
  }
  EXPECT_NEAR(mean, 0.8, 0.1);
  EXPECT_NEAR(within, 0.95, 0.05);
}

TEST(Significance, OfAModelAndItselfIsNone) {
  const Model model = least_squares("ptfe-532");
  for (const Significance& s : between(model, model, random_geometries(20, 1, radians(70)))) {
    EXPECT_LT(s.largest, 1e-9);
    EXPECT_EQ(s.within, 1);
  }
}

TEST(Significance, IsTheDifferenceOverTheUncertaintiesOfBoth) {
  const Model first = least_squares("ptfe-532"), second = fitted(1);
  const Geometry g{{0.8, 0.1}, {0.5, 2.6}};
  const auto found = between(first, second, {g});
  const Mueller a = prepare(first, 0.532).evaluate(g), b = prepare(second, 0.532).evaluate(g);
  const Mueller u = standard_uncertainty(prepare_uncertainty(first, 0.532).normalized(g)),
                v = standard_uncertainty(prepare_uncertainty(second, 0.532).normalized(g));
  EXPECT_NEAR(found[0].mean, std::abs(b(0, 0) - a(0, 0)) / std::hypot(u(0, 0), v(0, 0)), 1e-6);
  EXPECT_NEAR(found[5].largest, std::abs(normalized(b)(1, 1) - normalized(a)(1, 1)) / std::hypot(u(1, 1), v(1, 1)),
              1e-6);
  EXPECT_EQ(found[5].wavelength, 0.532);
  EXPECT_EQ(found[5].geometry.incident.theta, 0.8);
}

/// Samples of the truth with noise of 1 %, which they know.
std::vector<Sample> measured(unsigned long seed, const std::vector<Geometry>& at) {
  std::vector<Sample> samples = simulate(material("ptfe-532"), green, at, 0.01, seed);
  for (Sample& s : samples)
    for (std::size_t e = 0; e < 16; ++e) s.uncertainty.elements[e] = 0.01 * (e == 0 ? s.f11 : 1);
  return samples;
}

// Of 1000 independent differences: the root mean square of d / u is 1 +- 0.022, and 4.6 +- 0.7 % are beyond 2 u. The noise of
// simulate() has the factor cos θr / cos θi of speckle, so at the same angle of both. Five of these u for sixteen elements.
TEST(Significance, OfTwoMeasurementsIsThatOfTheirNoise) {
  std::vector<Geometry> at = random_geometries(1000, 4, radians(60));
  for (Geometry& g : at) g.reflected.theta = g.incident.theta;
  for (const Significance& s : significance(measured(1, at), measured(2, at))) {
    EXPECT_EQ(s.samples, 1000);
    EXPECT_NEAR(s.rms, 1, 0.11);
    EXPECT_NEAR(s.beyond, 0.046, 0.035);
  }
}

TEST(Significance, OfSamplesCountsTheirUncertaintyAndThatOfTheModelAndTerms) {
  const Model model = least_squares("ptfe-532");
  const Geometry g{{0.8, 0.1}, {0.5, 2.6}};
  const std::vector<Sample> samples = measured(1, {g});
  const std::vector<TypeBTerm> terms{{"plaque", ErrorOf::scale, 0.003}};
  const Mueller f = prepare(model, 0.532).evaluate(g);
  const double u = standard_uncertainty(prepare_uncertainty(model, 0.532).normalized(g))(0, 0);
  const double of_sample = 0.01 * samples[0].f11;
  EXPECT_NEAR(significance(model, samples)[0].u, std::hypot(u, of_sample), 1e-12);
  EXPECT_NEAR(significance(model, samples, terms)[0].u, std::hypot(u, of_sample, 0.003 * f(0, 0)), 1e-12);
  EXPECT_NEAR(significance(model, samples, terms)[5].u, significance(model, samples)[5].u, 1e-12);  // a ratio
}

TEST(Significance, LeavesOutWhatHasNoUncertainty) {
  std::vector<Sample> samples = measured(1, {{{0.8, 0.1}, {0.5, 2.6}}});
  samples[0].uncertainty.elements[5] = 0;
  EXPECT_EQ(significance(least_squares("ptfe-532"), samples)[5].samples, 0);
  EXPECT_EQ(significance(least_squares("ptfe-532"), samples)[6].samples, 1);
  EXPECT_EQ(significance(samples, samples)[5].samples, 0);
}

TEST(Significance, LeavesOutWhereF11OfTheModelIsNotPositive) {
  const Model model = least_squares("ptfe-532");
  const std::vector<Sample> samples = measured(1, random_geometries(5, 1, radians(60)));
  EXPECT_EQ(significance(model, samples)[0].samples, 5);
  Model dark = model;
  for (double& coefficient : dark.blocks[0].coefficients) coefficient = -coefficient;
  for (const std::size_t e : {0U, 5U}) {
    EXPECT_EQ(significance(dark, samples)[e].samples, 0);
    EXPECT_EQ(significance(dark, model, samples)[e].samples, 0);
  }
}

TEST(Significance, NeedsTheUncertaintiesOfBoth) {
  Model unknown = least_squares("ptfe-532");
  for (FittedBlock& block : unknown.blocks) block.covariance.clear();
  EXPECT_THROW(between(least_squares("ptfe-532"), unknown, {Geometry{}}), std::invalid_argument);
}

}  // namespace
}  // namespace mmbrdf
