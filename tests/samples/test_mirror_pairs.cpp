// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/samples/mirror_pairs.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "given/disturbed.hpp"
#include "given/published_samples.hpp"

namespace mmbrdf {

TEST(MirrorPairs, DifferByTheNoiseAlone) {
  const std::vector<Sample> samples =
      simulate(random_model(Family::isotropic, small_orders, 0, 5), std::array{0.4, 0.7}, germer2017_grid());
  const MirrorPairs pairs = mirror_pairs(samples);
  EXPECT_EQ(pairs.pairs, 2 * 715);
  for (std::size_t e = 0; e < 16; ++e) EXPECT_LT(pairs.rms.elements[e], 1e-13) << e;  // rounding
  const MirrorPairs with_noise = mirror_pairs(noisy(samples, 0.01, 1));
  for (std::size_t e = 1; e < 16; ++e) {
    EXPECT_NEAR(with_noise.rms.elements[e], 0.01, 4 * 0.01 / std::sqrt(2. * 1430)) << e;
    EXPECT_NEAR(with_noise.mean.elements[e], 0, 4 * 0.01 / std::sqrt(2. * 1430)) << e;
  }
  const MirrorPairs handed = mirror_pairs(changed(samples, [](Sample& x) { x.normalized(3, 1) += 0.01; }));
  EXPECT_NEAR(handed.mean(3, 1), 0.01, 1e-12);
  EXPECT_NEAR(handed.rms(3, 1), 0.01 * std::numbers::sqrt2, 1e-12);
  EXPECT_EQ(mirror_pairs(exact()).pairs, 0);
}

// φ = π and −π is one azimuth, and pairs are found in whatever order they stand.
TEST(MirrorPairs, AreFoundAtTheEndOfTheCircleAndInAnyOrder) {
  std::vector<Sample> samples;
  for (int i = 0; i < 201; ++i)
    samples.push_back({0.5, {{0.6, radians(180)}, {0.7, radians(180 + 40 + 0.005 * i)}}, 1, identity()});
  for (int i = 200; i >= 0; --i)
    samples.push_back({0.5, {{0.6, radians(-180)}, {0.7, radians(-180 - 40 - 0.005 * i)}}, 1, identity()});
  EXPECT_EQ(mirror_pairs(samples).pairs, 201);
}

// Theory 3.1.
TEST(PublishedData, DifferFromTheirMirrorImagesByTheNoiseAndIn42ByMore) {
  if (published("PTFE.data.csv").empty()) GTEST_SKIP() << absent("PTFE.data.csv");
  const std::map<double, double> f11{{0.351, 0.009}, {0.532, 0.011}, {0.633, 0.012}, {1.064, 0.018}};
  for (const auto& [wavelength, rms] : f11) {
    const MirrorPairs pairs = mirror_pairs(grid_at(wavelength));
    EXPECT_EQ(pairs.pairs, 715);
    EXPECT_NEAR(pairs.rms(0, 0), rms, 0.5e-3) << wavelength;
  }
  const MirrorPairs pairs = mirror_pairs(grid_at(0.532));
  EXPECT_NEAR(pairs.rms(3, 1), 0.0153, 0.5e-4);
  EXPECT_NEAR(pairs.mean(3, 1), 0.0054, 0.5e-4);
  for (const auto& [row, column] : {std::pair{1, 2}, {1, 3}, {2, 3}})
    EXPECT_NEAR(pairs.rms(row, column), 0.011, 0.5e-3) << row << column;
}

}  // namespace mmbrdf
