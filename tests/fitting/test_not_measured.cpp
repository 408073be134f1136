// SPDX-License-Identifier: BSD-3-Clause
// What was not measured is unknown, not zero: samples.hpp, fit.hpp, model.hpp.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "given/cases.hpp"
#include "given/files.hpp"
#include "given/published_samples.hpp"
#include "given/random_model.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/files/model_file.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/model/batch.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/quantities/answer.hpp"
#include "mmbrdf/samples/comparison.hpp"
#include "mmbrdf/samples/simulation.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"

using namespace mmbrdf;

namespace {

constexpr Frame frames[] = {Frame::xy, Frame::sp, Frame::scattering_plane};
const Elements row_and_column_4 = 0x8888 | 0xf000, all_but_f11 = 0xfffe;

std::vector<Sample> without(const Elements& elements, std::vector<Sample> samples) {
  for (Sample& sample : samples)
    for (std::size_t e = 1; e < 16; ++e)
      if (elements[e]) sample.normalized.elements[e] = std::numeric_limits<double>::quiet_NaN();
  return samples;
}

std::vector<Sample> of_ptfe(double speckle = 0.006) {
  return simulate(material("ptfe-532"), std::array{0.532}, random_geometries(300, 3), speckle, 1);
}

Geometry a_geometry() { return in_degrees(between(0, 75), between(-180, 180), between(0, 75), between(-180, 180)); }

/// The coefficients of the blocks that `some` has are the same bits as those of the same blocks of `all`.
void expect_same_blocks(const Model& some, const Model& all) {
  for (const FittedBlock& fitted : some.blocks) {
    const auto same = std::ranges::find_if(
        all.blocks, [&](const FittedBlock& other) { return other.block.name == fitted.block.name; });
    ASSERT_NE(same, all.blocks.end());
    EXPECT_EQ(fitted.coefficients, same->coefficients) << fitted.block.name;
    EXPECT_EQ(fitted.covariance, same->covariance) << fitted.block.name;
  }
}

}  // namespace

TEST(NotMeasured, ElementsLeaveTheBlocksOfTheOthersAsTheyAreToTheLastBit) {
  for (const Elements& elements : {all_but_f11, row_and_column_4})
    for (const Family family : {Family::isotropic, Family::germer2017, Family::anisotropic})
      for (const Weights weights : {Weights::none, Weights::speckle}) {
        // Sums over other blocks round f11, which the noise is relative to, in another way.
        if (family == Family::anisotropic && weights == Weights::speckle) continue;
        const std::vector<Sample> all = of_ptfe(), some = without(elements, all);
        const Basis basis{family, {3, 2}};
        FitOptions options;
        options.minimum_norm = true;
        const Model model = fit(some, basis, options, weights).model;
        EXPECT_EQ(model.not_measured, elements);
        SCOPED_TRACE(to_string(family) + " " + to_string(weights) + " " + element_names(elements));
        expect_same_blocks(model, fit(all, basis, options, weights).model);
      }
}

TEST(NotMeasured, ElementsLeaveTheMixedModelOfTheOthersAsItIs) {
  const std::vector<Sample> all = of_ptfe();
  const Model whole = fit_sample(all, {Family::isotropic, {5, 3}}).model;
  for (const Elements& elements : {all_but_f11, row_and_column_4}) {
    const FitResult fitted = fit_sample(without(elements, all), {Family::isotropic, {5, 3}});
    ASSERT_TRUE(fitted.model.posterior) << fitted.warnings[0];
    expect_same_blocks(fitted.model, whole);
    const Geometry g = in_degrees(45, 0, 30, 150);
    const MuellerCovariance u = prepare_uncertainty(fitted.model, 0.532).evaluate(g),
                            u_whole = prepare_uncertainty(whole, 0.532).evaluate(g);
    for (std::size_t e = 0; e < 16; ++e)
      for (std::size_t other = 0; other < 16; ++other)
        if (elements[e] || elements[other])
          EXPECT_TRUE(std::isnan(u(e, other)));
        else
          EXPECT_EQ(u(e, other), u_whole(e, other)) << e << " " << other;
  }
}

TEST(NotMeasured, ElementsOfSomeSamplesCostTheirRowsAndNoMore) {
  std::vector<Sample> samples =
      simulate(random_model(Family::isotropic, {3, 2}, 0, 5), std::array{0.5}, random_geometries(400, 4), 0, 1);
  for (std::size_t s = 0; s < samples.size(); ++s)
    samples[s] = without(Elements(s * 40503 & 0xfffe), {samples[s]})[0];  // about half of them, others each time
  samples[7].f11 = std::numeric_limits<double>::quiet_NaN();
  const FitResult fitted = fit(samples, {Family::isotropic, {3, 2}});
  EXPECT_EQ(fitted.elements[0].rows, 399);
  EXPECT_TRUE(fitted.model.not_measured.none());
  EXPECT_LT(largest_difference(fitted.model, random_model(Family::isotropic, {3, 2}, 0, 5)), 1e-11);
}

