// SPDX-License-Identifier: BSD-3-Clause
// The fit of a sample in rounds, against the same in memory.
#include "mmbrdf/fitting/sample_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "given/cases.hpp"
#include "given/halton.hpp"
#include "given/published_samples.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/samples/simulation.hpp"
#include "mmbrdf/uncertainty/budget.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"

namespace mmbrdf {
namespace {

std::vector<Sample> simulated(int count, const std::vector<double>& wavelengths = {0.532}) {
  return simulate(material("ptfe"), wavelengths, random_geometries(count, 7), 0.006, 7);
}

struct Case {
  Basis basis{};
  FitOptions options{};
  Weights weights = Weights::speckle;
};

FitResult in_memory(std::span<const Sample> samples, Case one = {}) {
  one.options.uncertainty = Uncertainty::sample;
  return fit(samples, one.basis, one.options, one.weights);
}

/// Each round by three accumulators, which get the samples in an order of their own and are merged in another.
SampleFitAccumulator in_parts(std::vector<Sample> samples, const Case& one = {}) {
  std::mt19937 engine(3);
  SampleFitAccumulator sums(one.basis, one.weights);
  do {
    std::ranges::shuffle(samples, engine);
    std::vector<SampleFitAccumulator> parts(3, sums);
    const std::size_t some = samples.size() / 7;
    parts[0].add(std::span(samples).first(some));
    parts[1].add(std::span(samples).subspan(some, 2 * some), 1);
    parts[2].add(std::span(samples).subspan(3 * some, 1));
    parts[2].add(std::span(samples).subspan(3 * some + 1));
    parts[2].merge(parts[0]);
    parts[2].merge(parts[1]);
    sums = parts[2];
  } while (sums.next_round());
  return sums;
}

void expect_same(const FitResult& found, const FitResult& expected) {
  ASSERT_EQ(found.model.blocks.size(), expected.model.blocks.size());
  for (std::size_t b = 0; b < found.model.blocks.size(); ++b) {
    const std::vector<double>&a = found.model.blocks[b].coefficients, &c = expected.model.blocks[b].coefficients;
    ASSERT_EQ(a.size(), c.size());
    double largest = 0, apart = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      largest = std::max(largest, std::abs(c[i]));
      apart = std::max(apart, std::abs(a[i] - c[i]));
    }
    EXPECT_LT(apart, sample_fit_tolerance * largest) << found.model.blocks[b].block.name;
  }
  for (const double wavelength : expected.model.validity.wavelengths) {
    const PreparedUncertainty u = prepare_uncertainty(found.model, wavelength),
                              v = prepare_uncertainty(expected.model, wavelength);
    double apart = 0;
    for (const Geometry& g : halton_directions(10, 0, 70)) {
      const Mueller a = standard_uncertainty(u.normalized(g)), b = standard_uncertainty(v.normalized(g));
      for (std::size_t e = 0; e < 16; ++e)
        if (b.elements[e] > 0) apart = std::max(apart, std::abs(a.elements[e] / b.elements[e] - 1));
    }
    EXPECT_LT(apart, 10 * sample_fit_tolerance);
  }
  for (std::size_t e = 0; e < 16; ++e) {
    EXPECT_EQ(found.elements[e].rows, expected.elements[e].rows);
    EXPECT_NEAR(found.elements[e].chi_squared, expected.elements[e].chi_squared,
                sample_fit_tolerance * expected.elements[e].chi_squared);
    EXPECT_NEAR(found.elements[e].weight, expected.elements[e].weight,
                sample_fit_tolerance * expected.elements[e].weight);
  }
  double weight = 0;  // of f11 / reflectance
  for (const Mueller& one : expected.sample_weights) weight += one(0, 0);
  EXPECT_NEAR(expected.sample_weights.empty() ? 1 : found.elements[0].weight / weight, 1, sample_fit_tolerance);
  EXPECT_EQ(found.sides, expected.sides);
  EXPECT_EQ(found.weights, expected.weights);
  EXPECT_EQ(found.warnings, expected.warnings);
  EXPECT_EQ(found.model.validity.theta_r_max, expected.model.validity.theta_r_max);
}

void expect_same_posterior(const Model& found, const Model& expected) {
  ASSERT_TRUE(found.posterior && expected.posterior);
  const PosteriorData &a = found.posterior->data(), &b = expected.posterior->data();
  EXPECT_EQ(a.readings, b.readings);
  EXPECT_EQ(a.errors, b.errors);
  ASSERT_EQ(a.wavelengths.size(), b.wavelengths.size());
  for (std::size_t w = 0; w < a.wavelengths.size(); ++w) {
    EXPECT_EQ(a.wavelengths[w].law, b.wavelengths[w].law);
    EXPECT_EQ(a.wavelengths[w].readings, b.wavelengths[w].readings);
    ASSERT_EQ(a.wavelengths[w].blocks.size(), b.wavelengths[w].blocks.size());
    for (std::size_t i = 0; i < a.wavelengths[w].blocks.size(); ++i) {
      const BlockPosterior &p = a.wavelengths[w].blocks[i], &q = b.wavelengths[w].blocks[i];
      EXPECT_NEAR(p.evidence, q.evidence, 1e-4);  // the top is flat: rounding ends the search elsewhere
      EXPECT_NEAR(p.noise_variance, q.noise_variance, 10 * sample_fit_tolerance * q.noise_variance);
      for (std::size_t h = 0; h < p.hyperparameters.size(); ++h)
        EXPECT_NEAR(p.hyperparameters[h], q.hyperparameters[h], 1e-3);
    }
  }
}

void expect_same_fit(const std::vector<Sample>& samples, const Case& one = {}) {
  const FitResult found = in_parts(samples, one).solve(one.options), expected = in_memory(samples, one);
  expect_same(found, expected);
  expect_same_posterior(found.model, expected.model);
}

TEST(SampleFit, OfPartsInAnyOrderIsTheFitInMemory) { expect_same_fit(simulated(150)); }

TEST(SampleFit, IsSoForSeveralWavelengthsAndTheirOwnReflectances) {
  expect_same_fit(simulated(80, {0.351, 0.532, 0.633, 1.064}));
}

TEST(SampleFit, IsSoForAReflectanceThatIsGivenAndErrorsThatAreDeclared) {
  FitOptions options;
  options.reflectance = ReflectanceTable{{0.532}, {0.8}};
  options.declared = {0.003, radians(0.5), radians(0.2)};
  expect_same_fit(simulated(150), {{}, options});
}

TEST(SampleFit, IsSoWithoutWeights) {
  FitOptions options;
  options.reflectance = ReflectanceTable{{0.532}, {0.8}};
  options.declared = {0.003, 0, 0};
  expect_same_fit(simulated(150), {{Family::isotropic, {5, 3}}, options, Weights::none});
}

TEST(SampleFit, IsSoOfWhatIsInOtherUnits) {
  std::vector<Sample> samples = simulated(150);
  for (Sample& sample : samples) sample.f11 *= 1e5;
  expect_same_fit(samples);
}

TEST(SampleFit, IsSoOfWhatIsDarkerThanItsNoise) {
  std::mt19937 engine(1);
  std::normal_distribution<double> normal;
  std::vector<Sample> samples = simulated(300);
  for (Sample& sample : samples) sample.f11 = 3e-4 * (sample.f11 + normal(engine));
  expect_same_fit(samples);
  EXPECT_FALSE(in_parts(samples).solve().model.posterior->data().wavelengths[0].law.relative);
}

TEST(SampleFit, KnowsOfDarkSamplesThatAnotherHas) {
  std::vector<Sample> samples = simulated(300);
  std::erase_if(samples, [](const Sample& sample) {  // the fit of f11 is bright where the bright ones are
    return sample.geometry.reflected.theta > radians(45) && sample.geometry.reflected.theta < radians(65);
  });
  for (Sample& sample : samples)
    if (sample.geometry.reflected.theta > radians(60)) sample.f11 *= -1;
  const auto dark =
      std::stable_partition(samples.begin(), samples.end(), [](const Sample& one) { return one.f11 > 0; });
  const auto bright = static_cast<std::size_t>(dark - samples.begin());
  SampleFitAccumulator sums;
  do {
    SampleFitAccumulator other = sums;
    other.add(std::span(samples).subspan(bright));
    sums.add(std::span(samples).first(bright));
    sums.merge(other);
  } while (sums.next_round());
  const FitResult found = sums.solve(), expected = in_memory(samples);
  expect_same(found, expected);
  EXPECT_FALSE(found.model.posterior->data().wavelengths[0].law.relative);
}

/// Of the scale at a geometry, in parts of f11.
double declared_scale(const Model& model, const Geometry& g) {
  const PreparedModel prepared = prepare(model, 0.532);
  for (const BudgetTerm& term : budget(prepared, prepare_uncertainty(model, 0.532), {}, g).terms)
    if (term.name == "declared scale") return std::sqrt(term.covariance(0, 0)) / prepared.f11(g);
  return 0;
}

TEST(SampleFit, OfADeclaredScaleIsUncertainByItWhateverTheReflectance) {
  for (const double reflectance : {1.0, 0.5})
    for (const Weights weights : {Weights::speckle, Weights::none}) {
      FitOptions options;
      options.declared = {0.01, 0, 0};
      options.reflectance = ReflectanceTable{{0.532}, {reflectance}};
      const Model model = in_memory(simulated(150), {{}, options, weights}).model;
      EXPECT_NEAR(declared_scale(model, {{0.5, 0.2}, {0.4, 2}}), 0.01, 2e-4);  // what the prior holds back
    }
}

TEST(SampleFit, IsSoOfSamplesOfWhichABlockWasNotMeasured) {
  std::vector<Sample> samples = simulated(150);
  for (Sample& sample : samples) sample.normalized(3, 3) = std::nan("");
  expect_same_fit(samples);
}

/// All at one incidence, in degrees: what others would tell is left to the prior.
std::vector<Sample> at_incidence(double theta_i, int count) {
  std::vector<Geometry> geometries = random_geometries(count, 7);
  for (Geometry& g : geometries) g.incident = direction_from_degrees(theta_i, 0);
  return simulate(material("ptfe"), std::vector{0.532}, geometries, 0.006, 7);
}

/// Of what readings leave open coefficients are as uncertain as the prior: values are the same in parts of u.
TEST(SampleFit, IsSoOfOneIncidence) {
  for (const double theta_i : {0.001, 45.0}) {
    const std::vector<Sample> samples = at_incidence(theta_i, 300);
    const FitResult found = in_parts(samples).solve(), expected = in_memory(samples);
    const PreparedModel a = prepare(found.model, 0.532), b = prepare(expected.model, 0.532);
    const PreparedUncertainty u = prepare_uncertainty(found.model, 0.532),
                              v = prepare_uncertainty(expected.model, 0.532);
    double apart = 0, ratio = 1;
    for (const Geometry& g : halton_directions(100, 0, 70)) {
      const Mueller c = standard_uncertainty(u.normalized(g)), d = standard_uncertainty(v.normalized(g));
      const Mueller m = a.evaluate(g), n = b.evaluate(g);
      for (std::size_t e = 0; e < 16; ++e) {
        const double difference = e == 0 ? m(0, 0) - n(0, 0) : m.elements[e] / m(0, 0) - n.elements[e] / n(0, 0);
        apart = std::max(apart, std::abs(difference) / d.elements[e]);
        ratio = std::max(ratio, std::abs(c.elements[e] / d.elements[e]));
      }
    }
    EXPECT_LT(apart, 10 * sample_fit_tolerance) << theta_i;
    EXPECT_LT(ratio, 1 + 10 * sample_fit_tolerance) << theta_i;
  }
}

TEST(SampleFit, IsSoOfThePublishedGrid) {
  if (published("PTFE.data.csv").empty()) GTEST_SKIP() << absent("PTFE.data.csv");
  expect_same_fit(at_wavelengths(read_samples(published("PTFE.data.csv")), std::array{0.532}));
}

TEST(SampleFit, IsTheSameToTheLastBitWhenItsStateWasSentInEachRound) {
  const std::vector<Sample> samples = simulated(60, {0.532, 0.633});
  const Basis basis;
  SampleFitAccumulator here(basis), sent(basis);
  const auto send = [&] { sent = SampleFitAccumulator::from_state(basis, Weights::speckle, sent.state()); };
  for (int round = 1, more = 1; more; ++round) {
    EXPECT_EQ(sent.round(), round);
    send();
    here.add(samples);
    sent.add(samples);
    EXPECT_EQ(sent.samples(), 120);
    send();
    EXPECT_EQ(here.state(), sent.state());
    more = here.next_round();
    EXPECT_EQ(sent.next_round(), more);
    send();
    EXPECT_EQ(here.state(), sent.state());
  }
  EXPECT_TRUE(sent.finished());
  const Model a = here.solve().model, b = sent.solve().model;
  for (std::size_t i = 0; i < a.blocks.size(); ++i) EXPECT_EQ(a.blocks[i].coefficients, b.blocks[i].coefficients);
}

TEST(SampleFit, HasAStateThatDoesNotGrowWithTheSamples) {
  const std::vector<Sample> samples = simulated(40);
  SampleFitAccumulator once, often;
  do {
    once.add(samples);
    for (int i = 0; i < 5; ++i) often.add(samples);
    EXPECT_EQ(once.state().size(), often.state().size()) << once.round();
  } while (once.next_round() && often.next_round());
  EXPECT_LT(once.state().size(), 600'000);  // 4.8 MB at one wavelength
}

TEST(SampleFit, IsLeastSquaresWhereThereIsNoMixedModel) {
  const auto expect_noise = [](const std::vector<Sample>& samples, const Case& one, int rounds, const char* why) {
    const SampleFitAccumulator sums = in_parts(samples, one);
    EXPECT_EQ(sums.round(), rounds) << why;
    const FitResult found = sums.solve(one.options), expected = in_memory(samples, one);
    EXPECT_FALSE(found.model.posterior) << why;
    ASSERT_EQ(found.warnings.size(), 1) << why;
    EXPECT_NE(found.warnings[0].find(std::string("of the noise alone: ") + why), std::string::npos)
        << found.warnings[0];
    EXPECT_EQ(found.warnings, expected.warnings);
    const Geometry g{{0.5, 0.2}, {0.4, 2}};
    const double u = std::sqrt(prepare_uncertainty(expected.model, 0.532).evaluate(g)(0, 0)),
                 apart = std::abs(prepare(found.model, 0.532).f11(g) - prepare(expected.model, 0.532).f11(g));
    EXPECT_LT(apart, one.weights == Weights::none ? 1e-12 : 0.2 * u) << why;  // weights are relative to another fit
  };
  const std::vector<Sample> samples = simulated(300);
  FitOptions wrong;
  wrong.reflectance = ReflectanceTable{{0.532}, {1e-5}};
  const Basis low{Family::isotropic, {3, 2}};
  const std::vector<Sample> few(samples.begin(), samples.begin() + 28);
  std::vector<Sample> gap = samples;
  for (std::size_t s = 0; s < 31; ++s) gap[9 * s].normalized(1, 1) = std::nan("");  // one more than a tenth
  FitOptions free;
  free.minimum_norm = true;
  expect_noise(few, {low, free, Weights::none}, 3, "28 samples at 532 nm, at least 30 are needed");
  expect_noise(samples, {{Family::germer2017, {3, 2}}}, 3, "the germer2017 basis has no mixed model");
  expect_noise(samples, {{Family::isotropic, {2, 0}}, {}, Weights::none}, 3, "orders 2,0 leave elements without modes");
  expect_noise(gap, {low}, 3, "missing in some samples: 22");
  expect_noise(samples, {low, wrong}, 4, "f11 at 532 nm is that of an albedo of");
}

/// Samples of which element e is not known from `first` on, each `step`.
std::vector<Sample> with_gaps(std::vector<Sample> samples, std::size_t e, std::size_t first, std::size_t step) {
  for (std::size_t s = first; s < samples.size(); s += step) samples[s].normalized.elements[e] = std::nan("");
  return samples;
}

// Weights come from f11 of all of them, and those that lack an element have it: the fit of the others by themselves is
// within a tenth of u.
TEST(SampleFit, LeavesOutAFewSamplesThatLackElements) {
  const std::vector<Sample> whole = simulated(300), some = with_gaps(with_gaps(whole, 5, 3, 20), 9, 4, 60);
  std::vector<Sample> others;
  std::ranges::copy_if(some, std::back_inserter(others), [](const Sample& s) { return not_measured(s).none(); });
  const Case one{{Family::isotropic, {3, 2}}};
  const FitResult found = in_memory(some, one), expected = in_memory(others, one);
  ASSERT_TRUE(found.model.posterior);
  EXPECT_EQ(found.warnings.back(), "left out of the fit: " + std::to_string(whole.size() - others.size()) +
                                       " of 300 samples, in which elements are missing");
  EXPECT_EQ(expected.warnings.size() + 1, found.warnings.size());
  for (const ElementFit& element : found.elements) EXPECT_EQ(element.rows, 280);
  EXPECT_EQ(found.sample_weights[3](0, 0), 0);
  EXPECT_GT(found.sample_weights[5](0, 0), 0);
  const PreparedModel a = prepare(found.model, 0.532), b = prepare(expected.model, 0.532);
  const PreparedUncertainty u = prepare_uncertainty(expected.model, 0.532), v = prepare_uncertainty(found.model, 0.532);
  for (const Geometry& g : halton_directions(20, 0, 70)) {
    const Mueller sigma = standard_uncertainty(u.normalized(g)), with = standard_uncertainty(v.normalized(g)),
                  apart = normalized(a.evaluate(g)) - normalized(b.evaluate(g));
    for (std::size_t e = 1; e < 16; ++e) {
      EXPECT_LT(std::abs(apart.elements[e]), 0.1 * sigma.elements[e]);
      EXPECT_NEAR(with.elements[e], sigma.elements[e], 0.05 * sigma.elements[e]);
    }
  }
  expect_same_fit(some, one);
}

// What they do not support is outside the fit: the range is that of the others.
TEST(SampleFit, HasTheRangeOfTheSamplesThatItDoesNotLeaveOut) {
  std::vector<Sample> samples;
  for (Sample& sample : simulated(500)) {
    const bool far = std::max(sample.geometry.incident.theta, sample.geometry.reflected.theta) > 0.9;
    if (far) sample.normalized(2, 1) = std::nan("");
    if (!far || samples.size() % 12 == 5) samples.push_back(sample);
  }
  const FitResult found = in_memory(samples, {{Family::isotropic, {3, 2}}});
  ASSERT_TRUE(found.model.posterior);
  EXPECT_NE(found.warnings.back().find("left out"), std::string::npos);
  EXPECT_LE(found.model.validity.theta_r_max, 0.9);
  EXPECT_LE(found.model.validity.theta_i_max, 0.9);
}

// Of a part of which nothing is complete there are sums of nothing, which are sent and merged as others are.
TEST(SampleFit, TakesPartsOfWhichAllIsLeftOut) {
  const std::vector<Sample> samples = with_gaps(simulated(300), 5, 280, 1);
  const Basis low{Family::isotropic, {3, 2}};
  SampleFitAccumulator sums(low);
  do {
    SampleFitAccumulator whole = sums, gaps = sums;
    whole.add(std::span(samples).first(280));
    gaps.add(std::span(samples).subspan(280));
    sums = SampleFitAccumulator::from_state(low, Weights::speckle, gaps.state());
    EXPECT_EQ(sums.state(), gaps.state()) << sums.round();
    sums.merge(whole);
  } while (sums.next_round());
  expect_same(sums.solve(), in_memory(samples, {low}));
}

TEST(SampleFit, RefusesWhatIsNotARoundOverTheSameSamples) {
  const std::vector<Sample> samples = simulated(40);
  std::vector<Sample> changed = samples, red = samples;
  changed[7].f11 *= 1 + 1e-15;
  for (Sample& sample : red) sample.wavelength = 0.633;
  SampleFitAccumulator sums, first;
  EXPECT_EQ(message_of([&] { sums.next_round(); }), "no samples in round 1");
  EXPECT_EQ(message_of([&] { sums.solve(); }),
            "round 1 over the samples has not ended, or others are to follow: next_round()");
  sums.add(samples);
  ASSERT_TRUE(sums.next_round());
  EXPECT_EQ(message_of([&] { sums.merge(first); }), "cannot merge round 1 of a fit with round 2");
  EXPECT_EQ(message_of([&] {
              sums.merge(SampleFitAccumulator(Basis{Family::isotropic, {3, 2}}));
            }),
            "cannot merge fits of different bases");
  EXPECT_EQ(message_of([&] { sums.add(red); }), "samples at 633 nm, of which round 1 had none");
  SampleFitAccumulator other, few = sums, one_changed = sums;
  other.add(changed);
  ASSERT_TRUE(other.next_round());
  EXPECT_EQ(message_of([&] { sums.merge(other); }),
            "cannot merge fits with other weights, or of other samples in the rounds before");
  few.add(std::span(samples).first(39));
  EXPECT_EQ(message_of([&] { few.next_round(); }),
            "round 2 was of other samples than round 1, 39 of them in place of 40");
  one_changed.add(changed);
  EXPECT_EQ(message_of([&] { one_changed.next_round(); }),
            "round 2 was of other samples than round 1, as many of them");
  sums.add(std::span(samples).subspan(20));
  sums.add(std::span(samples).first(20));
  EXPECT_TRUE(sums.next_round());
}

TEST(SampleFit, RefusesOthersOfWhichOnlyWhatWasMeasuredInAnotherFrameDiffers) {
  const auto measured = [](double m12) {
    std::vector<Sample> samples = simulated(40);
    for (Sample& sample : samples) {
      sample.normalized.elements.fill(std::nan(""));
      sample.normalized(0, 0) = 1;
      sample.normalized(0, 1) = m12;
      sample = from_frame(sample, Frame::sp);
    }
    return samples;
  };
  SampleFitAccumulator sums;
  sums.add(measured(0.1));
  ASSERT_TRUE(sums.next_round());
  SampleFitAccumulator other = sums;
  sums.add(measured(0.1));
  EXPECT_TRUE(sums.next_round());
  other.add(measured(0.2));
  EXPECT_EQ(message_of([&] { other.next_round(); }), "round 2 was of other samples than round 1, as many of them");
}

TEST(SampleFit, RefusesWeightsThatNeedAllSamplesAndSamplesThatHaveNone) {
  EXPECT_EQ(message_of([] { SampleFitAccumulator({}, Weights::estimated); }),
            "weights estimated need all samples at once: take none or speckle, or fit()");
  std::vector<Sample> samples = simulated(2);
  samples[1].geometry.incident.theta = radians(90);
  EXPECT_EQ(message_of([&] { SampleFitAccumulator().add(samples); }).substr(0, 10), "sample 2: ");
  for (Sample& sample : samples) sample.f11 = std::nan("");
  SampleFitAccumulator sums({}, Weights::none);
  sums.add(samples);
  EXPECT_EQ(message_of([&] { sums.next_round(); }), "f11 is not measured in any sample");
}

TEST(SampleFit, RefusesNumbersThatAreNoStateOfIt) {
  const Basis basis;
  SampleFitAccumulator sums;
  sums.add(simulated(40));
  sums.next_round();
  const std::vector<double> state = sums.state();
  const auto changed = [&](std::size_t at, double number) {
    std::vector<double> other = state;
    other.at(at) = number;
    return message_of([&] { SampleFitAccumulator::from_state(basis, Weights::speckle, other); });
  };
  EXPECT_EQ(changed(1, 3), "a state of a fit with another basis");
  EXPECT_EQ(changed(5, 0), "a state of a fit with other weights");
  EXPECT_EQ(changed(8, 5), "a state of a fit with a round 5");
  EXPECT_EQ(changed(8, 2.5), "a state of a fit with a round 2.5");
  EXPECT_EQ(message_of([&] { SampleFitAccumulator::from_state(basis, Weights::none, state); }),
            "a state of a fit with other weights");
  for (const std::size_t size : {std::size_t{0}, std::size_t{7}, state.size() - 1})
    EXPECT_EQ(
        message_of([&] { SampleFitAccumulator::from_state(basis, Weights::speckle, std::span(state).first(size)); }),
        "a state of a fit that ends too soon");
}

}  // namespace
}  // namespace mmbrdf
