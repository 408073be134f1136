// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/quantities/plan_like.hpp"

#include <gtest/gtest.h>

#include "given/cases.hpp"
#include "given/random_model.hpp"
#include "mmbrdf/files/materials.hpp"

namespace mmbrdf {
namespace {

TEST(PlanLike, AFitHasItsVariancesAtTheWavelengthThatIsAskedFor) {
  const Model ptfe = material("ptfe");
  for (const double wavelength : {0.351, 0.532, 1.064}) {
    const VarianceComponents expected = components_of(*ptfe.posterior, wavelength),
                             found = components_like(&ptfe, wavelength);
    ASSERT_EQ(found.blocks.size(), expected.blocks.size());
    for (std::size_t b = 0; b < found.blocks.size(); ++b) {
      EXPECT_EQ(found.blocks[b].hyperparameters, expected.blocks[b].hyperparameters);
      EXPECT_EQ(found.blocks[b].noise_variance, expected.blocks[b].noise_variance);
    }
    EXPECT_EQ(found.f11, expected.f11);
  }
  EXPECT_EQ(components_like(&ptfe).f11, components_like(&ptfe, 0.351).f11);  // its first
  EXPECT_NE(components_like(&ptfe, 0.532).f11, components_like(&ptfe, 0.351).f11);
}

TEST(PlanLike, AnotherNoiseIsThatOfAllBlocks) {
  const Model ptfe = material("ptfe");
  for (const Model* fit : {&ptfe, static_cast<const Model*>(nullptr)})
    for (const VarianceComponents::OfBlock& block : components_like(fit, {}, 0.03).blocks)
      EXPECT_DOUBLE_EQ(block.noise_variance, 0.03 * 0.03);
}

TEST(PlanLike, WhatSaysNothingIsRefused) {
  const Model ptfe = material("ptfe"), without = random_model(Family::isotropic, {2, 2}, 0, 1);
  for (const double noise : {0.9e-6, 11.0, -0.01, std::nan("")})
    EXPECT_TRUE(
        message_of([&] { components_like(&ptfe, {}, noise); }).ends_with("must be in 1e-06...10, relative for f11"));
  EXPECT_EQ(message_of([&] { components_like(nullptr, 0.532); }),
            "a wavelength is that of a fit: without one it says nothing");
  EXPECT_EQ(message_of([&] { components_like(&without); }),
            "it says nothing of the sample's variances: fit it with uncertainty sample");
  EXPECT_EQ(message_of([&] { components_like(&ptfe, 0.5); }), "it was fitted at 351, 532, 633, 1064 nm, not at 500 nm");
}

}  // namespace
}  // namespace mmbrdf