RC_GTEST_PROP(NotMeasured, ElementsAreDeterminedByOthersOfTheirBlock, ()) {
  // By reciprocity and rotation one element of each block is enough; of 22, 23, 32 and 33, with complex functions, one
  // real part and one imaginary.
  const Model truth = random_model(Family::isotropic, {2, 2}, 0, *rc::gen::inRange<std::uint64_t>(0, 1000));
  Elements kept;
  for (const std::vector<std::size_t>& block :
       {std::vector<std::size_t>{0}, {1, 2, 4, 8}, {3, 12}, {5, 10}, {6, 9}, {7, 11, 13, 14}, {15}})
    kept.set(*rc::gen::elementOf(block));
  const std::vector<Sample> some = without(~kept, simulate(truth, std::array{0.5}, random_geometries(300, 1), 0, 1));
  const FitResult fitted = fit(some, {Family::isotropic, {2, 2}});
  RC_ASSERT(fitted.model.not_measured.none());
  RC_ASSERT(largest_difference(fitted.model, truth) < 1e-11);
}

TEST(NotMeasured, AccumulatorsMergeAndAreSentAsOnesOfAllElements) {
  const std::vector<Sample> samples = without(row_and_column_4, of_ptfe());
  const Basis basis{Family::isotropic, {3, 2}};
  FitAccumulator first(basis), second(basis);
  first.add(std::span(samples).first(100));
  second.add(std::span(samples).subspan(100));
  first.merge(FitAccumulator::from_state(basis, second.state()));
  const Model model = first.solve().model;
  EXPECT_EQ(model.not_measured, row_and_column_4);
  EXPECT_LT(largest_difference(model, fit(samples, basis).model), 1e-12);
}

RC_GTEST_PROP(NotMeasured, IsNaNInEveryFrameWhereAxesMixItAndNowhereElse, ()) {
  const Model whole = random_model(Family::isotropic, {2, 2}, 0, 1);
  const Elements elements = *rc::gen::element(Elements(0x0116), Elements(0x1008), Elements(0x0660), Elements(0x6880),
                                              row_and_column_4, all_but_f11);
  Model some = whole;
  some.not_measured = elements;
  std::erase_if(some.blocks, [&](const FittedBlock& b) { return elements[b.block.elements.front().index()]; });
  const Geometry g = a_geometry();
  for (const Frame frame : frames) {
    const Elements unknown = unknown_elements(some, frame);
    const Mueller f = prepare(some, 0.5).evaluate(g, frame), all = prepare(whole, 0.5).evaluate(g, frame),
                  of_incidence = prepare(some, 0.5).at(g.incident).evaluate(g.reflected, frame);
    RC_ASSERT(unknown_elements(f) == unknown);
    RC_ASSERT(unknown_elements(of_incidence) == unknown);
    for (std::size_t e = 0; e < 16; ++e)
      if (!unknown[e]) RC_ASSERT(std::abs(f.elements[e] - all.elements[e]) < 1e-12);
  }
}

TEST(NotMeasured, ElementsAreNaNInBatchesOfBothPrecisionsAndAtManyWavelengths) {
  Model model = random_model(Family::isotropic, {2, 2}, 1, 1);
  model.not_measured = row_and_column_4;
  std::erase_if(model.blocks, [](const FittedBlock& b) { return row_and_column_4[b.block.elements.front().index()]; });
  const std::vector<Geometry> geometries = random_geometries(100, 1);
  const std::vector<double> wavelengths(100, 0.6);
  std::vector<Mueller> out(100);
  evaluate(prepare(model, 0.5), geometries, out, {.wavelengths = wavelengths});
  for (const Mueller& f : out) EXPECT_EQ(unknown_elements(f), row_and_column_4);
  const std::vector<float> x(10, 0.F), z(10, 1.F);
  std::vector<float> single(160);
  evaluate(prepare(model, 0.5), VectorGeometries<float>{{x, x, z}, {x, x, z}}, single);
  for (std::size_t i = 0; i < 160; ++i) EXPECT_EQ(std::isnan(single[i]), row_and_column_4[i % 16]);
}

