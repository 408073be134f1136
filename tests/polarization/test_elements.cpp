// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarization/elements.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "given/cases.hpp"
#include "given/random_mueller.hpp"
#include "mmbrdf/geometry/geometry.hpp"

namespace mmbrdf {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
// A few products of rounded sines and cosines of numbers up to 1. Largest difference seen: 1e-15.
constexpr double rounding = 1e-14;

double deviation(const Mueller& a, const Mueller& b) { return largest(a - b); }

Mueller random_mueller() {
  Mueller m;
  for (double& element : m.elements) element = between(-1, 1);
  return m;
}

const Film wafer{1.4607, 1, {4.15, 0.044}};  // 1000 nm of SiO2 on Si at 532 nm

Film random_film() { return {{between(0.3, 3), between(0, 3)}, between(0, 2), {between(0.3, 5), between(0, 5)}}; }

/// Of angles, across the cut at π.
double angle_between(double a, double b) { return std::abs(std::remainder(a - b, 2 * pi)); }

}  // namespace

RC_GTEST_PROP(Element, RotatedByHalfATurnIsItself, ()) {
  const Mueller m = random_mueller();
  const double a = between(-pi, pi), b = between(-pi, pi);
  RC_ASSERT(deviation(rotated(m, pi), m) <= rounding);
  RC_ASSERT(deviation(rotated(rotated(m, a), b), rotated(m, a + b)) <= rounding);
}

// The state behind the rotated element, in axes turned with it, is that behind the element.
RC_GTEST_PROP(Element, RotatedDoesInItsOwnAxesWhatItDid, ()) {
  const Mueller m = random_mueller();
  const double azimuth = between(-pi, pi);
  const Stokes light{1, between(-1, 1), between(-1, 1), between(-1, 1)};
  const Stokes seen = rotator(azimuth) * (rotated(m, azimuth) * light), did = m * (rotator(azimuth) * light);
  for (std::size_t k = 0; k < 4; ++k) RC_ASSERT(std::abs(seen[k] - did[k]) <= rounding);
}

RC_GTEST_PROP(Element, WithAxesHasTheMatrixOfItsAmplitudes, ()) {
  const DiattenuatorRetarder d{between(0.1, 1), between(0, pi / 2), between(-pi, pi)};
  const double r1 = std::sqrt(2 * d.tau) * std::cos(d.psi), r2 = std::sqrt(2 * d.tau) * std::sin(d.psi);
  RC_ASSERT(deviation(mueller(d), mueller_of({r1, 0, 0, std::polar(r2, d.delta)})) <= rounding);
}

TEST(Polarizer, AlongE1PassesHalfOfUnpolarizedLight) {
  Mueller expected;
  expected(0, 0) = expected(0, 1) = expected(1, 0) = expected(1, 1) = 0.5;
  EXPECT_EQ(polarizer(0), expected);
}

RC_GTEST_PROP(Polarizer, PassesLightAlongItsAxisAndItsExtinctionAcross, ()) {
  const double azimuth = between(-pi, pi), extinction = between(0, 1), phase = between(-pi, pi);
  const Mueller m = polarizer(azimuth, extinction, phase);
  const auto passed = [&](double along) { return (m * Stokes{1, std::cos(2 * along), std::sin(2 * along), 0})[0]; };
  RC_ASSERT(std::abs(passed(azimuth) - 1) <= rounding);
  RC_ASSERT(std::abs(passed(azimuth + pi / 2) - extinction) <= rounding);
}

RC_GTEST_PROP(Polarizer, LeaksAcrossWithItsPhase, ()) {
  const double azimuth = between(-pi, pi), extinction = between(0, 1), phase = between(-pi, pi);
  const Mueller of_amplitudes = mueller_of({1, 0, 0, std::polar(std::sqrt(extinction), phase)});
  RC_ASSERT(deviation(polarizer(azimuth, extinction, phase), rotated(of_amplitudes, azimuth)) <= rounding);
}

TEST(Polarizer, RefusesWhatItCannotBe) {
  EXPECT_EQ(message_of([] { polarizer(0, 1.5); }), "extinction 1.5 of a polarizer is not in [0, 1]");
  EXPECT_THROW(polarizer(0, -1e-9), std::invalid_argument);
  EXPECT_THROW(polarizer(0, nan_value), std::invalid_argument);
  EXPECT_EQ(message_of([] { polarizer(nan_value); }), "an angle of a polarizer is not finite");
  EXPECT_THROW(polarizer(0, 0, nan_value), std::invalid_argument);
}

// The field (1, 1)/√2 becomes (1, i)/√2, which is left-handed here: S4 = 1.
TEST(Retarder, OfAQuarterWaveTurnsLightHalfWayBetweenItsAxesIntoLeftHandedLight) {
  const Stokes out = retarder(pi / 2) * Stokes{1, 0, 1, 0};
  const Stokes left = stokes_behind({1, 0, 0, 1}, std::sqrt(0.5), {0, std::sqrt(0.5)});
  EXPECT_NEAR(left[3], 1, rounding);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(out[k], left[k], rounding) << k;
}

RC_GTEST_PROP(Retarder, IsUndoneByTheOppositeOneAndByAQuarterTurn, ()) {
  const double retardance = between(-7, 7), azimuth = between(-pi, pi);
  const Mueller plate = retarder(retardance, azimuth);
  RC_ASSERT(deviation(plate * retarder(-retardance, azimuth), identity()) <= rounding);
  RC_ASSERT(deviation(plate * retarder(retardance, azimuth + pi / 2), identity()) <= rounding);
  RC_ASSERT(deviation(retarder(retardance + 2 * pi, azimuth), plate) <= rounding);
}

