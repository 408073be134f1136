// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/mixed/posterior.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "given/halton.hpp"
#include "mixed/block_fit.hpp"
#include "mixed/prior.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/files/model_file.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/samples/simulation.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"
#include "mmbrdf/uncertainty/reading.hpp"

namespace mmbrdf {
namespace {

Model fitted() {
  return fit_sample(simulate(material("ptfe"), std::array{0.532}, random_geometries(120, 3), 0.006, 3)).model;
}

TEST(Posterior, RefusesWhatIsNone) {
  const PosteriorData sound = fitted().posterior->data();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<std::function<void(PosteriorData&)>> faults = {
      [](PosteriorData& d) { d.wavelengths.clear(); },
      [](PosteriorData& d) { d.wavelengths.push_back(d.wavelengths[0]); },  // does not rise
      [](PosteriorData& d) { d.wavelengths[0].readings = 1; },
      [](PosteriorData& d) { d.wavelengths[0].blocks.pop_back(); },
      [](PosteriorData& d) { d.wavelengths[0].f11.resize(3); },
      [](PosteriorData& d) { d.wavelengths[0].law.incident_exponent = 1e308; },
      [](PosteriorData& d) { d.wavelengths[0].blocks[2].noise_variance = 0; },
      [nan](PosteriorData& d) { d.wavelengths[0].blocks[2].mean[0] = static_cast<double>(nan); },
      [](PosteriorData& d) { d.wavelengths[0].blocks[2].shared.pop_back(); },
      [](PosteriorData& d) { d.wavelengths[0].blocks[2].hyperparameters.pop_back(); },
      [](PosteriorData& d) { d.errors.resize(2); },
      [](PosteriorData& d) { d.errors[0].size = -1; },
      [](PosteriorData& d) { d.readings[0].clear(); },
      [](PosteriorData& d) { d.readings[0][5].count = 0; },
      [nan](PosteriorData& d) { d.readings[0][5].angles[2] = nan; },
      [](PosteriorData& d) { d.readings[0][5].angles[0] = 3; },
      [](PosteriorData& d) { d.unread.set(0); },              // all of block 11
      [](PosteriorData& d) { d.unread = Elements(0x0116); },  // all of block 12, 13, 21, 31
  };
  EXPECT_NO_THROW(Posterior{sound});
  for (std::size_t f = 0; f < faults.size(); ++f) {
    PosteriorData doctored = sound;
    faults[f](doctored);
    EXPECT_THROW(Posterior{doctored}, std::invalid_argument) << f;
  }
}

TEST(Posterior, KnowsOfEachBlockWhatIsReadAndWhatIsNot) {
  std::vector<Sample> samples = simulate(material("ptfe"), std::array{0.532}, random_geometries(120, 3), 0.006, 3);
  for (Sample& sample : samples)
    for (const std::size_t e : {8UL, 15UL})  // 31 and 44
      sample.normalized.elements[e] = std::numeric_limits<double>::quiet_NaN();
  const PosteriorData sound = fit_sample(samples).model.posterior->data();
  const auto refusal = [](const PosteriorData& data) {
    try {
      Posterior{data};
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal(sound), "");
  PosteriorData doctored = sound;
  doctored.unread = Elements(0x0116);
  EXPECT_EQ(refusal(doctored), "posterior: unread are all elements of block 12,13,21,31");
  doctored.unread = Elements(0x8100);
  EXPECT_EQ(refusal(doctored), "posterior: unread, and of no block that is there: 44");
  doctored = sound;
  doctored.not_measured.set(4);
  EXPECT_EQ(refusal(doctored), "posterior: not measured, and not among those unread: 21");
  doctored.unread.set(4);
  EXPECT_EQ(refusal(doctored), "");
}

TEST(Posterior, MakesItsDataWhenTheyAreFirstAskedFor) {
  const Model model = fitted();
  const PosteriorData& sound = model.posterior->data();
  int made = 0;
  const Posterior deferred(sound.orders, sound.mapping, sound.not_measured, [&] { return ++made, sound; });
  const Posterior copy = deferred;
  EXPECT_EQ(deferred.mapping(), sound.mapping);
  EXPECT_EQ(deferred.not_measured(), sound.not_measured);
  EXPECT_EQ(deferred.blocks().size(), model.posterior->blocks().size());
  EXPECT_EQ(made, 0);
  EXPECT_TRUE(std::ranges::equal(deferred.covariance(0, 1), model.posterior->covariance(0, 1)));
  EXPECT_EQ(copy.data().wavelengths[0].blocks[1].mean, sound.wavelengths[0].blocks[1].mean);
  EXPECT_EQ(made, 1);
}

TEST(Posterior, ThrowsWhatIsWrongWithItsDataWhenTheyAreAskedFor) {
  const PosteriorData sound = fitted().posterior->data();
  const Posterior others({sound.orders.f11 + 1, sound.orders.other}, sound.mapping, sound.not_measured,
                         [&] { return sound; });
  EXPECT_THROW(others.data(), std::invalid_argument);
  EXPECT_THROW(others.covariance(0, 0), std::invalid_argument);
  const Posterior none(sound.orders, sound.mapping, sound.not_measured,
                       []() -> PosteriorData { throw std::runtime_error("no data"); });
  EXPECT_THROW(none.data(), std::runtime_error);
}

/// The same in its rounded form.
Model rounded(Model model) {
  PosteriorData data = model.posterior->data();
  for (std::size_t b = 0; b < data.wavelengths[0].blocks.size(); ++b) {
    const auto modes = static_cast<Eigen::Index>(model.posterior->blocks()[b].modes.size());
    round_covariance(data.wavelengths[0].blocks[b],
                     Eigen::Map<const Eigen::MatrixXd>(model.posterior->covariance(0, b).data(), modes, modes));
  }
  data.readings.clear();
  model.posterior = Posterior(data);
  return model;
}

TEST(Posterior, InItsRoundedFormHoldsEveryUncertaintyToOnePercent) {
  const Model exact = fitted(), twelve_bits = rounded(exact);
  const PreparedUncertainty a = prepare_uncertainty(exact, 0.532), b = prepare_uncertainty(twelve_bits, 0.532);
  for (const Geometry& g : halton_directions(40, 0, 80)) {
    const Mueller u = standard_uncertainty(a.evaluate(g)), v = standard_uncertainty(b.evaluate(g));
    for (std::size_t e = 0; e < 16; ++e)  // an independent implementation has .6 %
      EXPECT_NEAR(v.elements[e], u.elements[e], 0.01 * u.elements[e] + 1e-6);
  }
}

// Theory 8.2: ln v = l − s ln(1 + ((n + m) / 3)²) of free modes.
TEST(Prior, OfFreeModesFallsWithTheSquareOfTheirDegree) {
  const Model model = fitted();
  for (const Block& block : model.posterior->blocks()) {
    const MixedColumns columns(block, DiscMapping::lambert);
    const Prior prior = prior_of(columns);
    Eigen::VectorXd flat = prior.mean;
    const double slope = std::exchange(flat(5), 0);
    ASSERT_EQ(hyperparameter_names(block)[5], "free_slope");
    const Eigen::VectorXd v = prior.variances(prior.mean), without = prior.variances(flat);
    Eigen::Index column = columns.isotropic_count();
    for (const FreeMode& mode : columns.free()) {
      EXPECT_NEAR(v(column) / without(column), std::pow(1 + std::pow(mode.degree / 3.0, 2), -slope), 1e-12);
      ++column;
    }
  }
}

// A hundred readings of one direction, and many of others from one azimuth, where nothing tells the isotropic mean from
// anisotropy: the next reading there is uncertain by its noise and a hundredth more. 0.05: f11 of two orders.
TEST(Posterior, OfADirectionThatWasReadVeryOftenLeavesTheNoiseAlone) {
  const Geometry often{{0.8, 0}, {0.6, 2}};
  std::vector<Geometry> geometries = random_geometries(150, 4);
  for (Geometry& g : geometries) g.reflected.phi -= std::exchange(g.incident.phi, 0);
  geometries.resize(250, often);
  const Model model = fit_sample(simulate(material("ptfe-532"), std::array{0.532}, geometries, 0.006, 5)).model;
  const ReadingPrediction readings = predict_readings(model, 0.532);
  const double noise = std::sqrt(model.posterior->data().wavelengths[0].blocks[0].noise_variance *
                                 std::cos(often.incident.theta) / std::cos(often.reflected.theta));
  const PredictedReading here = readings.at_its_azimuth(often), anywhere = readings.at_some_azimuth(often);
  EXPECT_NEAR(std::pow(here.uncertainty(0, 0) / here.value(0, 0) / noise, 2), 1.01, 0.05);
  for (std::size_t e = 0; e < 16; ++e) EXPECT_LT(here.uncertainty.elements[e], anywhere.uncertainty.elements[e]) << e;
}

TEST(Posterior, InItsRoundedFormComesBackFromAFile) {
  const Model model = rounded(fitted());
  const Model again = model_from_json(to_json(model), "text");
  EXPECT_EQ(to_json(again), to_json(model));
  EXPECT_EQ(again.posterior->data().wavelengths[0].blocks[3].factor,
            model.posterior->data().wavelengths[0].blocks[3].factor);
}

}  // namespace
}  // namespace mmbrdf
