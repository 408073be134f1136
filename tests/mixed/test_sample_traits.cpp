// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/mixed/sample_traits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "given/halton.hpp"
#include "given/published_samples.hpp"
#include "mixed/prior.hpp"
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

/// A posterior of invented hyperparameters and means.
PosteriorData invented(const std::array<double, 3>& harmonics) {
  const std::vector<Block> list = blocks(Family::isotropic, {12, 10});
  PosteriorData data{{12, 10}, DiscMapping::lambert, {}, shared_errors({}), {{{{0.5F, 0, 0.5F, 3}, 1}}}, {{}}};
  PosteriorAt& at = data.wavelengths[0];
  at.wavelength = 0.5;
  at.f11.resize(blocks(Family::isotropic, {first_order, 0}).front().modes.size(), 1);
  for (const Block& block : list) {
    const MixedColumns columns(block, data.mapping);
    const std::size_t modes = block.modes.size(), all = static_cast<std::size_t>(columns.size());
    at.blocks.push_back({{-10, 3, harmonics[0], harmonics[1], harmonics[2], 2, -13, -13},
                         4e-6,
                         0,
                         std::vector<double>(modes),
                         std::vector<float>(all - modes),
                         std::vector<float>(modes * declared_errors),
                         {},
                         {}});
  }
  return data;
}

/// Root mean square over directions of the elements of columns with these coefficients.
double root_mean_square(const MixedColumns& columns, const Eigen::VectorXd& coefficients) {
  const Eigen::MatrixXd rows = columns.at(halton_directions(300, 0, 70));
  return std::sqrt((rows * coefficients).squaredNorm() / static_cast<double>(rows.rows()));
}

// √ of the mean of Σ v h², over the directions of Halton's sequences up to 70 degrees.
TEST(SampleTraits, HaveTheVarianceOfEachHarmonic) {
  const Posterior posterior(invented({-9, -12, -14}));
  const std::vector<SampleTraits> traits = sample_traits(posterior, 0);
  for (std::size_t b = 0; b < traits.size(); ++b) {
    const MixedColumns columns(posterior.blocks()[b], DiscMapping::lambert);
    Eigen::VectorXd theta(8);
    theta << -10, 3, -9, -12, -14, 2, -13, -13;
    const Eigen::VectorXd v = prior_of(columns).variances(theta);
    const Eigen::MatrixXd rows = columns.at(halton_directions(300, 0, 70));
    std::array<double, 3> squares{};
    for (std::size_t j = 0; j < columns.free().size(); ++j)
      if (const FreeMode& mode = columns.free()[j]; mode.kind == FreeMode::Kind::harmonic) {
        const Eigen::Index column = columns.isotropic_count() + static_cast<Eigen::Index>(j);
        squares[static_cast<std::size_t>(mode.harmonic) - 1] += v(column) * rows.col(column).squaredNorm();
      }
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(traits[b].anisotropy[k] / std::sqrt(squares[k] / static_cast<double>(rows.rows())), 1, 1e-9);
    EXPECT_DOUBLE_EQ(traits[b].noise, 2e-3);
  }
}

// 1e-6: means are kept in single precision.
TEST(SampleTraits, HaveThePartOfF11ThatReciprocityForbids) {
  PosteriorData data = invented({-13, -13, -13});
  const MixedColumns columns(blocks(Family::isotropic, data.orders).front(), data.mapping);
  Eigen::VectorXd forbidden = Eigen::VectorXd::Zero(columns.size());
  for (std::size_t j = 0; j < columns.free().size(); ++j) {
    const double mean = 1e-3 * std::cos(static_cast<double>(j));
    data.wavelengths[0].blocks[0].free_mean[j] = static_cast<float>(mean);
    if (columns.free()[j].kind == FreeMode::Kind::nonreciprocal)
      forbidden(columns.isotropic_count() + static_cast<Eigen::Index>(j)) = mean;
  }
  const double expected = root_mean_square(columns, forbidden);
  EXPECT_NEAR(sample_traits(Posterior(data), 0)[0].nonreciprocal / expected, 1, 1e-6);
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
