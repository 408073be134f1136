// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/mixed/sample_traits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "given/published_samples.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/samples/simulation.hpp"

namespace mmbrdf {
namespace {

bool has(const std::vector<std::string>& lines, const std::string& part) {
  return std::ranges::any_of(lines, [&](const std::string& line) { return line.find(part) != std::string::npos; });
}

TEST(SampleTraits, ThePublishedSampleIsNotIsotropic) {
  if (published("PTFE.data.csv").empty()) GTEST_SKIP() << absent("PTFE.data.csv");
  const Posterior posterior = *fit_sample(grid_at(0.532)).model.posterior;
  const std::vector<SampleTraits> traits = sample_traits(posterior, 0);
  // As an independent implementation has it, from 2000 directions: .0041, .0089 once per turn.
  EXPECT_EQ(traits[0].block, "11");
  EXPECT_NEAR(traits[0].anisotropy[0], 0.0041, 0.0002);
  EXPECT_EQ(traits[4].block, "24,34,42,43");
  EXPECT_NEAR(traits[4].anisotropy[0], 0.0089, 0.0004);
  EXPECT_NEAR(traits[0].noise, 0.00585, 0.00001);
  EXPECT_NEAR(traits[0].nonreciprocal, 0.0002, 0.0001);
  const std::vector<std::string> lines = described_sample(posterior);
  EXPECT_TRUE(has(lines, "532 nm: the sample is not isotropic: once per turn 0.0041 in f11"));
  EXPECT_TRUE(has(lines, "all readings were taken at one azimuth"));
  EXPECT_TRUE(has(lines, "with the sample turned by 180 degrees for every second one u(f11) would have been 0.0003"));
  EXPECT_TRUE(has(lines, "(--declare)"));
}

TEST(SampleTraits, At351NanometresSourceAndReceiverAreNotInterchangeable) {
  if (published("PTFE.data.csv").empty()) GTEST_SKIP() << absent("PTFE.data.csv");
  const Posterior posterior = *fit_sample(grid_at(0.351)).model.posterior;
  EXPECT_NEAR(sample_traits(posterior, 0)[0].nonreciprocal, 0.0018, 0.0002);  // of the reference
  EXPECT_TRUE(has(described_sample(posterior), "351 nm: source and receiver are not interchangeable"));
}

// f11 goes up and down once per turn of the sample, by as much in all directions. That is one mode, where the prior thinks
// of many: half of it is found.
TEST(SampleTraits, HaveTheAnisotropyOfASampleThatIsBrighterOnOneSide) {
  constexpr double size = 0.005;
  std::vector<Sample> samples = simulate(material("ptfe-532"), std::array{0.532}, random_geometries(300, 2), 0.002, 2);
  for (Sample& sample : samples) sample.f11 += size * std::sqrt(2.0) * std::cos(sample.geometry.incident.phi - 1);
  const std::vector<SampleTraits> traits = sample_traits(*fit_sample(samples).model.posterior, 0);
  EXPECT_GT(traits[0].anisotropy[0], size / 3);
  EXPECT_LT(traits[0].anisotropy[0], 1.5 * size);
  for (std::size_t k = 1; k < traits[0].anisotropy.size(); ++k) EXPECT_LT(traits[0].anisotropy[k], 0.1 * size) << k;
}

TEST(SampleTraits, AnIsotropicSampleInAllDirectionsLeavesLittleToSay) {
  const std::vector<Sample> samples =
      simulate(material("ptfe"), std::array{0.532}, random_geometries(300, 2), 0.006, 2);
  FitOptions options;
  options.declared = {0.003, radians(0.5), 0};
  const std::vector<std::string> lines = described_sample(*fit_sample(samples, {}, options).model.posterior);
  EXPECT_FALSE(has(lines, "one azimuth"));
  EXPECT_TRUE(has(lines, "declared, not measured: scale 0.3 %, source arm 0.5 degrees"));
}

}  // namespace
}  // namespace mmbrdf
