// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/quantities/answer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "given/cases.hpp"
#include "given/least_squares.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/polarization/gradients.hpp"
#include "mmbrdf/uncertainty/draws.hpp"

namespace mmbrdf {
namespace {

const Geometry oblique{{0.8, 0.3}, {0.5, 2.6}};
const std::vector<TypeBTerm> terms{{"plaque", ErrorOf::scale, 0.003}, {"dial", ErrorOf::calibration, 0.001}};

TEST(Answer, HasTheValueAndTheUncertaintyOfEachQuantity) {
  const Model model = least_squares("ptfe-532");
  const Answer a = Answers(model, {.terms = terms}).at(0.532).at(oblique);
  const PreparedModel prepared = prepare(model, 0.532);
  const Mueller m = prepared.evaluate(oblique, Frame::sp);
  const Budget b = budget(prepared, prepare_uncertainty(model, 0.532), terms, oblique, Frame::sp);
  EXPECT_EQ(a.elements, prepared.evaluate(oblique));
  ASSERT_EQ(a.quantities.size(), quantities(false).size());
  for (const Answered& q : a.quantities) {
    EXPECT_EQ(q.value, q.quantity->value(m, {})) << q.quantity->name;
    const double u = standard_uncertainty(q.quantity->gradient(m, {}), b.total);
    EXPECT_NEAR(q.uncertainty.value(), u, batch_error * u) << q.quantity->name;
  }
  EXPECT_EQ(a.estimable, true);
  EXPECT_TRUE(a.realizable);
}

// Errors of terms are independent of each other. Of a scale a ratio has no part, not even from rounding.
TEST(Answer, HasPartsThatAddUpInSquares) {
  const Answer a = Answers(least_squares("ptfe-532"), {.terms = terms}).at(0.532).at(oblique);
  for (const Answered& q : a.quantities) {
    ASSERT_EQ(q.parts.size(), 4U);
    EXPECT_EQ(q.parts.back(), q.uncertainty);
    const double squares = std::inner_product(q.parts.begin(), q.parts.end() - 1, q.parts.begin(), 0.0);
    EXPECT_NEAR(std::sqrt(squares), q.parts.back(), 1e-12 * q.parts.back()) << q.quantity->name;
    EXPECT_EQ(q.parts[1] == 0, q.quantity->unit.empty()) << q.quantity->name;
  }
}

TEST(Answer, TakesTheLightInTheFrameAskedFor) {
  const Model model = least_squares("ptfe-532");
  const Mueller m = prepare(model, 0.532).evaluate(oblique, Frame::sp);
  const Answer sp = Answers(model, {.frame = Frame::sp, .light = Stokes{1, 1, 0, 0}}).at(0.532).at(oblique);
  const Answer xy = Answers(model, {.light = rotator(0.3) * Stokes{1, 1, 0, 0}}).at(0.532).at(oblique);
  for (std::size_t i = 0; i < quantities().size(); ++i) {
    EXPECT_NEAR(*sp.quantities[i].value, quantities()[i].value(m, {1, 1, 0, 0}), 1e-14);
    EXPECT_NEAR(*xy.quantities[i].value, *sp.quantities[i].value, 1e-13) << quantities()[i].name;
  }
  const std::string refusal = message_of([&] { Answers(model, {.light = Stokes{1, 1, 1, 0}}); });
  EXPECT_TRUE(refusal.starts_with("light (1, 1, 1, 0) cannot exist")) << refusal;
}

TEST(Answer, HasIntervalsFromDrawsForWhatIsNotLinear) {
  const Answers answers(least_squares("ptfe-532"), {.draws = 200, .seed = 3});
  const Answer drawn = answers.at(0.532).at(oblique), first = Answers(answers.model()).at(0.532).at(oblique);
  for (std::size_t i = 0; i < drawn.quantities.size(); ++i) {
    const Answered &d = drawn.quantities[i], &f = first.quantities[i];
    EXPECT_EQ(d.low.has_value(), answers.has_interval(*d.quantity)) << d.quantity->name;
    EXPECT_EQ(d.parts, f.parts);
    EXPECT_TRUE(d.low || d.uncertainty == f.uncertainty) << d.quantity->name;
    EXPECT_TRUE(!d.low || (*d.low < *d.value && *d.value < *d.high)) << d.quantity->name;
    EXPECT_NEAR(*d.uncertainty / *f.uncertainty, 1, 0.2) << d.quantity->name;  // 1/√400 of 200 draws, four times
  }
}

TEST(Answer, HasNoValueWhereAQuantityHasNoMeaningAndNoUncertaintyWhereItIsNotKnown) {
  const Geometry grazing{{radians(90), 0}, {radians(90), 0}};
  Model dark = least_squares("ptfe-1064");
  for (double& coefficient : dark.blocks.front().coefficients) coefficient = -coefficient;
  const Answer a = Answers(dark).at(1.064).at(grazing);
  ASSERT_LT(a.elements(0, 0), 0);
  EXPECT_EQ(a.realizable, false);
  for (const Answered& q : a.quantities) EXPECT_EQ(q.value.has_value(), q.quantity->first_order) << q.quantity->name;
  Model silent = least_squares("ptfe-532");
  silent.blocks.front().covariance.clear();
  const Answers answers(silent, {.draws = 100});
  EXPECT_EQ(answers.unknown_uncertainty(), "the covariance of block 11 is not known");
  const Answer unknown = answers.at(0.532).at(oblique);
  EXPECT_FALSE(unknown.budget || unknown.uncertainties || unknown.estimable);
  for (const Answered& q : unknown.quantities) EXPECT_TRUE(q.value && !q.uncertainty && !q.low && q.parts.empty());
}

TEST(Answer, HasNoBudgetWhereATermHasNoLimit) {
  const Answers answers(least_squares("ptfe-532"), {.terms = {{"arm", ErrorOf::theta_r, 1e-3}}});
  EXPECT_TRUE(answers.at(0.532).at(oblique).budget);
  EXPECT_FALSE(answers.at(0.532).at({{0.8, 0}, {radians(90), 0}}).budget);
}

/// More than are worked out together, one of them without a limit of `arm`.
std::vector<Geometry> many() {
  std::vector<Geometry> result{{{0.8, 0}, {radians(90), 0}}};
  for (int i = 0; i < 70; ++i) result.push_back({{0.017 * i, 0.1 * i}, {1.3 - 0.013 * i, 3 - 0.2 * i}});
  return result;
}
const std::vector<TypeBTerm> with_arm{terms[0], terms[1], {"arm", ErrorOf::theta_r, 1e-3}};

TEST(Answer, OfManyGeometriesIsThatOfEach) {
  const PreparedAnswers here =
      Answers(least_squares("ptfe-532"), {.terms = with_arm, .light = Stokes{1, 0.5, 0.2, 0}, .draws = 75}).at(0.532);
  const std::vector<Geometry> geometries = many();
  const std::vector<Answer> answers = here.at(geometries);
  ASSERT_EQ(answers.size(), geometries.size());
  for (std::size_t g = 0; g < answers.size(); ++g) {
    const Answer one = here.at(geometries[g]);
    EXPECT_EQ(answers[g].elements, one.elements);
    EXPECT_EQ(answers[g].uncertainties, one.uncertainties);
    EXPECT_EQ(answers[g].budget.has_value(), g > 0);
    EXPECT_EQ(answers[g].estimable, one.estimable);
    for (std::size_t i = 0; i < one.quantities.size(); ++i) {
      const Answered &a = answers[g].quantities[i], &b = one.quantities[i];
      EXPECT_TRUE(a.value == b.value && a.uncertainty == b.uncertainty && a.low == b.low && a.high == b.high)
          << g << ' ' << b.quantity->name;
    }
  }
  EXPECT_THROW(here.at(std::vector<Geometry>{oblique, {{2, 0}, {0, 0}}}), std::invalid_argument);
}

// Of more draws than are worked out together.
TEST(Answer, HasTheDistributionOfTheMatricesThatAreDrawn) {
  constexpr int count = DrawnMatrices::together + 75;
  const Model model = least_squares("ptfe-532");
  const std::vector<PreparedModel> draws = Draws(model, count, 5).at(0.532);
  const PreparedModel prepared = prepare(model, 0.532);
  const std::vector<Geometry> geometries{oblique, {{0.1, 1}, {1.2, -2}}};
  const std::vector<Answer> answers =
      Answers(model, {.terms = terms, .draws = count, .seed = 5}).at(0.532).at(geometries);
  for (std::size_t g = 0; g < geometries.size(); ++g) {
    const std::vector<Mueller> matrices = drawn(draws, prepared, terms, geometries[g], Frame::sp, 5);
    for (const Answered& q : answers[g].quantities) {
      if (q.quantity->first_order) continue;
      std::vector<double> values;
      for (const Mueller& m : matrices) values.push_back(q.quantity->value(m, {}));
      const Distribution d = distribution(values);
      // Matrices differ by rounding, which a standard uncertainty of 1e-4 of the value makes 1e4 times as large.
      EXPECT_NEAR(q.uncertainty.value() / d.standard_deviation, 1, 1e4 * batch_error) << q.quantity->name;
      EXPECT_NEAR(q.low.value(), d.low, batch_error) << q.quantity->name;
      EXPECT_NEAR(q.high.value(), d.high, batch_error) << q.quantity->name;
    }
  }
}

TEST(Answer, WithoutPartsHasTheSameUncertainties) {
  const Model model = least_squares("ptfe-532");
  const std::vector<Geometry> geometries = many();
  const std::vector<Answer> with =
      Answers(model, {.frame = Frame::scattering_plane, .terms = with_arm}).at(0.532).at(geometries);
  const std::vector<Answer> without =
      Answers(model, {.frame = Frame::scattering_plane, .terms = with_arm, .parts = false}).at(0.532).at(geometries);
  for (std::size_t g = 0; g < geometries.size(); ++g) {
    const Answer &a = with[g], &b = without[g];
    EXPECT_FALSE(b.budget);
    ASSERT_EQ(a.uncertainties.has_value(), b.uncertainties.has_value());
    for (std::size_t e = 0; e < 16 && a.uncertainties; ++e)
      EXPECT_EQ(a.uncertainties->elements[e], b.uncertainties->elements[e]) << g << ' ' << e;
    for (std::size_t i = 0; i < a.quantities.size(); ++i) {
      EXPECT_TRUE(b.quantities[i].parts.empty());
      EXPECT_EQ(a.quantities[i].value, b.quantities[i].value);
      EXPECT_EQ(a.quantities[i].uncertainty, b.quantities[i].uncertainty) << g << ' ' << i;
    }
  }
}

/// As a measurement of a model has it, in the xy frame.
Sample sample_of(const Model& model) {
  const Mueller m = prepare(model, 0.532).evaluate(oblique);
  Sample sample{0.532, oblique, m(0, 0), normalized(m)};
  for (std::size_t e = 0; e < 16; ++e) sample.uncertainty.elements[e] = 1e-3 * static_cast<double>(1 + e);
  return sample;
}

TEST(Answer, OfASampleHasTheQuantitiesOfItsMatrix) {
  const Model model = least_squares("ptfe-532");
  const Sample sample = sample_of(model);
  const Answer of_model = Answers(model).at(0.532).at(oblique);
  const std::vector<Answered> measured = quantities_of(sample);
  const MuellerCovariance errors = change_frame(covariance(sample), oblique, Frame::xy, Frame::sp);
  const Mueller m = change_frame(measured_matrix(sample), oblique, Frame::xy, Frame::sp);
  ASSERT_EQ(measured.size(), of_model.quantities.size());
  for (std::size_t q = 0; q < measured.size(); ++q) {
    const Quantity& quantity = *measured[q].quantity;
    EXPECT_NEAR(measured[q].value.value(), of_model.quantities[q].value.value(), 1e-9)
        << quantity.name;  // roots near 0
    const double u = standard_uncertainty(quantity.gradient(m, {1, 0, 0, 0}), errors);
    EXPECT_NEAR(measured[q].uncertainty.value(), u, 1e-9 * u) << quantity.name;
  }
}

TEST(Answer, OfASampleKnowsNothingOfWhatNeedsAnUnmeasuredElementOrAnUnknownUncertainty) {
  const Model model = least_squares("ptfe-532");
  Sample sample = sample_of(model);
  sample.normalized(3, 3) = std::nan("");
  for (const Answered& a : quantities_of(sample))
    EXPECT_EQ(a.value.has_value(), !a.quantity->needs[15]) << a.quantity->name;
  sample.uncertainty = {};
  for (const Answered& a : quantities_of(sample)) EXPECT_FALSE(a.uncertainty) << a.quantity->name;
}

}  // namespace
}  // namespace mmbrdf