TEST(NotMeasured, QuantitiesAreKnownIfAllTheirElementsAre) {
  const std::vector<Sample> linear = without(row_and_column_4, of_ptfe());
  const Model model = fit(linear, {Family::isotropic, {3, 2}}).model;
  const Answers answers(model, {.frame = Frame::sp, .light = Stokes{1, 1, 0, 0}});
  const Model whole = fit(of_ptfe(), {Family::isotropic, {3, 2}}).model;
  const Answers of_whole(whole, {.frame = Frame::sp, .light = Stokes{1, 1, 0, 0}});
  const Geometry g = in_degrees(45, 0, 60, 120);
  const Answer a = answers.at(0.532).at(g), all = of_whole.at(0.532).at(g);
  EXPECT_FALSE(a.realizable);
  for (std::size_t q = 0; q < a.quantities.size(); ++q) {
    const std::string_view name = a.quantities[q].quantity->name;
    const bool known = name.starts_with("f_") || name == "depolarization_ratio" || name == "scattered_S1" ||
                       name == "scattered_S2" || name == "scattered_S3" || name == "orientation_deg";
    EXPECT_EQ(a.quantities[q].known, known) << name;
    ASSERT_EQ(a.quantities[q].value.has_value(), known) << name;
    if (!known) continue;
    EXPECT_NEAR(*a.quantities[q].value, *all.quantities[q].value, 1e-13 * std::abs(*all.quantities[q].value) + 1e-15);
    EXPECT_NEAR(*a.quantities[q].uncertainty, *all.quantities[q].uncertainty, 1e-9 * *all.quantities[q].uncertainty);
  }
}

TEST(NotMeasured, ElementsEndTheFittedRange) {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  for (const bool is_f11 : {true, false}) {
    std::vector<Sample> samples = of_ptfe();
    for (Sample& sample : samples)
      if (sample.geometry.reflected.theta > radians(50))
        (is_f11 ? sample.f11 : sample.normalized.elements[15]) = unknown;
    FitAccumulator accumulator({Family::isotropic, {2, 1}});
    accumulator.add(samples);
    const FitAccumulator sent = FitAccumulator::from_state({Family::isotropic, {2, 1}}, accumulator.state());
    for (const Model& model : {fit(samples, {Family::isotropic, {2, 1}}).model, sent.solve().model}) {
      EXPECT_LE(model.validity.theta_r_max, radians(50));
      EXPECT_GT(model.validity.theta_r_max, radians(45));
      EXPECT_TRUE(leaves_known_range(outside(model.validity, 0.532, in_degrees(30, 0, 60, 90))));
      EXPECT_FALSE(leaves_known_range(outside(model.validity, 0.532, in_degrees(30, 0, 40, 90))));
    }
  }
}

TEST(NotMeasured, ElementsAtOneWavelengthAreAnExtrapolationThere) {
  std::vector<Sample> samples =
      simulate(material("ptfe"), std::array{0.351, 0.532, 0.633}, random_geometries(200, 3), 0, 1);
  for (Sample& sample : samples)
    if (sample.wavelength < 0.4) sample = without(all_but_f11, {sample})[0];
  const Model model = fit(samples, {Family::isotropic, {2, 1}}).model;
  EXPECT_TRUE(leaves_known_range(outside(model.validity, 0.351, in_degrees(30, 0, 40, 90))));
  EXPECT_FALSE(leaves_known_range(outside(model.validity, 0.532, in_degrees(30, 0, 40, 90))));
}

TEST(NotMeasured, ElementsThatOthersDoNotDetermineAreUnknownAndNotZero) {
  // Reciprocity ties 31 to 13 in the isotropic basis, through rotations; the published sets do not turn their modes.
  const Elements first_row = 0x000f;
  const Model model = fit(without(~first_row, of_ptfe()), {Family::germer2017, {3, 2}}).model;
  for (const std::size_t e : {4UL, 8UL, 12UL, 5UL, 15UL}) EXPECT_TRUE(model.not_measured[e]) << e;
  for (const std::size_t e : {0UL, 1UL, 2UL, 3UL}) EXPECT_FALSE(model.not_measured[e]) << e;
  EXPECT_EQ(model_from_json(to_json(model), "model.json").not_measured, model.not_measured);
  EXPECT_TRUE(fit(without(~first_row, of_ptfe()), {Family::isotropic, {3, 2}}).model.not_measured.count() == 9);
}

TEST(NotMeasured, ElementsDoNotTakeOthersWithThemWhereAxesTurnByARightAngle) {
  const Elements s_and_p = 0x0033;
  const std::vector<Sample> samples =
      without(~s_and_p, simulate(material("ptfe-532"), std::array{0.532}, germer2017_grid(), 0, 1));  // phi_i = 180
  const Model model = fit(samples, {Family::germer2017, {3, 2}}).model;
  EXPECT_EQ(model.not_measured & s_and_p, Elements{});
  const Model anisotropic = [&] {
    FitOptions options;
    options.minimum_norm = true;
    return fit(samples, {Family::anisotropic, {3, 2}}, options).model;
  }();
  const Geometry in_plane = in_degrees(45, 180, 30, 0), out_of_plane = in_degrees(45, 180, 30, 40);
  for (const Geometry& g : {in_plane, out_of_plane}) {
    const Mueller f = prepare(anisotropic, 0.532).evaluate(g, Frame::sp),
                  u = standard_uncertainty(prepare_uncertainty(anisotropic, 0.532).evaluate(g, Frame::sp));
    EXPECT_EQ(unknown_elements(f), unknown_elements(u));
    EXPECT_EQ((unknown_elements(f) & s_and_p).none(), g == in_plane);
  }
}