TEST(Retarder, RefusesAnglesThatAreNotFinite) {
  EXPECT_EQ(message_of([] { retarder(nan_value); }), "an angle of a retarder is not finite");
  EXPECT_THROW(retarder(1, nan_value), std::invalid_argument);
}

// Computed with an independent prototype, to 16 digits. A phase of 35 in the film keeps 14 of them.

TEST(Film, ReflectsAsThePrototype) {
  struct Fact {
    double aoi, tau, psi, delta;
  };
  for (const Fact& fact : {Fact{30, 0.32690892737100663, 41.02241720944243, -173.91000408572128},
                           {45.88235294117647, 0.29694836458877016, 35.716213795604915, 157.28101717897488},
                           {56.470588235294116, 0.11112462566595896, 61.908561851254696, 171.284600429109},
                           {61.76470588235294, 0.19786870295597928, 44.8197451048447, -112.05013139319999},
                           {75, 0.41516601133707676, 18.4852046298526, -81.54522574961676}}) {
    const DiattenuatorRetarder d = reflection(wafer, 0.532, radians(fact.aoi));
    EXPECT_NEAR(d.tau, fact.tau, 1e-12) << fact.aoi;
    EXPECT_NEAR(degrees(d.psi), fact.psi, 1e-10) << fact.aoi;
    EXPECT_NEAR(degrees(d.delta), fact.delta, 1e-10) << fact.aoi;
  }
}

TEST(Film, OfNoThicknessOrOfAirIsTheBareSubstrate) {
  const std::complex<double> silicon = wafer.substrate_index;
  for (const double theta_i : {0.1, 0.9, 1.5}) {
    const DiattenuatorRetarder bare = reflection({1, 0, silicon}, 0.532, theta_i);
    for (const Film& film : {Film{1.4607, 0, silicon}, Film{{2, 0.3}, 0, silicon}}) {
      const DiattenuatorRetarder d = reflection(film, 0.532, theta_i);
      EXPECT_LE(deviation(mueller(d), mueller(bare)), rounding);
    }
    // Air above the substrate moves the surface that reflects, the same for s and p.
    EXPECT_LE(deviation(mueller(reflection({1, 0.7, silicon}, 0.532, theta_i)), mueller(bare)), rounding);
  }
}

TEST(Film, OfTheSubstrateIsTheBareSubstrate) {
  const std::complex<double> n(4.15, 0.044);
  const Mueller bare = mueller(reflection({1, 0, n}, 0.532, 0.9));
  EXPECT_LE(deviation(mueller(reflection({n, 0.3, n}, 0.532, 0.9)), bare), rounding);
}

// n = 1.5: ((n − 1) / (n + 1))² at normal incidence, and no p at Brewster's angle, arctan n.
TEST(Film, OnGlassHasFresnelsReflectanceAndBrewstersAngle) {
  const Film glass{1, 0, 1.5};
  EXPECT_NEAR(reflection(glass, 0.532, 0).tau, 0.04, rounding);
  EXPECT_NEAR(reflection(glass, 0.532, std::atan(1.5)).psi, 0, rounding);
  EXPECT_NEAR(angle_between(reflection(glass, 0.532, 0.5).delta, pi), 0, rounding);  // below it
  EXPECT_NEAR(reflection(glass, 0.532, 1.2).delta, 0, rounding);                     // above it
}

RC_GTEST_PROP(Film, ReflectsAtMostWhatArrives, ()) {
  const DiattenuatorRetarder d = reflection(random_film(), between(0.3, 2), between(0, 1.57));
  RC_ASSERT(2 * d.tau * std::max(std::pow(std::cos(d.psi), 2), std::pow(std::sin(d.psi), 2)) <= 1 + rounding);
  RC_ASSERT(d.psi >= 0 && d.psi <= pi / 2 && std::abs(d.delta) <= pi);
}

// s and p differ by the sign alone that the axes (s, p, k) of the reflected beam give.
RC_GTEST_PROP(Film, AtNormalIncidenceTurnsTheAxisPAround, ()) {
  const DiattenuatorRetarder d = reflection(random_film(), between(0.3, 2), 0);
  RC_ASSERT(std::abs(d.psi - pi / 4) <= 1e-12);  // relative rounding of amplitudes that may be 1e-2
  RC_ASSERT(angle_between(d.delta, pi) <= 1e-12);
}

TEST(Film, RefusesWhatCannotBe) {
  const auto refusal = [](Film film, double wavelength, double theta_i) {
    return message_of([=] { reflection(film, wavelength, theta_i); });
  };
  EXPECT_EQ(refusal(wafer, 0, 0.5), "film: wavelength of 0 nm");
  EXPECT_EQ(refusal(wafer, 0.532, radians(-5)), "film: angle of incidence of -5 degrees, must be from 0 to below 90");
  EXPECT_THROW(reflection(wafer, 0.532, pi / 2), std::invalid_argument);
  EXPECT_THROW(reflection(wafer, 0.532, nan_value), std::invalid_argument);
  EXPECT_EQ(refusal({1.5, -1, 4}, 0.532, 0.5), "film: thickness of -1");
  EXPECT_EQ(refusal({0, 1, 4}, 0.532, 0.5), "film: refractive index of 0");
  EXPECT_EQ(refusal({1.5, 1, {4, -0.5}}, 0.532, 0.5), "film: absorption index of -0.5");
  EXPECT_THROW(reflection({1.5, 1, {nan_value, 0}}, 0.532, 0.5), std::invalid_argument);
  EXPECT_THROW(reflection({1e300, 1, {4, 0}}, 0.532, 0.5), std::invalid_argument);
}

}  // namespace mmbrdf
