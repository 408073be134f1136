// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/quantities/conventions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <set>

#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/samples/simulation.hpp"

namespace mmbrdf {
namespace {

std::vector<Sample> measured(const std::function<void(Sample&)>& change = [](Sample&) {}) {
  std::vector<Sample> samples = simulate(material("ptfe-532"), std::array{0.532}, germer2017_grid(), 0.006, 1);
  std::ranges::for_each(samples, change);
  return samples;
}

ConventionFit best(const std::vector<Sample>& samples) {
  return std::ranges::min(convention_fits(samples), {}, &ConventionFit::rms);
}

void reverse(Mueller& m, bool scattered, int component) {
  for (int k = 0; k < 4; ++k) (scattered ? m(component, k) : m(k, component)) *= -1;
}

/// Of a table whose matrices are in a frame, with a fault in its numbers. The noise is low: frames that turn with the beams hide
/// a part of what a transposed matrix or exchanged arms do.
std::vector<Sample> measured_in(
    Frame frame, const std::function<void(Sample&)>& fault = [](Sample&) {}) {
  std::vector<Sample> samples = simulate(material("ptfe-532"), std::array{0.532}, germer2017_grid(), 0.001, 1);
  for (Sample& s : samples) {
    s = in_frame(s, frame);
    fault(s);
    s = from_frame(s, frame);
  }
  return samples;
}

}  // namespace

TEST(Conventions, OfSamplesAsTheyAreFitBest) {
  const std::vector<ConventionFit> fits = convention_fits(measured());
  EXPECT_EQ(fits.front().read_as, "frame xy, as declared");
  for (const ConventionFit& other : fits) EXPECT_GE(other.rms, fits.front().rms) << other.read_as;
  EXPECT_EQ(convention_warning(fits), "");
}

// "read as frame sp the residuals would be 0.0060 instead of 0.0178"
TEST(Conventions, FindTheFrameOfTheSamples) {
  for (const Frame frame : {Frame::sp, Frame::scattering_plane}) {
    const std::vector<Sample> samples =
        measured([&](Sample& s) { s.normalized = change_frame(s.normalized, s.geometry, Frame::xy, frame); });
    EXPECT_EQ(best(samples).read_as, "frame " + to_string(frame));
    EXPECT_NE(
        convention_warning(convention_fits(samples)).find("read as frame " + to_string(frame) + " the residuals "),
        std::string::npos);
  }
}

TEST(Conventions, FindWhatWasExchangedOrReversed) {
  for (const auto& [component, name] : {std::pair(1, "S2"), {2, "S3"}})
    for (const bool scattered : {false, true})
      EXPECT_EQ(best(measured([&, which = component](Sample& s) { reverse(s.normalized, scattered, which); })).read_as,
                name + std::string(scattered ? " of the receiver reversed" : " of the source reversed"));
  EXPECT_EQ(best(measured([](Sample& s) { reverse(s.normalized, true, 3); })).read_as, "S4 of one beam reversed");
  EXPECT_EQ(best(measured([](Sample& s) {
              for (const bool scattered : {false, true}) reverse(s.normalized, scattered, 2);
            })).read_as,
            "S3 of both beams reversed, azimuths counted the other way, or transposed");
}

TEST(Conventions, AreTriedInTheFrameInWhichTheSamplesWereGiven) {
  const auto turn_azimuths = [](Sample& s) {
    for (Direction* d : {&s.geometry.incident, &s.geometry.reflected}) d->phi = -d->phi;
  };
  for (const Frame frame : {Frame::sp, Frame::scattering_plane}) {
    const std::vector<ConventionFit> fits = convention_fits(measured_in(frame));
    EXPECT_EQ(fits.front().read_as, "frame " + to_string(frame) + ", as declared");
    EXPECT_EQ(std::ranges::min(fits, {}, &ConventionFit::rms).read_as, fits.front().read_as);
    EXPECT_EQ(best(measured_in(frame, [](Sample& s) { reverse(s.normalized, true, 2); })).read_as,
              "S3 of the receiver reversed");
    EXPECT_EQ(best(measured_in(frame, turn_azimuths)).read_as,
              "S3 of both beams reversed, or azimuths counted the other way");
    EXPECT_EQ(best(measured_in(frame, [](Sample& s) { s.normalized = transpose(s.normalized); })).read_as,
              "transposed");
    EXPECT_EQ(best(measured_in(frame, [](Sample& s) { s.geometry = exchanged(s.geometry); })).read_as,
              "arms exchanged");
  }
}

TEST(Conventions, OfRowsInSeveralFramesAreTriedInEach) {
  std::vector<Sample> samples = measured_in(Frame::sp);
  for (std::size_t i = 0; i < samples.size(); i += 2) samples[i].given_in = Frame::xy;
  const std::vector<ConventionFit> fits = convention_fits(samples);
  EXPECT_EQ(fits.front().read_as, "the frames of the rows, as declared");
  EXPECT_EQ(convention_warning(fits), "");
}

// Readings in which a fit knows other elements have other residuals: 12, 21 and 22 alone leave it open in sp.
TEST(Conventions, OfSamplesThatLackElementsAreComparedByTheSameOnes) {
  const auto keep_some = [](Sample& s) {
    for (std::size_t e = 1; e < 16; ++e)
      if (e != 1 && e != 4 && e != 5) s.normalized.elements[e] = std::numeric_limits<double>::quiet_NaN();
  };
  const std::vector<ConventionFit> fits = convention_fits(measured(keep_some));
  ASSERT_FALSE(fits.empty());
  EXPECT_EQ(convention_warning(fits), "");
  for (const ConventionFit& one : fits) EXPECT_GT(one.rms, 0) << one.read_as;
  EXPECT_EQ(best(measured([&](Sample& s) {
              reverse(s.normalized, false, 1);
              keep_some(s);
            })).read_as,
            "S2 of the source reversed");
  EXPECT_TRUE(convention_fits(measured_in(Frame::sp, keep_some)).empty());
}

// S4 reversed in both beams, axes turned by 90 degrees in both and exchanged arms leave the residuals what they are.
TEST(Conventions, ThatNoFitCanTellAreNotTried) {
  const std::vector<ConventionFit> fits = convention_fits(measured());
  for (const std::set<int>& components : {std::set{3}, {1, 2}}) {
    const std::vector<ConventionFit> same = convention_fits(measured([&](Sample& s) {
      for (const int component : components)
        for (const bool scattered : {false, true}) reverse(s.normalized, scattered, component);
    }));
    EXPECT_NEAR(same.front().rms, fits.front().rms, 1e-12);
  }
  const auto arms = convention_fits(measured([](Sample& s) { s.geometry = exchanged(s.geometry); }));
  EXPECT_NEAR(arms.front().rms, fits.front().rms, 1e-12);
  const auto rows = convention_fits(measured([](Sample& s) { s.normalized = transpose(s.normalized); }));
  EXPECT_NEAR(rows[3].rms, fits.front().rms, 1e-12) << rows[3].read_as;
}

TEST(Conventions, OfManySamplesAreTriedOnSome) {
  const std::vector<Sample> once = measured();
  std::vector<Sample> many;
  while (many.size() < 3 * most_tried) many.insert(many.end(), once.begin(), once.end());
  EXPECT_NEAR(convention_fits(many).front().rms, convention_fits(once).front().rms, 2e-4);
}

}  // namespace mmbrdf