TEST(NotMeasured, ElementsAreKeptByModelFiles) {
  for (const bool of_sample : {false, true}) {
    const std::vector<Sample> samples = without(row_and_column_4, of_ptfe());
    const Model model = (of_sample ? fit_sample(samples) : fit(samples, {Family::isotropic, {3, 2}})).model;
    const Model read = model_from_json(to_json(model), "model.json");
    EXPECT_EQ(read.not_measured, row_and_column_4);
    EXPECT_EQ(to_json(read), to_json(model));
  }
}

TEST(NotMeasured, ElementsAreNotCompared) {
  const std::vector<Sample> all = of_ptfe(), some = without(row_and_column_4, all);
  const Comparison found = compare(material("ptfe-532"), some), of_all = compare(material("ptfe-532"), all);
  for (std::size_t e = 1; e < 16; ++e) {
    EXPECT_EQ(found.normalized[e].samples, row_and_column_4[e] ? 0 : 300);
    EXPECT_EQ(found.normalized[e].rms, row_and_column_4[e] ? 0 : of_all.normalized[e].rms);
  }
  const Model model = fit(some, {Family::isotropic, {3, 2}}).model;
  EXPECT_EQ(compare(model, all).normalized[15].samples, 0);
  EXPECT_EQ(compare(model, all).normalized[1].samples, 300);
}

TEST(NotMeasured, F11IsRefused) {
  std::vector<Sample> samples = of_ptfe();
  for (Sample& sample : samples) sample.f11 = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message_of([&] { fit(samples); }), "f11 is not measured in any sample");
  samples = of_ptfe();
  samples[3].f11 = std::numeric_limits<double>::quiet_NaN();
  samples[3].normalized.elements.fill(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(message_of([&] { fit(samples); }), "sample 4: nothing is measured");
}

TEST(NotMeasured, ModelsWithModesOfTheirOwnElementsAreRefused) {
  Model model = random_model(Family::isotropic, {2, 2}, 0, 1);
  model.not_measured.set(15);
  EXPECT_EQ(message_of([&] { prepare(model, 0.5); }),
            "model: elements are said not to be measured, but their block has modes");
}

// s and p of the source with a receiver of all light tell of 11 and 12: 13, 21 and 31 follow by rotation and reciprocity. f11 is as
// it was; u grows with what is not read, and holds: of one truth 95 % are less than 2 u off, some more since u is generous.
TEST(NotMeasured, PartsOfABlockHaveTheUncertaintyOfTheSample) {
  const std::vector<Sample> all = of_ptfe();
  const Model whole = fit_sample(all, {Family::isotropic, {5, 3}}).model, truth = material("ptfe-532");
  const FitResult fitted = fit_sample(without(Elements(0xfffc), all), {Family::isotropic, {5, 3}});
  ASSERT_TRUE(fitted.model.posterior) << fitted.warnings[0];
  EXPECT_EQ(fitted.model.posterior->data().unread, Elements(0x0114));  // 13, 21, 31
  EXPECT_EQ(fitted.model.blocks[0].coefficients, whole.blocks[0].coefficients);
  const PreparedUncertainty of_part = prepare_uncertainty(fitted.model, 0.532),
                            of_whole = prepare_uncertainty(whole, 0.532);
  const PreparedModel found = prepare(fitted.model, 0.532), true_model = prepare(truth, 0.532);
  int within = 0, count = 0;
  double growth = 0;
  for (const Geometry& g : random_geometries(200, 8, radians(70))) {
    const Mueller m = normalized(found.evaluate(g)), t = normalized(true_model.evaluate(g)),
                  u = standard_uncertainty(of_part.normalized(g)),
                  before = standard_uncertainty(of_whole.normalized(g));
    for (const std::size_t e : {1u, 2u, 4u, 8u}) {
      within += std::abs(m.elements[e] - t.elements[e]) < 2 * u.elements[e];
      growth += u.elements[e] / before.elements[e] / 800;
      ++count;
    }
  }
  EXPECT_GT(within, 0.95 * count);
  EXPECT_GT(growth, 1.1);
  EXPECT_LT(growth, 3);  // four readings are one: 2, where all columns are determined
}

// 22 alone gives no imaginary part of its block, which the arms of a goniometer mix into it.
TEST(NotMeasured, PartsOfABlockThatLeaveTheOthersOpenHaveTheUncertaintyOfTheSample) {
  for (const std::size_t e : {5UL, 6UL, 10UL}) {
    const Elements kept = Elements(1) | Elements(1UL << e);
    const FitResult fitted = fit_sample(without(~kept, of_ptfe()));
    ASSERT_TRUE(fitted.model.posterior) << fitted.warnings[0];
    EXPECT_FALSE(fitted.model.not_measured[e]);
    EXPECT_TRUE(fitted.model.not_measured[e == 6 ? 5 : 9]);
  }
}

