// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/samples/matching.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/samples/comparison.hpp"
#include "mmbrdf/samples/simulation.hpp"

namespace mmbrdf {
namespace {

const std::vector<double> green{0.532};

std::vector<Sample> measured_at(const std::vector<Geometry>& geometries) {
  std::vector<Sample> samples = simulate(material("ptfe-532"), green, geometries);
  for (Sample& sample : samples)
    for (std::size_t e = 0; e < 16; ++e) sample.uncertainty.elements[e] = 0.001 * static_cast<double>(e + 1);
  return samples;
}

TEST(Matching, FindsTheNearestWithinTheToleranceInAnyOrder) {
  const std::vector<Geometry> places = random_geometries(200, 5, radians(75));
  std::vector<Sample> second = measured_at(places);
  std::reverse(second.begin(), second.end());
  for (Sample& sample : second) sample.geometry.reflected.theta += radians(0.09);
  const MatchedSamples found = matched(measured_at(places), second);
  ASSERT_EQ(found.first.size(), 200U);
  EXPECT_EQ(found.images, 0);
  for (std::size_t s = 0; s < 200; ++s) EXPECT_EQ(found.first[s].geometry.incident, second[s].geometry.incident);
  for (Sample& sample : second) sample.geometry.reflected.theta += radians(0.02);
  EXPECT_TRUE(matched(measured_at(places), second).first.empty());
  EXPECT_EQ(matched(measured_at(places), second, {.tolerance = radians(0.2)}).first.size(), 200U);
}

TEST(Matching, KnowsThatAnAzimuthIsOneThroughAFullTurnAndNoneAtTheNormal) {
  const Geometry there{{0.5, 3.1}, {0, 0}}, here{{0.5, 3.1 - 2 * std::acos(-1.0)}, {0, 2}};
  EXPECT_EQ(matched(measured_at({there}), measured_at({here})).first.size(), 1U);
}

TEST(Matching, IsOfOneWavelength) {
  std::vector<Sample> blue = measured_at({{{0.5, 0}, {0.5, 1}}});
  blue[0].wavelength = 0.45;
  EXPECT_TRUE(matched(measured_at({{{0.5, 0}, {0.5, 1}}}), blue).first.empty());
}

// A model that is its own mirror image and reciprocal has in each image what it has at its place: to the accuracy of
// the model, 1e-13 of f11.
RC_GTEST_PROP(Matching, OfImagesOfASampleWithTheseSymmetriesDiffersByNothing, ()) {
  const Geometry place = random_geometries(1, *rc::gen::arbitrary<unsigned>(), radians(75)).front();
  const int kind = *rc::gen::inRange(0, 3);
  Geometry image = place;
  if (kind != 1) image.reflected.phi = 2 * place.incident.phi - place.reflected.phi;
  if (kind != 0) image = exchanged(image);
  const std::vector<Sample> first = measured_at({place}), second = measured_at({image});
  const MatchedSamples found = matched(first, second, {.mirrored = kind != 1, .exchanged = kind != 0});
  RC_ASSERT(found.first.size() == 1U);
  const Comparison difference = compare(found.first, found.second);
  RC_ASSERT(largest(difference).largest < 1e-13);
}

TEST(Matching, TakesImagesOnlyIfAskedAndWithTheirUncertainties) {
  const Geometry place{{0.5, 0}, {0.9, 1}}, image = exchanged(place);
  const std::vector<Sample> first = measured_at({place}), second = measured_at({image});
  EXPECT_TRUE(matched(first, second, {.mirrored = true}).first.empty());
  const MatchedSamples found = matched(first, second, {.exchanged = true});
  ASSERT_EQ(found.images, 1);
  EXPECT_EQ(found.second[0].uncertainty(0, 1), second[0].uncertainty(1, 0));
}

TEST(Matching, RefusesTolerancesThatMeanNothing) {
  const std::vector<Sample> one = measured_at({{{0.5, 0}, {0.5, 1}}});
  for (const double degrees : {0.0, -1.0, 6.0})
    EXPECT_THROW(matched(one, one, {.tolerance = radians(degrees)}), std::invalid_argument);
}

}  // namespace
}  // namespace mmbrdf
