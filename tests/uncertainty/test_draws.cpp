// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/uncertainty/draws.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "given/cases.hpp"
#include "given/least_squares.hpp"
#include "given/random_model.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/formats/projection.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/numerics/quadrature.hpp"
#include "mmbrdf/polarization/analysis.hpp"
#include "mmbrdf/polarization/gradients.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"
#include "mmbrdf/samples/simulation.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"

namespace mmbrdf {
namespace {

const Geometry oblique{{0.8, 0.3}, {0.5, 2.6}};

/// ∫ f11 cos θ_r dΩ_r, exact to rounding for order 7: 5 nodes in u = 1 − cos θ and 12 azimuths (theory 5.1).
double reflectance_of(const PreparedModel& model, const Direction& incident) {
  double sum = 0;
  constexpr int azimuths = 12;
  for (const Node& node : gauss_legendre(5))
    for (int a = 0; a < azimuths; ++a)
      sum += node.weight * (1 - node.x) * (2 * std::numbers::pi / azimuths) *
             model.f11({incident, {std::acos(1 - node.x), 2 * std::numbers::pi * a / azimuths}});
  return sum;
}

/// Of three wavelengths, with the reflectance of each from the same samples: variances alone, whose matrix is diagonal.
Model with_reflectances_of_its_own() {
  const Model truth = random_model(Family::isotropic, {3, 2}, 1, 3);
  return fit(simulate(truth, std::array{0.4, 0.6, 0.9}, random_geometries(100, 2), 0.01, 4),
             {Family::isotropic, {3, 2}})
      .model;
}
Model with_a_matrix_of_reflectances() {
  Model model = with_reflectances_of_its_own();
  const std::vector<double> v = model.reflectance.covariance;
  model.reflectance.covariance = {v[0], 0, 0, 0, v[1], 0, 0, 0, v[2]};
  return model;
}

// N = 2000 draws: the mean is uncertain by u / √N, and u itself by u / √(2N) = 1.6 %; four times that is allowed.
TEST(Draws, OfWhatIsLinearHaveTheFirstOrderUncertainty) {
  constexpr int count = 2000;
  const double of_mean = 4 / std::sqrt(count), of_deviation = 4 / std::sqrt(2.0 * count);
  const auto expect_first_order = [&](const Model& model, double wavelength) {
    const Draws draws(model, count, 1);
    const PreparedModel exact = prepare(model, wavelength);
    const PreparedUncertainty u = prepare_uncertainty(model, wavelength);
    const auto models = draws.at(wavelength);
    const auto expect = [&](const Distribution& found, double value, double uncertainty) {
      EXPECT_NEAR(found.mean, value, of_mean * uncertainty);
      EXPECT_NEAR(found.standard_deviation / uncertainty, 1, of_deviation);
      EXPECT_NEAR((found.high - found.low) / (2 * 1.96 * uncertainty), 1, 0.1);  // ends are of few values: ± 3 %
    };
    const Mueller m = exact.evaluate(oblique, Frame::sp);
    const Mueller first_order = standard_uncertainty(u.normalized(oblique, Frame::sp));
    for (const std::size_t e : {0u, 1u, 5u, 11u, 15u})
      expect(distribution(values(models,
                                 [&](const PreparedModel& draw) {
                                   const Mueller f = draw.evaluate(oblique, Frame::sp);
                                   return e == 0 ? f(0, 0) : f.elements[e] / f(0, 0);
                                 })),
             e == 0 ? m(0, 0) : m.elements[e] / m(0, 0), first_order.elements[e]);
    expect(distribution(values(models,
                               [](const PreparedModel& draw) {
                                 return reflectance_of(draw, {0.2, 0});
                               })),
           directional_hemispherical_reflectance(model, wavelength, {0.2, 0}),
           u.directional_hemispherical_reflectance({0.2, 0}));
  };
  ASSERT_EQ(with_reflectances_of_its_own().reflectance.covariance.size(), 3U);  // drawn along: else u(DHR) is another
  for (const double wavelength : {0.4, 0.8}) {
    expect_first_order(material("ptfe"), wavelength);
    expect_first_order(with_reflectances_of_its_own(), wavelength);
    expect_first_order(with_a_matrix_of_reflectances(), wavelength);
  }
}

TEST(Draws, RefuseAReflectanceWithoutVarianceThatVariesWithTheCoefficients) {
  Model model = with_reflectances_of_its_own();
  for (const double variance : {0.0, -1e-9}) {
    model.reflectance.covariance[1] = variance;
    EXPECT_THROW(require_semidefinite(model), std::invalid_argument);
    EXPECT_THROW(Draws{model}, std::invalid_argument);
  }
}

// A correlation of 2000 pairs is uncertain by up to 1 / √2000 = 0.022.
TEST(Draws, HaveTheFirstOrderCorrelations) {
  const Model model = least_squares("ptfe-532");
  const auto models = Draws(model, 2000, 2).at(0.532);
  const MuellerCovariance v = prepare_uncertainty(model, 0.532).evaluate(oblique, Frame::sp);
  const auto element = [&](std::size_t e) {
    return values(models, [e](const PreparedModel& draw) { return draw.evaluate(oblique, Frame::sp).elements[e]; });
  };
  const auto expected = [&](std::size_t e, std::size_t f) { return v(e, f) / std::sqrt(v(e, e) * v(f, f)); };
  ASSERT_GT(std::abs(expected(1, 4)), 0.1);
  EXPECT_NEAR(correlation(element(1), element(4)), expected(1, 4), 0.09);
  EXPECT_NEAR(correlation(element(5), element(10)), expected(5, 10), 0.09);
  EXPECT_NEAR(correlation(element(0), element(0)), 1, 1e-12);
}

TEST(Draws, OfTheSameSeedAreTheSameAndALongerListBeginsWithAShorter) {
  const Model model = least_squares("ptfe-532");
  const auto f11 = [](const PreparedModel& draw) { return draw.f11(oblique); };
  const auto few = values(Draws(model, 250, 7).at(0.532), f11), many = values(Draws(model, 500, 7).at(0.532), f11);
  const auto others = values(Draws(model, 250, 8).at(0.532), f11);
  for (std::size_t i = 0; i < few.size(); ++i) {
    EXPECT_EQ(few[i], many[i]);
    EXPECT_NE(few[i], others[i]);
  }
  EXPECT_EQ(few, values(Draws(model, 250, 7).at(0.532), f11));
}

Model with_covariance(Family family, double variance) {
  Model model = random_model(family, {3, 2}, 1, 5);
  for (FittedBlock& fitted : model.blocks) {
    const std::size_t size = fitted.coefficients.size();
    fitted.covariance.assign(size * size, 0);
    for (std::size_t i = 0; i < size; ++i) fitted.covariance[i * size + i] = variance;
    fitted.rank = static_cast<int>(size);
  }
  return model;
}

TEST(Draws, WithoutVarianceAreTheModelInEachFamilyAtEachWavelength) {
  for (const Family family : {Family::isotropic, Family::germer2017, Family::anisotropic})
    for (const double wavelength : {0.4, 1.3}) {
      Model model = with_covariance(family, 0);
      model.reflectance = {{0.4, 1.2}, {0.9, 0.8}};
      const Mueller exact = prepare(model, wavelength).evaluate(oblique, Frame::sp);
      for (const PreparedModel& draw : Draws(model, 2).at(wavelength)) {
        const Mueller difference = draw.evaluate(oblique, Frame::sp) - exact;
        for (const double element : difference.elements) EXPECT_NEAR(element, 0, 1e-14);
      }
    }
}

// Solutions of minimum norm have a singular covariance; what the data leave free does not vary.
TEST(Draws, OfASingularCovarianceAreFine) {
  const auto samples = simulate(material("ptfe-532"), std::array{0.532}, germer2017_grid(), 0.01, 1);
  const Model model = fit(samples, {Family::germer2017, {7, 4}}).model;
  ASSERT_LT(model.blocks[1].rank, static_cast<int>(model.blocks[1].coefficients.size()));
  const auto models = Draws(model, 500, 3).at(0.532);
  const auto f12 = values(models, [](const PreparedModel& draw) { return draw.evaluate(oblique)(0, 1); });
  const double u = standard_uncertainty(prepare_uncertainty(model, 0.532).evaluate(oblique)).elements[1];
  EXPECT_NEAR(distribution(f12).standard_deviation / u, 1, 4 / std::sqrt(1000.0));
}

TEST(Draws, RefuseACovarianceThatIsNotPositiveSemidefinite) {
  Model model = with_covariance(Family::isotropic, 1);
  EXPECT_NO_THROW(require_semidefinite(model));
  model.blocks[1].covariance[0] = -1e-3;
  const std::string expected =
      "the covariance of block 12,13,21,31 is not positive semidefinite: its eigenvalues are -0.001 to 1";
  EXPECT_EQ(message_of([&] { require_semidefinite(model); }), expected);
  EXPECT_EQ(message_of([&] { Draws{model}; }), expected);
  model.blocks[1].covariance[0] = -1e-10;  // of the largest: rounding
  EXPECT_NO_THROW(require_semidefinite(model));
}

TEST(Draws, NeedACovarianceACountAndAWavelength) {
  const Model model = least_squares("ptfe-532");
  EXPECT_EQ(message_of([&] { Draws{in_published_form(model)}; }), "the covariance of block 11 is not known");
  EXPECT_NO_THROW(require_semidefinite(in_published_form(model)));
  EXPECT_EQ(message_of([&] { Draws(model, 1); }), "count = 1, must be in 2...1000000");
  EXPECT_EQ(message_of([&] { Draws(model, 1'000'001); }), "count = 1000001, must be in 2...1000000");
  EXPECT_THROW(Draws(model, 2).at(-1), std::invalid_argument);
  const PreparedModel prepared = prepare(model, 0.532);
  EXPECT_EQ(message_of([&] { prepared.with(std::array{1.0}, 1); }), "1 coefficients, expected 142");
  EXPECT_EQ(message_of([&] { prepared.with(std::vector<double>(142, std::nan("")), 1); }),
            "a coefficient or the reflectance is not a number up to 1e+100");
}

// JCGM 101, 7.7: of M = 1000 values the symmetric interval goes from number 25 to number 975. The shortest one of
// squares begins near 0.
TEST(Distribution, HasTheIntervalsOfTheGuide) {
  std::vector<double> squares;
  for (int i = 1; i <= 1000; ++i) squares.push_back(static_cast<double>((i * 7 % 1009) * (i * 7 % 1009)));
  std::vector<double> sorted = squares;
  std::sort(sorted.begin(), sorted.end());
  const Distribution symmetric = distribution(squares);
  EXPECT_EQ(symmetric.low, sorted[24]);
  EXPECT_EQ(symmetric.high, sorted[974]);
  const Distribution shortest = distribution(squares, 0.95, Interval::shortest);
  EXPECT_EQ(shortest.low, sorted[0]);
  EXPECT_EQ(shortest.high, sorted[950]);
  const Distribution two = distribution(std::array{1.0, 3.0});
  EXPECT_EQ(two.mean, 2);
  EXPECT_NEAR(two.standard_deviation, std::sqrt(2), 1e-15);
  EXPECT_EQ(two.low, 1);
  EXPECT_EQ(two.high, 3);
}

// Squares crowd at the low end, and what is below zero of them at the high end.
TEST(Distribution, HasTheShortestIntervalMirroredWhereTheValuesAre) {
  for (const int count : {2, 3, 20, 1000}) {
    std::vector<double> squares, mirrored;
    for (int i = 1; i <= count; ++i) squares.push_back(i * i), mirrored.push_back(-i * i);
    const Distribution low = distribution(squares, 0.5, Interval::shortest),
                       high = distribution(mirrored, 0.5, Interval::shortest);
    EXPECT_EQ(low.low, 1) << count;
    EXPECT_EQ(high.low, -low.high) << count;
    EXPECT_EQ(high.high, -low.low) << count;
  }
}

/// Draws of different shapes: some have more values far from the mean than lie beyond an interval, some have fewer.
std::vector<std::vector<double>> shapes() {
  std::vector<std::vector<double>> result(4);
  for (int i = 0; i < 997; ++i) {
    const double even = i * 7 % 997 / 997.0;
    result[0].push_back(even);
    result[1].push_back(std::log((even + 0.0005) / (1 - even)));
    result[2].push_back(i == 500 ? 1e9 : even);
    result[3].push_back(even < 0.3 ? -1 : 1e-3 * even);
  }
  return result;
}

TEST(Distribution, HasAsManyValuesBelowAsAboveWhateverItsShape) {
  for (const std::vector<double>& values : shapes())
    for (const double coverage : {0.01, 0.5, 0.683, 0.95, 0.999}) {
      const Distribution d = distribution(values, coverage);
      std::vector<double> sorted = values;
      std::ranges::sort(sorted);
      const auto steps = static_cast<std::size_t>(coverage * 997 + 0.5), low = (997 - steps + 1) / 2 - 1;
      EXPECT_EQ(d.low, sorted[low]) << coverage;
      EXPECT_EQ(d.high, sorted[low + steps]) << coverage;
      EXPECT_NEAR(d.mean, std::accumulate(values.begin(), values.end(), 0.0) / 997, 1e-13 * std::abs(sorted.back()));
    }
}

// The mean of ten times 0.1 is not 0.1.
TEST(Distribution, OfWhatDoesNotVaryHasNoSpreadAndNoCorrelation) {
  const std::vector<double> tenths(10, 0.1), sevenths(10, 0.7), large{1.7e308, 1.7e308, -1.7e308};
  EXPECT_EQ(distribution(tenths).standard_deviation, 0);
  EXPECT_EQ(correlation(tenths, sevenths), 0);
  EXPECT_TRUE(std::isfinite(distribution(large).standard_deviation));
}

TEST(Distribution, OfTheSmallestNumbersThereAreIsANumber) {
  constexpr double smallest = std::numeric_limits<double>::denorm_min();
  const Distribution d = distribution(std::array{0.0, 2 * smallest});
  EXPECT_NEAR(d.mean, smallest, smallest);
  EXPECT_NEAR(d.standard_deviation, smallest, smallest);
}

TEST(Distribution, RefusesWhatHasNone) {
  EXPECT_EQ(message_of([] { distribution(std::array{1.0}); }), "1 values, at least 2 are needed");
  EXPECT_EQ(message_of([] { distribution(std::array{1.0, std::nan("")}); }), "the value nan is not finite");
  EXPECT_EQ(message_of([] { distribution(std::array{1.0, 2.0}, 1); }), "coverage 1 is not between 0 and 1");
  EXPECT_EQ(message_of([] { correlation(std::array{1.0, 2.0}, std::array{1.0}); }), "2 and 1 values");
  EXPECT_EQ(correlation(std::array{1.0, 2.0}, std::array{5.0, 5.0}), 0);
  EXPECT_EQ(correlation(std::array{1.0, 2.0}, std::array{5.0, 3.0}), -1);
}

}  // namespace
}  // namespace mmbrdf