// Three planes of a goniometer: few modes of 12 give 13, 21 and 31, more do not, and what they are then no reading says.
TEST(NotMeasured, PartsOfABlockGiveTheOthersAtTheDefaultOrdersOrNotAtAll) {
  std::vector<Geometry> planes;
  for (int i = 0; i <= 60; i += 15)
    for (int plane = 0; plane <= 90; plane += 45)
      for (int r = -70; r <= 70; r += 10) planes.push_back(in_degrees(i, 0, std::abs(r), plane + (r < 0 ? 0 : 180)));
  const std::vector<Sample> samples =
      without(Elements(0xfffc), simulate(material("ptfe-532"), std::array{0.532}, planes, 0.004, 1));
  const Basis few{Family::isotropic, {4, 2}};
  EXPECT_EQ(fit(samples, few).model.not_measured & Elements(0x0114), Elements());
  const Model model = fit_sample(samples, few).model;
  ASSERT_TRUE(model.posterior);
  EXPECT_EQ(model.not_measured & Elements(0x0116), Elements(0x0114));
}

TEST(NotMeasured, PartsOfABlockAreKeptInTheFileOfAModel) {
  const Model model = fit_sample(without(Elements(0xfffc), of_ptfe()), {Family::isotropic, {5, 3}}).model;
  const Folder folder;
  save_model(folder / "part.json", model);
  const Model again = load_model(folder / "part.json");
  EXPECT_EQ(again.posterior->data().unread, model.posterior->data().unread);
  const Geometry g = in_degrees(45, 0, 30, 150);
  const MuellerCovariance u = prepare_uncertainty(model, 0.532).evaluate(g),
                          u_again = prepare_uncertainty(again, 0.532).evaluate(g);
  for (const std::size_t e : {0u, 1u, 2u, 4u, 8u}) EXPECT_EQ(u_again(e, e), u(e, e));
}

TEST(NotMeasured, ADeclaredErrorThatANoiseFitHasNoPlaceForIsSaidToBeMissing) {
  std::vector<Sample> samples = of_ptfe();
  for (Sample& sample : samples) sample.normalized(0, 3) = sample.normalized(3, 0) = 0;
  FitOptions options;
  options.declared.scale = 0.003;
  const FitResult fitted = fit_sample(samples, {}, options);
  EXPECT_TRUE(fitted.warnings[0].ends_with("what was declared is not in them: give it with --term later"));
}

// Their variance is none, and the evidence of the mixed model has no largest value.
TEST(NotMeasured, ZerosInPlaceOfElementsMakeTheUncertaintyThatOfTheNoise) {
  std::vector<Sample> samples = of_ptfe();
  for (Sample& sample : samples) sample.normalized(0, 3) = sample.normalized(3, 0) = 0;
  const FitResult fitted = fit_sample(samples);
  EXPECT_FALSE(fitted.model.posterior);
  ASSERT_FALSE(fitted.warnings.empty());
  EXPECT_NE(fitted.warnings[0].find("some elements are exactly 0 in all samples"), std::string::npos)
      << fitted.warnings[0];
  EXPECT_TRUE(std::isfinite(prepare_uncertainty(fitted.model, 0.532).evaluate(in_degrees(45, 0, 30, 150))(0, 0)));
}

// 33 and its like are free there, and unknown; f11, 12, 21 and 22 are what was measured.
TEST(NotMeasured, ElementsAreNoReasonToCallTheOthersFree) {
  std::vector<Geometry> plane;
  for (int i = 0; i <= 75; i += 15)
    for (int r = -75; r <= 75; r += 5) plane.push_back(in_degrees(i, 0, std::abs(r), r < 0 ? 0 : 180));
  const std::vector<Sample> samples =
      without(Elements(0xffcc), simulate(material("ptfe-532"), std::array{0.532}, plane, 0.006, 1));
  FitOptions options;
  options.minimum_norm = true;
  const PreparedUncertainty u = prepare_uncertainty(fit(samples, {}, options).model, 0.532);
  EXPECT_TRUE(u.estimable(in_degrees(45, 0, 30, 180)));
  EXPECT_FALSE(u.estimable(in_degrees(45, 0, 30, 90)));
}

// ---- published measurements -----------------------------------------------------------------------------------------

TEST(NotMeasured, ElementsOfThePublishedGridLeaveTheBlocksOfTheOthersAsTheyAre) {
  if (published("PTFE.data.csv").empty()) GTEST_SKIP() << absent("PTFE.data.csv");
  const std::vector<Sample> all = grid_at(0.532);
  const Model whole = fit(all).model;
  for (const Elements& elements : {all_but_f11, row_and_column_4}) {
    const Model model = fit(without(elements, all)).model;
    EXPECT_EQ(model.blocks.size(), elements == all_but_f11 ? 1u : 3u);  // 11; and 12,13,21,31 and 22,23,32,33
    expect_same_blocks(model, whole);
  }
}

