// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/quantities/conventions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
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

}  // namespace

TEST(Conventions, OfSamplesAsTheyAreFitBest) {
  const std::vector<ConventionFit> fits = convention_fits(measured());
  EXPECT_EQ(fits.front().read_as, "frame xy");
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
            "S3 of both beams reversed, or transposed");
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
