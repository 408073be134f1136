// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/mixed/posterior.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "given/halton.hpp"
#include "mixed/block_fit.hpp"
#include "mixed/prior.hpp"
#include "mixed/readings.hpp"
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
  const double infinite = std::numeric_limits<double>::infinity();
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
      [](PosteriorData& d) { d.not_measured.set(0); },
      [infinite](PosteriorData& d) { d.errors[0].size = infinite; },
      [infinite](PosteriorData& d) { d.wavelengths[0].wavelength = infinite; },
      [](PosteriorData& d) { d.wavelengths[0].wavelength = 0; },
      [nan](PosteriorData& d) { d.wavelengths[0].f11[3] = static_cast<double>(nan); },
      [](PosteriorData& d) { d.wavelengths[0].law.incident_exponent = -10.1; },
      [](PosteriorData& d) { d.wavelengths[0].law.reflected_exponent = 10.1; },
      [infinite](PosteriorData& d) { d.wavelengths[0].blocks[2].noise_variance = infinite; },
      [infinite](PosteriorData& d) { d.wavelengths[0].blocks[2].hyperparameters[0] = infinite; },
      [nan](PosteriorData& d) { d.wavelengths[0].blocks[2].free_mean[0] = nan; },
      [nan](PosteriorData& d) { d.wavelengths[0].blocks[2].shared[0] = nan; },
      [](PosteriorData& d) { d.wavelengths[0].blocks[2].mean.pop_back(); },
      [](PosteriorData& d) { d.wavelengths[0].blocks[2].free_mean.pop_back(); },
      [](PosteriorData& d) { d.wavelengths[0].blocks[2].deviations.push_back(1); },
      [](PosteriorData& d) { d.wavelengths[0].blocks[2].factor.push_back(1); },
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
  EXPECT_EQ(refusal(doctored), "unread are all elements of block 12,13,21,31");
  doctored.unread = Elements(0x8100);
  EXPECT_EQ(refusal(doctored), "unread, and of no block that is there: 44");
  doctored = sound;
  doctored.not_measured.set(4);
  EXPECT_EQ(refusal(doctored), "not measured, and not among those unread: 21");
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

/// Theory 8.2, of hyperparameters in the order of hyperparameter_names().
double variance_of(const Mode& mode, const Eigen::VectorXd& theta) {
  if (mode.n <= 2 && mode.m <= 2) return 100;
  return std::exp(theta(0)) * std::pow((1 + mode.n + mode.m) / 6.0, -2 * theta(1));
}
double variance_of(const FreeMode& mode, const Eigen::VectorXd& theta) {
  const double level = mode.kind == FreeMode::Kind::harmonic ? theta(1 + mode.harmonic)
                       : mode.kind == FreeMode::Kind::odd    ? theta(6)
                                                             : theta(7);
  return std::exp(level) * std::pow(1 + std::pow(mode.degree / 3.0, 2), -theta(5));
}

TEST(Prior, HasTheVariancesOfTheTheory) {
  for (const Block& block : blocks(Family::isotropic, generous_orders)) {
    const MixedColumns columns(block, DiscMapping::lambert);
    ASSERT_EQ(hyperparameter_names(block),
              (std::vector<std::string>{"iso", "slope", "q1", "q2", "q3", "free_slope", "odd",
                                        feeds_f11(block) ? "nonreciprocal" : "calibration"}));
    Eigen::VectorXd theta(8);
    theta << -10, 2.5, -11, -12, -13, 1.7, -14, -9;
    const Eigen::VectorXd v = prior_of(columns).variances(theta);
    Eigen::Index column = 0;
    for (const Mode& mode : block.modes) EXPECT_NEAR(v(column++) / variance_of(mode, theta), 1, 1e-12);
    for (const FreeMode& mode : columns.free()) EXPECT_NEAR(v(column++) / variance_of(mode, theta), 1, 1e-12);
    while (column < columns.size()) EXPECT_NEAR(v(column++) / std::exp(theta(7)), 1, 1e-12);
  }
}

TEST(Prior, KeepsLogarithmsOfVariancesFromMinus40To10) {
  const MixedColumns columns(blocks(Family::isotropic, {3, 2})[1], DiscMapping::lambert);
  const Prior prior = prior_of(columns);
  const Eigen::Index last = columns.size() - 1;  // of the calibration
  for (const auto& [asked, kept] : {std::pair{-50, -40}, {-39, -39}, {9, 9}, {20, 10}})
    EXPECT_NEAR(std::log(prior.variances(Eigen::VectorXd::Constant(8, asked))(last)), kept, 1e-12);
}

// Theory 8.1: harmonics have no preferred azimuth, and f11 that is not reciprocal is as likely as its opposite.
TEST(Prior, OfF11IsTheSameOfATurnedSampleAndOfSourceAndReceiverExchanged) {
  const MixedColumns columns(blocks(Family::isotropic, {5, 2}).front(), DiscMapping::lambert);
  const Prior prior = prior_of(columns);
  const Eigen::VectorXd roots = prior.variances(prior.mean).cwiseSqrt();
  std::vector<Geometry> as_is = random_geometries(20, 5), turned = as_is, exchanged = as_is;
  for (Geometry& g : turned) g = {{g.incident.theta, g.incident.phi + 0.7}, {g.reflected.theta, g.reflected.phi + 0.7}};
  for (Geometry& g : exchanged) std::swap(g.incident, g.reflected);
  const auto covariance = [&](const std::vector<Geometry>& at) {
    const Eigen::MatrixXd rows = columns.at(at) * roots.asDiagonal();
    return Eigen::MatrixXd(rows * rows.transpose());
  };
  const Eigen::MatrixXd expected = covariance(as_is);
  for (const auto& other : {turned, exchanged})
    EXPECT_LT((covariance(other) - expected).cwiseAbs().maxCoeff(), 1e-12 * expected.maxCoeff());
}