// A noiseless model and other elements missing in each sample: what is left of 1500 directions determines every coefficient.
// In the frames sp and scattering_plane the rows of the model are turned.
TEST(NotMeasured, ElementsOfAnyKindInAnyFrameLeaveANoiselessModelToBeFound) {
  const Model truth = material("ptfe-532");
  for (const Frame frame : frames) {
    std::vector<Sample> samples = simulate(truth, std::array{0.532}, random_geometries(1500, 7), 0, 1);
    std::mt19937_64 engine(11);
    std::bernoulli_distribution missing(0.3);
    for (Sample& sample : samples) {
      sample.normalized = change_frame(sample.normalized, sample.geometry, Frame::xy, frame);
      for (std::size_t e = 1; e < 16; ++e)
        if (missing(engine)) sample.normalized.elements[e] = std::numeric_limits<double>::quiet_NaN();
      sample = from_frame(sample, frame);
    }
    const Model found = fit(samples, {truth.family, orders(truth)}).model;
    for (std::size_t b = 0; b < truth.blocks.size(); ++b)
      for (std::size_t k = 0; k < truth.blocks[b].coefficients.size(); ++k)
        EXPECT_NEAR(found.blocks[b].coefficients[k], truth.blocks[b].coefficients[k], 1e-11)
            << to_string(frame) << ' ' << truth.blocks[b].block.name << ' ' << k;
  }
}

TEST(NotMeasured, RowsTurnWhereBlocksHoldAllThatRotationMixes) {
  for (const Family family : {Family::isotropic, Family::germer2017, Family::anisotropic}) {
    bool together = true;
    for (const Block& block : blocks(family, {7, 4})) {
      Elements elements;
      for (const Element& element : block.elements) elements.set(element.index());
      together = together && turned_into(elements) == elements;
    }
    EXPECT_EQ(rows_turn(family), together) << to_string(family);
  }
}

namespace {

/// The samples of xy, whole, as if they had been measured in another frame, where parts of each are lost.
std::vector<Sample> in_frame(std::vector<Sample> samples, Frame frame, const auto& lose) {
  for (Sample& sample : samples) {
    sample.normalized = change_frame(sample.normalized, sample.geometry, Frame::xy, frame);
    lose(sample.normalized);
    sample = from_frame(sample, frame);
  }
  return samples;
}

}  // namespace

// Intensities of s and p are four elements of sixteen, and leave 4 and 10 combinations of modes open that do not show in them.
// Five samples of all linear states settle those; alone they have 20 rows for 24 and 30 modes.
TEST(NotMeasured, StatesSAndPOutOfPlaneCountBesideAFewSamplesOfAllLinearStates) {
  const Model truth = material("ptfe-532");
  const std::vector<Sample> whole = simulate(truth, std::array{0.532}, random_geometries(1500, 7), 0, 1);
  std::size_t sample = 0;
  const std::vector<Sample> samples = in_frame(whole, Frame::sp, [&](Mueller& m) {
    const bool linear = sample++ < 5;
    for (std::size_t e = 1; e < 16; ++e)
      if (row_and_column_4[e] || (!linear && e != 1 && e != 4 && e != 5))
        m.elements[e] = std::numeric_limits<double>::quiet_NaN();
  });
  const Basis basis{truth.family, orders(truth)};
  const FitResult fitted = fit(samples, basis);
  for (const std::size_t e : {0U, 1U, 4U, 5U}) EXPECT_EQ(fitted.elements[e].rows, 1500) << e;
  for (const std::size_t e : {2U, 6U, 8U, 9U, 10U}) EXPECT_EQ(fitted.elements[e].rows, 5) << e;
  EXPECT_EQ(fitted.model.not_measured, row_and_column_4);
  const PreparedModel found = prepare(fitted.model, 0.532), expected = prepare(truth, 0.532);
  for (const Geometry& g : random_geometries(300, 8, radians(70))) {
    const Mueller a = found.evaluate(g), b = expected.evaluate(g);
    for (const std::size_t e : {0U, 1U, 2U, 4U, 5U, 6U, 8U, 9U, 10U})
      EXPECT_NEAR(a.elements[e], b.elements[e], 1e-9) << e;
  }
  EXPECT_EQ(fit(std::span(samples).subspan(5), basis).model.not_measured, all_but_f11);
}

