// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/fitting/selection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "given/cases.hpp"
#include "given/published.hpp"
#include "given/random_model.hpp"
#include "mmbrdf/files/samples_file.hpp"
#include "mmbrdf/samples/comparison.hpp"
#include "mmbrdf/samples/simulation.hpp"

namespace mmbrdf {
namespace {

constexpr std::array wavelength{0.5};
const FitOptions minimum_norm{.powers = {}, .reflectance = {}, .minimum_norm = true};

std::vector<Sample> noisy(const Model& model, std::span<const double> at, int count, double speckle = 0.005) {
  return simulate(model, at, random_geometries(count, 11), speckle, 5);
}

double held_out_rms(const PartSelection& part, int order, std::size_t partition, int powers = 0) {
  for (const Candidate& one : part.candidates)
    if (one.order == order && one.powers == powers) return one.held_out[partition].rms;
  throw std::logic_error("no such candidate");
}

int recommended_order(const PartSelection& part) { return part.candidates[part.recommended.value()].order; }

/// The order that has the least of something.
int least(const PartSelection& part, double Candidate::*what) {
  return std::min_element(part.candidates.begin(), part.candidates.end(),
                          [what](const Candidate& a, const Candidate& b) { return a.*what < b.*what; })
      ->order;
}

}  // namespace

// The rows are the same; only how they were folded differs.
TEST(FitAccumulator, AtLowerOrdersIsTheFitAtTheseOrders) {
  const std::vector<Sample> samples =
      noisy(random_model(Family::isotropic, {5, 4}, 1, 3), std::array{0.4, 0.6, 0.8}, 150);
  for (const Family family : {Family::isotropic, Family::germer2017}) {
    FitAccumulator high({family, {5, 4}, DiscMapping::projected});
    high.add(samples);
    for (const Orders orders : {Orders{5, 4}, Orders{3, 2}, Orders{0, 3}, Orders{4, 0}}) {
      const FitResult expected = fit(samples, {family, orders, DiscMapping::projected}, minimum_norm);
      const FitAccumulator lower = high.at_orders(orders);
      const FitResult result = lower.solve(minimum_norm);
      ASSERT_EQ(result.solutions.size(), expected.solutions.size());
      for (std::size_t b = 0; b < result.solutions.size(); ++b)
        for (std::size_t i = 0; i < result.solutions[b].x.size(); ++i)  // 1e-10: condition numbers are below 1e5
          EXPECT_NEAR(result.solutions[b].x[i], expected.solutions[b].x[i], 1e-10) << to_string(family);
      const auto misfit = lower.misfit(expected.model);
      for (std::size_t e = 0; e < 16; ++e) {
        EXPECT_NEAR(misfit[e].rms, expected.elements[e].rms, 1e-12);
        EXPECT_EQ(misfit[e].rows, 450);
        EXPECT_EQ(misfit[e].weight, 450);
      }
    }
  }
  FitAccumulator low({Family::isotropic, {3, 2}, DiscMapping::lambert});
  low.add(samples);
  EXPECT_THROW(low.at_orders({4, 2}), std::invalid_argument);
  EXPECT_THROW(low.misfit(random_model(Family::isotropic, {3, 1}, 0, 1)), std::invalid_argument);
  Model same = random_model(Family::isotropic, {3, 2}, 0, 1);
  EXPECT_NO_THROW(low.misfit(same));
  same.mapping = DiscMapping::projected;
  EXPECT_EQ(message_of([&] { low.misfit(same); }), "the model has another basis");
  const FitAccumulator turned({Family::germer2017, {3, 1}});
  const Model germer = random_model(Family::germer2017, {3, 1}, 0, 1);
  EXPECT_NO_THROW(turned.misfit(germer));
  EXPECT_EQ(message_of([&] { turned.misfit(as_printed(germer)); }), "the model has another basis");
}

// Each fold predicted, by the ordinary functions, from a fit to the others.
TEST(Selection, PredictsEachFoldFromTheOthers) {
  const std::vector<Sample> samples = noisy(random_model(Family::isotropic, {4, 3}, 1, 7), std::array{0.4, 0.6}, 120);
  SelectionOptions options;
  options.orders_f11 = Range{2, 3};
  options.orders_other = Range{1, 2};
  options.powers = Range{0, 1};
  options.reflectance = ReflectanceTable{{0.3, 0.9}, {0.8, 0.9}};
  const std::array partitions{folds_by_row(samples.size(), 4), random_folds(samples.size(), 3, 2)};
  const Selection selection = select_model(samples, partitions, options);
  for (std::size_t p = 0; p < 2; ++p)
    for (const int powers : {0, 1}) {
      double f11 = 0, other = 0;
      for (std::size_t fold = 0; fold < partitions[p].names.size(); ++fold) {
        std::vector<Sample> in, out;
        for (std::size_t s = 0; s < samples.size(); ++s)
          (partitions[p].fold[s] == fold ? out : in).push_back(samples[s]);
        const Model model = fit(in, {Family::isotropic, {3, 2}, DiscMapping::lambert},
                                {.powers = powers, .reflectance = options.reflectance})
                                .model;
        const std::vector<Mueller> rest = residuals(model, out);
        for (std::size_t s = 0; s < out.size(); ++s) {
          f11 += std::pow(rest[s](0, 0) / model.reflectance.at(out[s].wavelength), 2);
          for (std::size_t e = 1; e < 16; ++e) other += std::pow(rest[s].elements[e], 2);
        }
      }
      const auto n = static_cast<double>(samples.size());
      EXPECT_NEAR(held_out_rms(selection.f11, 3, p, powers), std::sqrt(f11 / n), 1e-12);
      EXPECT_NEAR(held_out_rms(selection.other, 2, p, powers), std::sqrt(other / (15 * n)), 1e-12);
    }
}

TEST(Selection, CountsOneRowOfF11AndFifteenOfTheOthersInAicAndBic) {
  const std::vector<Sample> samples = noisy(random_model(Family::isotropic, {4, 3}, 0, 7), wavelength, 200);
  const FitResult result = fit(samples, {Family::isotropic, {3, 2}, DiscMapping::lambert});
  const Selection selection =
      select_model(samples, std::array{folds_by_row(200, 2)}, {.orders_f11 = Range{3, 3}, .orders_other = Range{2, 2}});
  const double others = polarization_rms(result);
  const Candidate &f11 = selection.f11.candidates[0], &other = selection.other.candidates[0];
  EXPECT_EQ(f11.coefficients, 8);
  EXPECT_EQ(other.coefficients, 25);
  EXPECT_NEAR(f11.aic, 200 * 2 * std::log(result.elements[0].rms) + 2 * 8, 1e-8);
  EXPECT_NEAR(f11.bic, 200 * 2 * std::log(result.elements[0].rms) + 8 * std::log(200), 1e-8);
  EXPECT_NEAR(other.aic, 3000 * 2 * std::log(others) + 2 * 25, 1e-8);
  EXPECT_NEAR(other.bic, 3000 * 2 * std::log(others) + 25 * std::log(3000), 1e-8);
}

// Without noise every higher order is as good, to rounding.
TEST(Selection, FindsTheOrdersAndPowersOfWhatMadeTheData) {
  const std::array four{0.4, 0.55, 0.7, 0.9};
  for (const double speckle : {0.0, 0.002})
    for (const int powers : {0, 1}) {
      const Model model = random_model(Family::isotropic, {4, 3}, powers, 21);
      const std::vector<Sample> samples = noisy(model, four, 400, speckle);
      SelectionOptions options{.orders_f11 = Range{2, 6}, .orders_other = Range{1, 4}, .powers = Range{0, 2}};
      options.reflectance = ReflectanceTable{};
      const std::array partitions{random_folds(samples.size(), 3, 1), folds_by_wavelength(samples)};
      const Selection selection = select_model(samples, partitions, options);
      ASSERT_TRUE(selection.orders) << selection.f11.reason << selection.other.reason;
      EXPECT_EQ(selection.orders->f11, 4) << selection.f11.reason;
      EXPECT_EQ(selection.orders->other, 3) << selection.other.reason;
      EXPECT_EQ(selection.powers, powers);
    }
}

TEST(Selection, WeighsAsTheFitDoes) {
  const std::array two{0.5, 0.7};
  std::vector<Sample> samples = noisy(random_model(Family::isotropic, {3, 2}, 0, 4), two, 200, 0.02);
  for (std::size_t s = 0; s < samples.size(); ++s) samples[s].uncertainty.elements.fill(s % 3 == 0 ? 0.01 : 0.02);
  const ReflectanceTable nothing{};
  for (const Weights weights : {Weights::speckle, Weights::data, Weights::estimated}) {
    const Selection selection =
        select_model(samples, std::array{folds_by_row(400, 3)},
                     {.orders_f11 = Range{3, 3}, .orders_other = Range{2, 2}, .reflectance = nothing}, weights);
    const FitResult result =
        fit(samples, {Family::isotropic, {3, 2}, DiscMapping::lambert}, {.powers = 0, .reflectance = nothing}, weights);
    EXPECT_NEAR(selection.other.candidates[0].rms, polarization_rms(result), 1e-10);
    // The same law, relative to the f11 of the unweighted fit or, for `estimated`, of the weighted one: 2 % noise in
    // 400 samples moves it by a few parts in a thousand.
    EXPECT_NEAR(selection.f11.candidates[0].rms / result.elements[0].rms, 1,
                weights == Weights::estimated ? 1e-2 : 1e-10);
  }
}

TEST(Selection, RefusesWhatTheDataDoNotDetermine) {
  const Model model = random_model(Family::isotropic, {3, 2}, 0, 4);
  const std::vector<Sample> samples = noisy(model, wavelength, 24);
  const Selection selection =
      select_model(samples, std::array{folds_by_row(24, 3)}, {.orders_f11 = Range{2, 6}, .orders_other = Range{1, 2}});
  const std::vector<Candidate>& f11 = selection.f11.candidates;
  EXPECT_EQ(f11[3].refusal.substr(0, 34), "not determined without fold 1: blo") << f11[3].refusal;  // 20 of 16 rows
  EXPECT_EQ(f11[4].refusal.substr(0, 27), "not determined by the data:") << f11[4].refusal;         // 30 of 24 rows
  for (const Candidate& one : f11) EXPECT_TRUE(std::isfinite(one.aic) && std::isfinite(one.bic)) << one.order;
  EXPECT_LE(recommended_order(selection.f11), 4);
  EXPECT_TRUE(selection.orders);
  const Selection none =
      select_model(samples, std::array{folds_by_row(24, 3)}, {.orders_f11 = Range{6, 7}, .orders_other = Range{1, 2}});
  EXPECT_FALSE(none.orders);
  EXPECT_NE(none.f11.reason.find("every order is refused"), std::string::npos);
}

/// Intensities of s and p alone.
std::vector<Sample> of_s_and_p(std::vector<Sample> samples) {
  for (Sample& s : samples) {
    s = in_frame(s, Frame::sp);
    for (const std::size_t e : {2UL, 3UL, 6UL, 7UL, 8UL, 9UL, 10UL, 11UL, 12UL, 13UL, 14UL, 15UL})
      s.normalized.elements[e] = std::numeric_limits<double>::quiet_NaN();
    s = from_frame(s, Frame::sp);
  }
  return samples;
}

// An error of 0 is that of nothing predicted.
TEST(Selection, RefusesOrdersAtWhichAllElementsButF11AreUnknown) {
  const std::vector<Sample> samples =
      of_s_and_p(simulate(random_model(Family::isotropic, {3, 2}, 0, 4), wavelength, germer2017_grid(), 0.005, 5));
  const std::array folds{folds_by_row(1824, 3)};
  const Selection some = select_model(samples, folds, {.orders_f11 = Range{3, 3}, .orders_other = Range{2, 4}});
  EXPECT_EQ(recommended_order(some.other), 2);  // the plane of incidence has what settles order 2
  for (const Candidate& one : some.other.candidates)
    EXPECT_EQ(one.refusal.find("leaves all of its elements unknown") != std::string::npos, one.order > 2) << one.order;
  const Selection none = select_model(samples, folds, {.orders_f11 = Range{3, 3}, .orders_other = Range{3, 4}});
  ASSERT_TRUE(none.orders);
  EXPECT_EQ(none.orders->f11, 3);
  EXPECT_EQ(none.orders->other, 0);
  EXPECT_EQ(none.other.reason, "unknown at every order");
}

TEST(Selection, RefusesQuestionsThatMakeNoSense) {
  const std::vector<Sample> samples = noisy(random_model(Family::isotropic, {2, 1}, 0, 4), wavelength, 30);
  const std::array good{folds_by_row(30, 3)}, other_size{folds_by_row(29, 3)};
  const auto says = [&](std::span<const Partition> partitions, const SelectionOptions& options,
                        const std::string& part) {
    const std::string message = message_of([&] { select_model(samples, partitions, options); });
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  says({}, {}, "no partition");
  says(other_size, {}, "a partition of 29 of 30 samples");
  says(good, {.orders_f11 = Range{4, 3}}, "orders of f11 4 to 3");
  says(good, {.orders_other = Range{0, 41}}, "0...40");
  says(good, {.powers = Range{0, 1}}, "need 2 wavelengths, the data have 1");
  says(good, {.powers = Range{-1, 0}}, "powers of the wavelength -1 to 0");
}

namespace {

class PublishedSelection : public testing::Test {
 protected:
  void SetUp() override {
    if (published("PTFE.data.csv").empty() || published("PTFE.data.random.csv").empty())
      GTEST_SKIP() << absent("PTFE.data.csv, PTFE.data.random.csv");
    random = read_samples(published("PTFE.data.random.csv"));
    grid = at_wavelengths(read_samples(published("PTFE.data.csv")), std::array{0.532});
  }
  std::vector<Sample> grid, random;
};

}  // namespace

// Theory 3.4.
TEST_F(PublishedSelection, OfRandomDirectionsHasTheErrorsOfTheTheory) {
  const Selection selection =
      select_model(random, std::array{folds_by_row(random.size(), 3)}, {.orders_other = Range{3, 7}});
  const double f11[] = {.00669, .00495, .00443, .00439, .00440, .00450, .00463, .00480};
  const double other[] = {.01198, .01112, .01110, .01115, .01121};
  for (int order = 2; order <= 9; ++order)
    EXPECT_NEAR(held_out_rms(selection.f11, order, 0), f11[order - 2], 0.51e-5) << order;
  for (int order = 3; order <= 7; ++order)
    EXPECT_NEAR(held_out_rms(selection.other, order, 0), other[order - 3], 0.51e-5) << order;
  EXPECT_EQ(least(selection.f11, &Candidate::bic), 5);
  EXPECT_EQ(least(selection.other, &Candidate::bic), 4);
  EXPECT_EQ(least(selection.other, &Candidate::aic), 5);
  EXPECT_EQ(recommended_order(selection.f11), 5) << selection.f11.reason;
  EXPECT_EQ(recommended_order(selection.other), 4) << selection.other.reason;
}

TEST_F(PublishedSelection, LeavingAnglesOutRecommendsTheOrdersOfThePaperAndRefusesHigherOnes) {
  const std::array partitions{folds_by_row(grid.size(), 3), folds_by_incident_angle(grid)};
  const Selection selection = select_model(grid, partitions);
  const double f11[] = {.01352, .00965, .00690, .00563, .00439, .00361, .0242};
  for (int order = 2; order <= 8; ++order)
    EXPECT_NEAR(held_out_rms(selection.f11, order, 1), f11[order - 2], order == 8 ? 0.51e-4 : 0.51e-5) << order;
  ASSERT_TRUE(selection.orders);
  EXPECT_EQ(*selection.orders, (Orders{7, 4})) << selection.f11.reason << selection.other.reason;
  for (const Candidate& one : selection.f11.candidates)
    EXPECT_EQ(one.refusal.empty(), one.order < 8) << one.order << one.refusal;
  // Folds of rows see nothing of it: their error grows by 3 % only.
  EXPECT_LT(held_out_rms(selection.f11, 8, 0), 1.04 * held_out_rms(selection.f11, 7, 0));
}

}  // namespace mmbrdf
