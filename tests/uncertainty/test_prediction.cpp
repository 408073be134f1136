// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/uncertainty/prediction.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "given/cases.hpp"
#include "given/least_squares.hpp"
#include "given/published.hpp"
#include "given/random_model.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/files/model_file.hpp"
#include "mmbrdf/files/samples_file.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/fitting/weights.hpp"
#include "mmbrdf/formats/projection.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"
#include "mmbrdf/samples/simulation.hpp"

namespace mmbrdf {
namespace {

constexpr std::array every_frame{Frame::xy, Frame::sp, Frame::scattering_plane};

/// The common part of the errors of the coefficients below.
double common(std::size_t i) { return 0.3 * std::sin(2.0 * static_cast<double>(i)); }
double own_variance(std::size_t i) { return 1 + 0.5 * std::cos(static_cast<double>(i)); }

/// The same of the values of the reflectance table.
double common_of_reflectance(std::size_t k) { return 0.01 * std::cos(3.0 * static_cast<double>(k)); }
constexpr double own_variance_of_reflectance = 4e-4;

/// A small model of two powers. The covariance of a block is diag(own_variance) + common commonᵀ; that of block 11
/// goes on over the values of the reflectance table.
Model with_correlated_coefficients(Family family) {
  Model model;
  model.family = family;
  model.powers = 1;
  model.reflectance = {{0.4, 0.8}, {0.9, 0.7}};
  for (const Block& block : blocks(family, {3, 2})) {
    const std::size_t size = 2 * block.modes.size();
    FittedBlock fitted{block, {}, std::vector<double>(size * size), static_cast<int>(size), 1};
    for (std::size_t i = 0; i < size; ++i) {
      fitted.coefficients.push_back(0.05 * std::sin(1.0 + 1.7 * static_cast<double>(i)));
      for (std::size_t j = 0; j < size; ++j)
        fitted.covariance[i * size + j] = common(i) * common(j) + (i == j ? own_variance(i) : 0);
    }
    if (block.name == "11") fitted.coefficients[0] = 2;
    model.blocks.push_back(fitted);
  }
  ReflectanceTable& table = model.reflectance;
  for (std::size_t k = 0; k < table.values.size(); ++k) {
    for (std::size_t l = 0; l < table.values.size(); ++l)
      table.covariance.push_back(common_of_reflectance(k) * common_of_reflectance(l) +
                                 (k == l ? own_variance_of_reflectance : 0));
    for (std::size_t i = 0; i < model.blocks[0].coefficients.size(); ++i)
      table.covariance_with_f11.push_back(common_of_reflectance(k) * common(i));
  }
  return model;
}

void add_square(MuellerCovariance& sum, const Mueller& slope, double variance) {
  for (std::size_t e = 0; e < 16; ++e)
    for (std::size_t other = 0; other < 16; ++other)
      sum(e, other) += variance * slope.elements[e] * slope.elements[other];
}

/// ∂M/∂a V (∂M/∂a)ᵀ with central differences, which are exact for what is linear or bilinear in a.
MuellerCovariance by_differences(const Model& model, const auto& predicted) {
  MuellerCovariance result;
  constexpr double step = 0.01;
  const auto slope = [&](const auto& parameter) {
    Model up = model, down = model;
    parameter(up) += step;
    parameter(down) -= step;
    return (1 / (2 * step)) * (predicted(up) - predicted(down));
  };
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    Mueller together;
    for (std::size_t i = 0; i < model.blocks[b].coefficients.size(); ++i) {
      const Mueller one = slope([&](Model& m) -> double& { return m.blocks[b].coefficients[i]; });
      add_square(result, one, own_variance(i));
      together = together + common(i) * one;
    }
    for (std::size_t k = 0; b == 0 && k < model.reflectance.values.size(); ++k) {
      const Mueller one = slope([&](Model& m) -> double& { return m.reflectance.values[k]; });
      add_square(result, one, own_variance_of_reflectance);
      together = together + common_of_reflectance(k) * one;
    }
    add_square(result, together, 1);
  }
  return result;
}

void expect_equal(const MuellerCovariance& found, const MuellerCovariance& expected) {
  const double scale = *std::max_element(expected.values.begin(), expected.values.end());
  for (std::size_t i = 0; i < 256; ++i)  // differences of numbers of order 1, divided by 0.02
    EXPECT_NEAR(found.values[i], expected.values[i], 1e-11 * scale) << i;
}

TEST(Uncertainty, IsTheCovarianceOfTheCoefficientsThroughTheDerivativesOfThePrediction) {
  const Geometry geometry{{0.9, 0.4}, {0.6, 2.1}};
  for (const Family family : {Family::isotropic, Family::germer2017, Family::anisotropic}) {
    const Model model = with_correlated_coefficients(family);
    const PreparedUncertainty u = prepare_uncertainty(model, 0.5);
    for (const Frame frame : every_frame) {
      const auto absolute = [&](const Model& m) { return prepare(m, 0.5).evaluate(geometry, frame); };
      const auto relative = [&](const Model& m) {
        const Mueller f = absolute(m);
        Mueller result = normalized(f);
        result(0, 0) = f(0, 0);
        return result;
      };
      expect_equal(u.evaluate(geometry, frame), by_differences(model, absolute));
      expect_equal(u.covariance(u.gradient(geometry, frame), u.gradient(geometry, frame)), u.evaluate(geometry, frame));
      expect_equal(u.normalized(geometry, frame), by_differences(model, relative));
    }
  }
}

TEST(Uncertainty, OfAWeightedSumHasTheCorrelationsBetweenGeometries) {
  const std::vector<WeightedGeometry> sum{{{{0.9, 0.4}, {0.6, 2.1}}, 0.7}, {{{0.2, -1}, {1.1, 0.3}}, -1.5}};
  for (const Family family : {Family::isotropic, Family::germer2017, Family::anisotropic}) {
    const Model model = with_correlated_coefficients(family);
    const PreparedUncertainty u = prepare_uncertainty(model, 0.5);
    for (const Frame frame : every_frame) {
      const MuellerGradient gradient = u.gradient(sum, frame);
      expect_equal(u.covariance(gradient, gradient), by_differences(model, [&](const Model& m) {
                     const PreparedModel prepared = prepare(m, 0.5);
                     return sum[0].weight * prepared.evaluate(sum[0].geometry, frame) +
                            sum[1].weight * prepared.evaluate(sum[1].geometry, frame);
                   }));
    }
    EXPECT_THROW(u.covariance(MuellerGradient{}, u.gradient(sum)), std::invalid_argument);
  }
}

TEST(Uncertainty, OfTheReflectanceIsThatOfItsIntegral) {
  const Model model = with_correlated_coefficients(Family::isotropic);
  const Direction incident{0.7, 0.3};
  const auto reflectance = [&](const Model& m) {
    return diagonal(directional_hemispherical_reflectance(m, 0.5, incident), 0, 0, 0);
  };
  EXPECT_NEAR(prepare_uncertainty(model, 0.5).directional_hemispherical_reflectance(incident),
              std::sqrt(by_differences(model, reflectance)(0, 0)), 1e-12);
}

/// One repetition: what a fit to new noise predicts, and how sure it says to be.
struct Prediction {
  Mueller value, uncertainty;
};

// 200 repetitions with noise of the speckle law, fitted with the weights that belong to it. The ratio of observed and
// predicted standard deviation scatters by 0.05 for one element at one geometry, and by less for the mean of ten.
TEST(Uncertainty, PredictsTheScatterOfRepeatedMeasurementsAndContainsTheTruth) {
  constexpr int repetitions = 200;
  constexpr double speckle = 0.01;
  const Model truth = material("ptfe-532");
  const auto grid = germer2017_grid();
  const auto asked = random_geometries(10, 3, radians(70));
  const PreparedModel exact = prepare(truth, 0.532);
  const double true_reflectance = directional_hemispherical_reflectance(truth, 0.532, {0, 0});
  std::vector<Mueller> weights;
  std::array<double, 17> squares{}, predicted{}, inside_interval{};
  for (int seed = 1; seed <= repetitions; ++seed) {
    const auto samples = simulate(truth, std::array{0.532}, grid, speckle, static_cast<unsigned long>(seed));
    if (weights.empty()) weights = speckle_weights(samples, truth);
    FitAccumulator accumulator{Basis{}};
    accumulator.add(samples, weights);
    const Model model = accumulator.solve().model;
    const PreparedModel prepared = prepare(model, 0.532);
    const PreparedUncertainty u = prepare_uncertainty(model, 0.532);
    const auto count = [&](std::size_t which, double error, double uncertainty) {
      squares[which] += error * error;
      predicted[which] += uncertainty * uncertainty;
      inside_interval[which] += std::abs(error) <= 1.96 * uncertainty ? 1 : 0;
    };
    for (const Geometry& geometry : asked) {
      const Mueller error = prepared.evaluate(geometry, Frame::sp) - exact.evaluate(geometry, Frame::sp);
      const Mueller uncertainty = standard_uncertainty(u.evaluate(geometry, Frame::sp));
      for (std::size_t e = 0; e < 16; ++e) count(e, error.elements[e], uncertainty.elements[e]);
    }
    count(16, directional_hemispherical_reflectance(model, 0.532, {0, 0}) - true_reflectance,
          u.directional_hemispherical_reflectance({0, 0}));
  }
  double all_inside = 0;
  for (std::size_t which = 0; which < 17; ++which) {
    EXPECT_NEAR(std::sqrt(squares[which] / predicted[which]), 1, 0.1) << which;
    if (which < 16) all_inside += inside_interval[which] / (16.0 * 10 * repetitions);
  }
  EXPECT_NEAR(all_inside, 0.95, 0.02);
  EXPECT_NEAR(inside_interval[16] / repetitions, 0.95, 0.04);  // 200 yes or no: 0.015 of standard deviation
}

/// Observed over predicted standard deviations.
struct Ratio {
  double squares = 0, predicted = 0;
  void add(double error, double uncertainty) {
    squares += error * error;
    predicted += uncertainty * uncertainty;
  }
  double value() const { return std::sqrt(squares / predicted); }
};

// With several wavelengths f11 is divided by the reflectance of each wavelength's own fit, and multiplied by the table
// of them afterwards: what is wrong with a table is wrong with the model. If the table counted as exact, the ratio of
// the reflectance would be above 1.3. 200 repetitions at three wavelengths; the ratio has a standard deviation below
// 0.05.
TEST(Uncertainty, CountsThatTheReflectanceTableCameFromTheSameData) {
  constexpr std::array wavelengths{0.4, 0.6, 1.0};
  const Model truth = random_model(Family::isotropic, {4, 0}, 1, 3);
  const auto grid = random_geometries(300, 1, radians(75));
  const Geometry asked{{0.6, 0}, {0.9, 2}};
  Ratio f11, reflectance;
  for (unsigned long seed = 1; seed <= 200; ++seed) {
    const auto samples = simulate(truth, wavelengths, grid, 0.02, seed);
    FitAccumulator accumulator({Family::isotropic, {4, 0}});
    accumulator.add(samples, speckle_weights(samples, truth));
    const Model model = accumulator.solve().model;
    ASSERT_EQ(model.reflectance.covariance.size(), 3u);  // variances: of other wavelengths the errors are others
    for (const double wavelength : {0.4, 0.75}) {
      const PreparedUncertainty u = prepare_uncertainty(model, wavelength);
      // between its wavelengths the table is linear, and the truth is not: the noise-free fit has what it misses
      static const Model exact = fit(simulate(truth, wavelengths, grid), {Family::isotropic, {4, 0}}).model;
      f11.add(prepare(model, wavelength).f11(asked) - prepare(exact, wavelength).f11(asked),
              standard_uncertainty(u.evaluate(asked))(0, 0));
      reflectance.add(directional_hemispherical_reflectance(model, wavelength, {}) -
                          directional_hemispherical_reflectance(exact, wavelength, {}),
                      u.directional_hemispherical_reflectance({}));
    }
  }
  EXPECT_NEAR(f11.value(), 1, 0.1);
  EXPECT_NEAR(reflectance.value(), 1, 0.1);
}

// Speckle noise grows towards grazing detectors; a fit without weights does not know. 200 repetitions: standard
// deviation of a ratio 0.05, and 0.03 for the three elements together.
TEST(Uncertainty, OfTheSandwichIsRightWhereTheResidualsAreNotUniform) {
  const Basis basis{Family::isotropic, {4, 2}};
  const Model truth = projected_on_isotropic(material("ptfe-532"), basis.orders);
  const auto grid = random_geometries(400, 1, radians(80));
  const PreparedModel exact = prepare(truth, 0.532);
  const Geometry grazing{{0.3, 0}, {1.36, 2}};
  std::array<Ratio, 2> ratios;
  for (unsigned long seed = 1; seed <= 200; ++seed) {
    const auto samples = simulate(truth, std::array{0.532}, grid, 0.02, seed);
    for (const Covariance kind : {Covariance::residuals, Covariance::sandwich}) {
      FitOptions options;
      options.covariance = kind;
      const Model model = fit(samples, basis, options).model;
      const Mueller error = prepare(model, 0.532).evaluate(grazing) - exact.evaluate(grazing);
      const Mueller u = standard_uncertainty(prepare_uncertainty(model, 0.532).evaluate(grazing));
      for (const std::size_t e : {5u, 10u, 15u})
        ratios[kind == Covariance::sandwich].add(error.elements[e], u.elements[e]);
    }
  }
  EXPECT_GT(ratios[0].value(), 1.1);
  EXPECT_NEAR(ratios[1].value(), 1, 0.1);
}

TEST(Uncertainty, OfTheSandwichWithItsOwnReflectanceIsRightToo) {
  const Basis basis{Family::isotropic, {3, 0}};
  const Model truth = random_model(Family::isotropic, {3, 0}, 0, 3);
  const auto grid = random_geometries(300, 1, radians(80));
  constexpr std::array wavelengths{0.5, 0.6};
  Ratio reflectance;
  for (unsigned long seed = 1; seed <= 200; ++seed) {
    FitOptions options;
    options.covariance = Covariance::sandwich;
    const Model model = fit(simulate(truth, wavelengths, grid, 0.02, seed), basis, options).model;
    reflectance.add(
        directional_hemispherical_reflectance(model, 0.5, {}) - directional_hemispherical_reflectance(truth, 0.5, {}),
        prepare_uncertainty(model, 0.5).directional_hemispherical_reflectance({}));
  }
  EXPECT_NEAR(reflectance.value(), 1, 0.12);  // one number 200 times: 0.05
}

// Theory 5.1: statistical u(DHR(0)) .0004 at 532 nm and .0007 at 1064 nm.
TEST(Uncertainty, OfTheReflectanceOfPtfeIsThatOfTheTheory) {
  const std::string file = published("PTFE.data.csv");
  if (file.empty()) GTEST_SKIP() << absent("PTFE.data.csv");
  const std::vector<Sample> samples = read_samples(file);
  for (const auto& [wavelength, u] : {std::pair(0.532, .0004), std::pair(1.064, .0007)}) {
    const Model model = fit(at_wavelengths(samples, std::array{wavelength})).model;
    EXPECT_NEAR(prepare_uncertainty(model, wavelength).directional_hemispherical_reflectance({0, 0}), u, 5e-5);
  }
}

// Theory 2.2 and theory 4.7: the data have one plane of incidence, and the published sets at other azimuths say what
// they do not.
TEST(Uncertainty, OfThePublishedSetsAsPrintedIsNotEstimableAwayFromThePlaneOfTheData) {
  const auto samples = simulate(material("ptfe-532"), std::array{0.532}, germer2017_grid(), 0.01, 1);
  const Model model = fit(samples, {Family::germer2017, {7, 4}}).model;
  const Geometry in_plane{{0.5, 0}, {0.6, 2}}, turned{{0.7, 1}, {0.3, 2.3}};
  const PreparedUncertainty covariant = prepare_uncertainty(model, 0.532);
  const PreparedUncertainty as_printed = prepare_uncertainty(mmbrdf::as_printed(model), 0.532);
  EXPECT_TRUE(covariant.estimable(in_plane));
  EXPECT_TRUE(covariant.estimable(turned));
  EXPECT_TRUE(as_printed.estimable(in_plane));
  EXPECT_FALSE(as_printed.estimable(turned));
  EXPECT_TRUE(prepare_uncertainty(least_squares("ptfe"), 0.7).estimable(turned));
}

// The reflectance of a fit divided by its own is 1 without error: zero eigenvalues of the covariance that are no lack
// of data.
TEST(Uncertainty, OfAFitWithItsOwnReflectanceIsEstimableWhereItIsWithAGivenOne) {
  std::vector<Geometry> at_normal;
  for (const Geometry& g : germer2017_grid())
    if (g.incident.theta == 0) at_normal.push_back(g);
  const auto samples = simulate(material("ptfe"), std::array{0.4, 0.6, 0.8}, at_normal, 0.01, 1);
  FitOptions options;
  options.powers = 0;
  options.minimum_norm = true;
  const Model own = fit(samples, {Family::isotropic, {3, 1}}, options).model;
  options.reflectance = own.reflectance;
  const Model given = fit(samples, {Family::isotropic, {3, 1}}, options).model;
  ASSERT_LT(own.blocks[0].rank, static_cast<int>(own.blocks[0].coefficients.size()));
  const PreparedUncertainty u = prepare_uncertainty(own, 0.5), other = prepare_uncertainty(given, 0.5);
  for (const Geometry& g : at_normal) EXPECT_TRUE(u.estimable(g) && other.estimable(g));
  EXPECT_FALSE(u.estimable({{0.8, 0}, {0.5, 1}}));
}

TEST(Uncertainty, OfReflectancesWithVariancesAloneIsThatOfTheDiagonalMatrix) {
  const auto samples = simulate(material("ptfe"), std::array{0.4, 0.6, 0.8}, random_geometries(90, 2), 0.01, 1);
  const Model alone = fit(samples, {Family::isotropic, {3, 1}}).model;
  Model matrix = alone;
  const std::vector<double> v = alone.reflectance.covariance;
  ASSERT_EQ(v.size(), 3U);
  matrix.reflectance.covariance = {v[0], 0, 0, 0, v[1], 0, 0, 0, v[2]};
  for (const double wavelength : {0.4, 0.55, 0.9}) {
    const PreparedUncertainty a = prepare_uncertainty(alone, wavelength), b = prepare_uncertainty(matrix, wavelength);
    expect_equal(a.evaluate({{0.8, 0}, {0.5, 1}}), b.evaluate({{0.8, 0}, {0.5, 1}}));
    EXPECT_NEAR(a.directional_hemispherical_reflectance({}) / b.directional_hemispherical_reflectance({}), 1, 1e-12);
  }
}

TEST(Uncertainty, OfASandwichWithoutDegreesOfFreedomIsNotKnown) {
  const auto few = simulate(material("ptfe"), std::array{0.4, 0.6}, random_geometries(5, 1), 0.01, 1);
  FitOptions options;
  options.covariance = Covariance::sandwich;
  const Model model = fit(few, {Family::germer2017, {7, 4}}, options).model;
  EXPECT_TRUE(model.blocks[0].covariance.empty());
  EXPECT_NO_THROW(prepare(model, 0.5));
}

TEST(Uncertainty, WithPowersOfTheWavelengthIsEstimableWhereItIsWithout) {
  const auto samples = simulate(material("ptfe"), std::array{0.532, 0.633}, germer2017_grid(), 0.01, 1);
  const Model model = fit(samples, {Family::germer2017, {7, 4}}).model;
  ASSERT_EQ(model.powers, 1);
  const Geometry turned{{0.7, 1}, {0.3, 2.3}};
  EXPECT_TRUE(prepare_uncertainty(model, 0.6).estimable(turned));
  EXPECT_FALSE(prepare_uncertainty(mmbrdf::as_printed(model), 0.6).estimable(turned));
}

// At normal incidence 14 and 41 have no modes left: rank 0, and a covariance of zeros.
TEST(Uncertainty, OfWhatTheDataSayNothingAboutIsNotEstimable) {
  auto samples = simulate(material("ptfe-532"), std::array{0.532}, germer2017_grid(), 0.01, 1);
  std::erase_if(samples, [](const Sample& s) { return s.geometry.incident.theta > 0; });
  FitOptions options;
  options.minimum_norm = true;
  Model model = fit(samples, {Family::isotropic, {0, 2}}, options).model;
  std::erase_if(model.blocks, [](const FittedBlock& b) { return b.block.name != "11" && b.block.name != "14,41"; });
  ASSERT_EQ(model.blocks[1].rank, 0);
  EXPECT_FALSE(prepare_uncertainty(model, 0.532).estimable({{0.7, 0}, {0.5, 1}}));
}

// Theory 4.7: what of the slopes of f11 lies along the combination that is free, over all of them, is at most 1e-8.
TEST(Uncertainty, IsEstimableUpToTheRoundingOfAFreeCombination) {
  const Geometry g{{0.8, 0}, {0.5, 1}};
  Model model;
  model.blocks.push_back({blocks(Family::isotropic, {2, 0}).front(), {}, {}, 0, 0});
  FittedBlock& f11 = model.blocks.front();
  const std::size_t size = f11.block.modes.size();
  f11.coefficients.assign(size, 1);
  f11.covariance.assign(size * size, 0);
  f11.rank = static_cast<int>(size) - 1;
  f11.null_space.assign(size, 1);
  const MuellerGradient slopes = prepare_uncertainty(model, 1).gradient(g);
  std::vector<double> row(slopes.values.begin(), slopes.values.begin() + static_cast<std::ptrdiff_t>(size));
  const double length = std::sqrt(std::inner_product(row.begin(), row.end(), row.begin(), 0.0));
  const double across = std::hypot(row[0], row[1]);
  for (const auto& [part, expected] : {std::pair(5e-9, true), {2e-8, false}, {1e-6, false}, {0.1, false}}) {
    for (std::size_t q = 0; q < size; ++q)  // across the slopes, and a part of them
      f11.null_space[q] = (q == 0 ? row[1] / across : q == 1 ? -row[0] / across : 0) + part * row[q] / length;
    EXPECT_EQ(prepare_uncertainty(model, 1).estimable(g), expected) << part;
  }
}

TEST(Uncertainty, IsFiniteWhereF11IsZeroAndNotHiddenWhereItIsNoNumber) {
  Model model = with_correlated_coefficients(Family::isotropic);
  std::fill(model.blocks[0].coefficients.begin(), model.blocks[0].coefficients.end(), 0.0);
  const Mueller u = standard_uncertainty(prepare_uncertainty(model, 0.5).evaluate({{0.5, 0}, {0.4, 1}}));
  for (const double element : u.elements) EXPECT_TRUE(element > 0 && std::isfinite(element));
  MuellerCovariance undefined;
  undefined(3, 3) = std::nan("");
  EXPECT_TRUE(std::isnan(standard_uncertainty(undefined).elements[3]));
}

// The largest coefficients, reflectances and variances, at the shortest wavelength and where powers of it are refused.
TEST(Uncertainty, AndValueOfTheLargestNumbersAreFiniteOrRefused) {
  for (const Family family : {Family::isotropic, Family::germer2017, Family::anisotropic}) {
    Model model = with_correlated_coefficients(family);
    const auto fill = [](std::vector<double>& list, double value) { std::ranges::fill(list, value); };
    for (FittedBlock& block : model.blocks) {
      fill(block.coefficients, largest_coefficient);
      fill(block.covariance, largest_variance);
    }
    fill(model.reflectance.values, largest_coefficient);
    fill(model.reflectance.covariance, largest_variance);
    fill(model.reflectance.covariance_with_f11, largest_variance);
    int answered = 0;
    for (const double wavelength : {1e-3, 0.5, 1.0, 1e3, max_wavelength}) {
      try {
        const PreparedModel value = prepare(model, wavelength);
        const PreparedUncertainty u = prepare_uncertainty(model, wavelength);
        for (const Geometry& g : random_geometries(20, 1)) {
          EXPECT_LT(std::abs(value.evaluate(g)(0, 0)), 1e300);
          for (const double f : value.evaluate(g, Frame::sp).elements) EXPECT_TRUE(std::isfinite(f));
          for (const double v : u.evaluate(g, Frame::sp).values) EXPECT_TRUE(std::isfinite(v));
          EXPECT_TRUE(std::isfinite(u.directional_hemispherical_reflectance(g.incident)));
        }
        ++answered;
      } catch (const std::invalid_argument&) {
      }
      EXPECT_TRUE(std::isfinite(directional_hemispherical_reflectance(model, wavelength, {})));
    }
    EXPECT_GT(answered, 0);
  }
}

TEST(Uncertainty, NeedsACovarianceAndAValidQuestion) {
  const Model without = in_published_form(least_squares("ptfe-532"));
  EXPECT_EQ(message_of([&] { prepare_uncertainty(without, 0.532); }), "the covariance of block 11 is not known");
  Model without_one = least_squares("ptfe-532");
  EXPECT_TRUE(knows_uncertainty(without_one));
  without_one.blocks[2].covariance.clear();
  EXPECT_FALSE(knows_uncertainty(without_one));
  EXPECT_EQ(message_of([&] { prepare_uncertainty(without_one, 0.532); }), "the covariance of block 14,41 is not known");
  Model unknown_rank = least_squares("ptfe-532");
  unknown_rank.blocks[1].rank = 0;
  EXPECT_FALSE(prepare_uncertainty(unknown_rank, 0.532).estimable({{0.7, 0}, {0.5, 1}}));
  Model no_covariance = least_squares("ptfe-532");
  no_covariance.blocks[0].covariance[1] = no_covariance.blocks[0].covariance[40] = 1;
  EXPECT_EQ(message_of([&] {
              prepare_uncertainty(no_covariance, 0.532);
            }).find("the covariance of block 11 is not positive semidefinite: its eigenvalues are -"),
            0u);
  const PreparedUncertainty u = prepare_uncertainty(least_squares("ptfe-532"), 0.532);
  EXPECT_THROW(u.evaluate({{radians(95), 0}, {}}), std::invalid_argument);
  EXPECT_THROW(u.estimable({{0, 0}, {radians(95), 0}}), std::invalid_argument);
  EXPECT_THROW(u.directional_hemispherical_reflectance({radians(95), 0}), std::invalid_argument);
}

/// The covariance of the errors z · m, with z of variance 1, is m mᵀ: turned, that of the turned errors.
TEST(Uncertainty, InAnotherFrameIsThatOfTheTurnedErrors) {
  const auto of = [](const Mueller& errors) {
    MuellerCovariance c;
    for (std::size_t e = 0; e < 16; ++e)
      for (std::size_t other = 0; other < 16; ++other) c(e, other) = errors.elements[e] * errors.elements[other];
    return c;
  };
  const Geometry geometry{{radians(40), radians(20)}, {radians(60), radians(150)}};
  Mueller errors;
  for (std::size_t e = 0; e < 16; ++e) errors.elements[e] = std::sin(1.0 + 1.7 * static_cast<double>(e));
  for (const Frame from : every_frame)
    for (const Frame to : every_frame) {
      const MuellerCovariance turned = change_frame(of(errors), geometry, from, to);
      const MuellerCovariance expected = of(change_frame(errors, geometry, from, to));
      for (std::size_t i = 0; i < 256; ++i) EXPECT_NEAR(turned.values[i], expected.values[i], 1e-14);  // rounding
    }
  EXPECT_THROW(change_frame(MuellerCovariance{}, {{-1, 0}, {0, 0}}, Frame::xy, Frame::sp), std::invalid_argument);
}

}  // namespace
}  // namespace mmbrdf