// Alone they determine no element of xy but f11: the other blocks are unknown, and the fit says so, whatever it is asked for.
TEST(NotMeasured, StatesSAndPAloneOutOfPlaneLeaveF11AndSayWhy) {
  const std::vector<Sample> whole =
      simulate(material("ptfe-532"), std::array{0.532}, random_geometries(300, 7), 0.006, 1);
  const Elements s_and_p = 0x0033;
  for (const double turn : {0.0, radians(37)}) {
    std::vector<Sample> samples = whole;
    for (Sample& sample : samples) sample = turned(sample, turn - sample.geometry.incident.phi);
    samples = in_frame(samples, Frame::sp, [&](Mueller& m) {
      for (std::size_t e = 0; e < 16; ++e)
        if (!s_and_p[e]) m.elements[e] = std::numeric_limits<double>::quiet_NaN();
    });
    FitOptions options;
    options.minimum_norm = true;
    for (const FitResult& fitted : {fit(samples), fit(samples, {}, options), fit_sample(samples)}) {
      EXPECT_EQ(fitted.model.not_measured, all_but_f11);
      ASSERT_EQ(fitted.model.blocks.size(), 1u);
      EXPECT_EQ(fitted.solutions.size(), 1u);
      EXPECT_NE(
          std::ranges::find(fitted.warnings,
                            "the elements 12,13,21,31 are unknown: 12 and 21 alone, in the frame in which they were "
                            "measured, leave combinations of their modes open"),
          fitted.warnings.end());
    }
    FitAccumulator parts({}), sent({});
    parts.add(samples);
    sent.merge(FitAccumulator::from_state({}, parts.state()));
    EXPECT_EQ(sent.solve().model.not_measured, all_but_f11);
  }
}

// The mixed model takes samples in xy, and has no rows in other frames.
TEST(NotMeasured, AnElementOfAnotherFrameMakesTheUncertaintyThatOfTheNoise) {
  const std::vector<Sample> samples =
      in_frame(of_ptfe(), Frame::sp, [](Mueller& m) { m(2, 2) = std::numeric_limits<double>::quiet_NaN(); });
  const FitResult fitted = fit_sample(samples);
  EXPECT_FALSE(fitted.model.posterior);
  ASSERT_FALSE(fitted.warnings.empty());
  EXPECT_NE(fitted.warnings.back().find("some elements are missing in the frame in which they were measured"),
            std::string::npos);
  EXPECT_EQ(fitted.model.not_measured, Elements(0x0660));  // 22, 23, 32, 33: without 33 some modes are open
}

// A whole sample that says where it was measured has the same rows, turned: an orthogonal matrix within each block.
TEST(NotMeasured, RowsInAnotherFrameFitAsThoseInXy) {
  const std::vector<Sample> in_xy = of_ptfe();
  for (const Frame frame : {Frame::sp, Frame::scattering_plane})
    for (const Covariance covariance : {Covariance::residuals, Covariance::given})
      for (const Weights weights : {Weights::none, Weights::speckle, Weights::data}) {
        if (covariance == Covariance::given && weights != Weights::data) continue;
        std::vector<Sample> turned_rows = in_xy;
        std::vector<Sample> plain = in_xy;
        for (std::size_t s = 0; s < plain.size(); ++s) {
          plain[s].uncertainty.elements.fill(0.003 + 1e-5 * static_cast<double>(s));
          const Mueller m = change_frame(plain[s].normalized, plain[s].geometry, Frame::xy, frame);
          turned_rows[s].as_measured = std::make_shared<const AsMeasured>(AsMeasured{frame, m, plain[s].uncertainty});
          turned_rows[s].uncertainty = plain[s].uncertainty;
        }
        FitOptions options;
        options.covariance = covariance;
        const FitResult a = fit(plain, {}, options, weights), b = fit(turned_rows, {}, options, weights);
        for (std::size_t block = 0; block < a.model.blocks.size(); ++block) {
          const FittedBlock &x = a.model.blocks[block], &y = b.model.blocks[block];
          for (std::size_t k = 0; k < x.coefficients.size(); ++k)
            EXPECT_NEAR(x.coefficients[k], y.coefficients[k], 1e-11) << x.block.name << ' ' << to_string(weights);
          ASSERT_EQ(x.covariance.size(), y.covariance.size());
          for (std::size_t k = 0; k < x.covariance.size(); ++k) EXPECT_NEAR(x.covariance[k], y.covariance[k], 1e-13);
        }
      }
}