// Theory 8.1: a calibration leaves a constant error of each element in the scattering plane.
TEST(MixedColumns, OfTheCalibrationAreConstantInTheScatteringPlane) {
  const std::vector<Geometry> at = random_geometries(10, 2);
  for (const Block& block : blocks(Family::isotropic, {2, 2})) {
    const MixedColumns columns(block, DiscMapping::lambert);
    const Eigen::MatrixXd rows = columns.at(at);
    for (Eigen::Index c = 0; c < columns.calibration_count(); ++c)
      for (std::size_t g = 0; g < at.size(); ++g) {
        Mueller seen{};
        for (std::size_t e = 0; e < block.elements.size(); ++e)
          seen.elements[block.elements[e].index()] =
              rows(static_cast<Eigen::Index>(e * at.size() + g), columns.size() - columns.calibration_count() + c);
        const Mueller there = change_frame(seen, at[g], Frame::xy, Frame::scattering_plane);
        for (std::size_t e = 0; e < block.elements.size(); ++e)
          EXPECT_NEAR(there.elements[block.elements[e].index()], static_cast<Eigen::Index>(e) == c ? 1 : 0, 1e-12);
      }
  }
}

// Theory 8.1: a reading of noise variance 1 has σ² = cos^a θi / cos^b θr, of f11 relative times f11²; each counts as often
// as it was taken. 1e-6: angles are kept in single precision.
TEST(Readings, WeighByTheirLawAndCountAsOftenAsTheyWereTaken) {
  std::vector<double> f11(blocks(Family::isotropic, {first_order, 0}).front().modes.size());
  for (std::size_t j = 0; j < f11.size(); ++j) f11[j] = (j == 0 ? 1 : 0.02) / (1 + static_cast<double>(j));
  const MixedColumns first(blocks(Family::isotropic, {first_order, 0}).front(), DiscMapping::lambert);
  const std::vector<Geometry> at = random_geometries(8, 6);
  std::vector<ReadingDirections> readings;
  for (const Geometry& g : at)
    readings.push_back({{static_cast<float>(g.incident.theta), static_cast<float>(g.incident.phi),
                         static_cast<float>(g.reflected.theta), static_cast<float>(g.reflected.phi)},
                        static_cast<std::uint32_t>(1 + readings.size() % 3)});
  const Eigen::VectorXd f =
      first.isotropic_at(at) * Eigen::Map<const Eigen::VectorXd>(f11.data(), static_cast<Eigen::Index>(f11.size()));
  for (const std::size_t b : {0U, 1U})
    for (const ReadingLaw& law : {ReadingLaw{}, ReadingLaw{2, 0.5, true}, ReadingLaw{0.5, 3, false}}) {
      const MixedColumns columns(blocks(Family::isotropic, {3, 2})[b], DiscMapping::lambert);
      const Eigen::MatrixXd x = columns.at(at);
      Eigen::VectorXd weights(x.rows());
      for (Eigen::Index row = 0; row < x.rows(); ++row) {
        const std::size_t g = static_cast<std::size_t>(row) % at.size();
        weights(row) = readings[g].count * std::pow(std::cos(at[g].reflected.theta), law.reflected_exponent) /
                       std::pow(std::cos(at[g].incident.theta), law.incident_exponent);
        if (b == 0 && law.relative) weights(row) /= std::pow(f(row), 2);
      }
      const Eigen::MatrixXd expected = x.transpose() * weights.asDiagonal() * x;
      const Eigen::MatrixXd found = gram_of(columns, readings, law, f11).g.selfadjointView<Eigen::Lower>();
      EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-6 * expected.maxCoeff()) << b;
    }
}

// The covariance is that of the readings at the wavelength, symmetric, and no larger than that of fewer readings.
TEST(Posterior, HasTheCovarianceOfTheReadingsAtEachWavelength) {
  PosteriorData few = fitted().posterior->data(), both = few;
  few.readings[0].resize(40);
  both.wavelengths.push_back(both.wavelengths[0]);
  both.wavelengths[1].wavelength += 0.1;
  both.wavelengths[1].readings = 1;
  both.readings.push_back(few.readings[0]);
  const Posterior one(few), two(both);
  const auto modes = static_cast<Eigen::Index>(two.blocks()[2].modes.size());
  const Eigen::Map<const Eigen::MatrixXd> expected(one.covariance(0, 2).data(), modes, modes),
      less(two.covariance(1, 2).data(), modes, modes), more(two.covariance(0, 2).data(), modes, modes);
  EXPECT_EQ((less - expected).cwiseAbs().maxCoeff(), 0);
  EXPECT_LT((more - more.transpose()).cwiseAbs().maxCoeff(), 1e-12 * more.diagonal().maxCoeff());
  const Eigen::VectorXd gains = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(less - more).eigenvalues();
  EXPECT_GT(gains(0), -1e-8 * gains(modes - 1));  // rounding of matrices of a condition of 1e9
  EXPECT_GT(gains.sum(), 0.1 * less.trace());
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
  EXPECT_NO_THROW(predict_readings(model, 0.532 + 1e-8));
  EXPECT_THROW(predict_readings(model, 0.533), std::invalid_argument);
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
