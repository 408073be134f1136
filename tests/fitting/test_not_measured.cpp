// SPDX-License-Identifier: BSD-3-Clause
// What was not measured is unknown, not zero: samples.hpp, fit.hpp, model.hpp.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "given/cases.hpp"
#include "given/files.hpp"
#include "given/halton.hpp"
#include "given/not_measured.hpp"
#include "given/published_samples.hpp"
#include "given/random_model.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/files/model_file.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/mixed/plan.hpp"
#include "mmbrdf/model/batch.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/quantities/answer.hpp"
#include "mmbrdf/samples/comparison.hpp"
#include "mmbrdf/samples/simulation.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"

using namespace mmbrdf;

namespace {

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

// Of 22 alone, which axes that turn mix with 23, 32 and 33: in the plane of incidence those of sp are those of xy.
TEST(NotMeasured, IsNaNInBatchesWhereTheAxesOfThePlaceMixIt) {
  Model model = random_model(Family::isotropic, {2, 2}, 0, 1);
  model.not_measured = Elements(1U << 5U);
  const PreparedModel prepared = prepare(model, 0.5);
  const std::vector<Geometry> geometries{{{0.5, 0}, {0.7, std::numbers::pi}}, {{0.5, 0.4}, {0.7, 1.4}}};
  for (const Frame frame : frames) {
    std::vector<Mueller> out(2);
    prepared.evaluate(geometries, frame, out);
    EXPECT_EQ(unknown_elements(out[0]), Elements(1U << 5U));
    EXPECT_EQ(unknown_elements(out[1]), frame == Frame::xy ? Elements(1U << 5U) : Elements(0x0660));
    for (std::size_t q : {0U, 1U})
      EXPECT_EQ(unknown_elements(prepared.evaluate(geometries[q], frame)), unknown_elements(out[q])) << q;
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

// A model of all modes behind its posterior, which has nothing left out on top; the rest is rounding.
TEST(NotMeasured, PartsOfABlockHaveTheUncertaintyThatAPlanLikeTheirFitExpects) {
  const std::vector<Sample> samples = without(Elements(0x0010), of_ptfe());
  const Model model = fit_sample(samples, {Family::isotropic, {12, 10}}).model;
  ASSERT_EQ(model.posterior->data().unread, Elements(0x0010));  // 21
  const PreparedUncertainty of_fit = prepare_uncertainty(model, 0.532);
  double squares = 0;
  for (const Geometry& g : halton_directions(1000, 0, 70)) {
    const Mueller u = standard_uncertainty(of_fit.normalized(g));
    for (const std::size_t e : {1u, 2u, 4u, 8u}) squares += u.elements[e] * u.elements[e] / 4000;
  }
  std::vector<Geometry> design;
  for (const Sample& sample : samples) design.push_back(sample.geometry);
  const PlanTarget block{PlanTarget::Kind::block, 1, {}};
  const double planned = expected_uncertainties(components_of(*model.posterior, 0.532), design, {&block, 1})[0];
  EXPECT_NEAR(planned / std::sqrt(squares), 1, 1e-6);
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