// What is lost is lost alone: seven elements of ten are missing, each by itself, and none of the others with it.
TEST(NotMeasured, AMissingElementCostsOnlyItself) {
  std::mt19937_64 engine(3);
  std::bernoulli_distribution missing(0.7);
  std::array<long, 16> known{};
  const auto lose = [&](Mueller& m) {
    for (std::size_t e = 1; e < 16; ++e)
      if (missing(engine))
        m.elements[e] = std::numeric_limits<double>::quiet_NaN();
      else
        ++known[e];
    ++known[0];
  };
  const Model truth = material("ptfe-532");
  const auto whole = simulate(truth, std::array{0.532}, random_geometries(1000, 9), 0.006, 1);
  for (const Covariance covariance : {Covariance::residuals, Covariance::sandwich}) {
    known = {};
    FitOptions options;
    options.covariance = covariance;
    const FitResult fitted = fit(in_frame(whole, Frame::sp, lose), {}, options, Weights::speckle);
    for (std::size_t e = 0; e < 16; ++e) EXPECT_EQ(fitted.elements[e].rows, known[e]) << e;
    EXPECT_TRUE(fitted.model.not_measured.none());
    // Its noise is known, 0.6 % at normal directions: u says what it is off by.
    const PreparedUncertainty u = prepare_uncertainty(fitted.model, 0.532);
    const PreparedModel found = prepare(fitted.model, 0.532), expected = prepare(truth, 0.532);
    double squares = 0, count = 0;
    for (const Geometry& g : random_geometries(200, 11, radians(65)))
      for (const std::size_t e : {1U, 2U, 5U, 6U, 10U, 15U}) {
        const double off = found.evaluate(g).elements[e] - expected.evaluate(g).elements[e];
        squares += off * off / u.evaluate(g)(e, e);
        ++count;
      }
    EXPECT_GT(squares / count, 0.5) << to_string(covariance);
    EXPECT_LT(squares / count, 2) << to_string(covariance);
  }
}

namespace {

/// f_ss, f_sp, f_ps, f_pp with their standard uncertainties: ½ (±1 …) of 11, 12, 21 and 22.
std::array<std::array<double, 2>, 4> channels(const Model& model, const Geometry& g) {
  const Mueller m = prepare(model, 0.532).evaluate(g);
  const MuellerCovariance v = prepare_uncertainty(model, 0.532).evaluate(g);
  std::array<std::array<double, 2>, 4> result{};
  for (std::size_t k = 0; k < 4; ++k) {
    const double in = k < 2 ? 1 : -1, out = k % 2 == 0 ? 1 : -1;
    const std::array<std::pair<std::size_t, double>, 4> parts{{{0, 1}, {1, in}, {4, out}, {5, in * out}}};
    double variance = 0;
    for (const auto& [e, sign] : parts) {
      result[k][0] += sign * m.elements[e] / 2;
      for (const auto& [o, other] : parts) variance += sign * other * v(e, o) / 4;
    }
    result[k][1] = std::sqrt(variance);
  }
  return result;
}

}  // namespace

// The rows of the grid in the plane of incidence, with 11, 12, 21 and 22 alone, as s and p intensities have them, and whole.
// Elements of the plane tell of the others of their block only through what they share: the curves differ by 0.04 % of f_ss
// rms and 0.44 of their standard uncertainty at most; at orders 5, 3, which miss structure, by 0.36 % and 97 % within 2 u.
TEST(NotMeasured, CircularAndDiagonalStatesLeaveTheCurvesOfSAndPWithinTheirUncertainty) {
  if (published("PTFE.data.csv").empty()) GTEST_SKIP() << absent("PTFE.data.csv");
  std::vector<Sample> plane = grid_at(0.532);
  std::erase_if(plane, [](const Sample& s) {
    return side(s.geometry) != plane_of_incidence || s.geometry.incident.theta < radians(1);
  });
  ASSERT_EQ(plane.size(), 90u);
  Elements others = all_but_f11;
  for (const std::size_t e : {1U, 4U, 5U}) others[e] = false;
  FitOptions options;
  options.minimum_norm = true;
  for (const Orders& order : {Orders{7, 4}, Orders{5, 3}}) {
    const Basis basis{Family::isotropic, order};
    const Model some = fit(without(others, plane), basis, options).model, all = fit(plane, basis, options).model;
    double squares = 0, largest = 0, normalized = 0, within = 0, count = 0;
    for (double theta_i = 15; theta_i <= 75; theta_i += 15)
      for (double theta_r = -75; theta_r <= 75; theta_r += 5) {
        const Geometry g = in_degrees(theta_i, 180, std::abs(theta_r), theta_r < 0 ? 180 : 0);
        const auto a = channels(some, g), b = channels(all, g);
        for (std::size_t k = 0; k < 4; ++k) {
          const double off = (a[k][0] - b[k][0]), relative = std::abs(off) / b[0][0];
          squares += relative * relative;
          largest = std::max(largest, relative);
          normalized = std::max(normalized, std::abs(off) / a[k][1]);
          within += std::abs(off) <= 2 * a[k][1] ? 1 : 0;
          ++count;
        }
      }
    const std::string name = std::to_string(order.f11) + "_" + std::to_string(order.other);
    RecordProperty("rms_" + name, std::to_string(std::sqrt(squares / count)));
    RecordProperty("largest_" + name, std::to_string(largest));
    RecordProperty("largest_of_u_" + name, std::to_string(normalized));
    RecordProperty("within_2u_" + name, std::to_string(within / count));
    EXPECT_GE(within / count, 0.95) << name;
    EXPECT_LE(normalized, order == Orders{} ? 1 : 3);
  }
}
