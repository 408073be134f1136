// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/fitting/leverage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "given/disturbed.hpp"
#include "mmbrdf/samples/comparison.hpp"

namespace mmbrdf {

TEST(SampleDiagnostics, HaveLeveragesThatAddUpToTheRank) {
  const std::array two{0.4, 0.7};
  const std::vector<Sample> samples = noisy(exact(200, two), 0.01, 1);
  std::vector<Mueller> weights(samples.size());
  for (std::size_t s = 0; s < samples.size(); ++s)
    for (std::size_t e = 0; e < 16; ++e) weights[s].elements[e] = static_cast<double>((s + 3 * e) % 5);  // also 0
  for (const auto& [family, rotation] : {std::pair(Family::isotropic, Rotation::covariant),
                                         {Family::germer2017, Rotation::covariant},
                                         {Family::germer2017, Rotation::as_printed}}) {
    FitAccumulator all({family, small_orders, DiscMapping::lambert, rotation});
    all.add(samples, weights);
    const SampleDiagnostics found = sample_diagnostics(samples, all.solve(), weights);
    ASSERT_EQ(found.leverage.size(), family == Family::isotropic ? 6U : 10U);
    for (const auto& block : found.leverage) {
      const double sum = std::accumulate(block.values.begin(), block.values.end(), 0.0);
      EXPECT_NEAR(sum, block.rank, 1e-8) << block.block;  // condition numbers squared, times rounding
      EXPECT_EQ(block.values[block.largest], *std::max_element(block.values.begin(), block.values.end()));
    }
  }
  EXPECT_THROW(sample_diagnostics(std::span(samples).first(10), fit(samples)), std::invalid_argument);
}

// y - ŷ of a fit without the sample is r / (1 - h).
TEST(SampleDiagnostics, HaveTheLeverageThatASampleHasOnItsOwnValue) {
  const std::vector<Sample> samples = noisy(exact(60), 0.05, 3);
  const FitResult all = fit(samples, {Family::isotropic, small_orders});
  const SampleDiagnostics found = sample_diagnostics(samples, all);
  for (std::size_t s = 0; s < samples.size(); s += 7) {
    std::vector<Sample> others = samples;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(s));
    const FitResult without = fit(others, {Family::isotropic, small_orders});
    const double missed = residuals(without.model, std::span(samples).subspan(s, 1)).front()(0, 0),
                 h = found.leverage.front().values[s];
    EXPECT_GT(h, 0.01);
    EXPECT_NEAR(all.residuals[s](0, 0) / (1 - h), missed, 1e-10 * std::abs(missed)) << s;
  }
}

TEST(SampleDiagnostics, HaveResidualsOfVarianceOneAndFindTheOneThatIsOff) {
  std::vector<Sample> samples = noisy(exact(400), 0.01, 2);
  samples[123].normalized(1, 3) += 0.2;
  samples[17].f11 -= 0.1;
  const SampleDiagnostics found = sample_diagnostics(samples, fit(samples, {Family::isotropic, small_orders}));
  const std::vector<Outlier> off = outliers(found);
  ASSERT_EQ(off.size(), 2U);
  EXPECT_EQ(off[0].sample, 123U);
  EXPECT_EQ(off[0].element, 7U);
  EXPECT_GT(off[0].studentized, 15);  // 20, less what it adds to s
  EXPECT_EQ(off[1].sample, 17U);
  EXPECT_EQ(off[1].element, 0U);
  EXPECT_LT(off[1].studentized, -8);
  double squares = 0;
  for (const Mueller& m : found.studentized)
    for (const double t : m.elements) squares += t * t;
  EXPECT_NEAR(squares / (400 * 16), 1, 4 * std::sqrt(2 / 6400.0));
  EXPECT_TRUE(outliers(found, 30).empty());
  EXPECT_THROW(outliers(found, -1), std::invalid_argument);
}

}  // namespace mmbrdf
