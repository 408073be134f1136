// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/radiometry/reflectance_uncertainty.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "given/least_squares.hpp"
#include "given/random_model.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"

namespace mmbrdf {
namespace {

/// √(gᵀ V g) with the slopes g of any quantity by central differences, one coefficient after the other, and V block by
/// block. All are quadratic in the coefficients, so the differences are exact but for rounding.
double by_differences(const Model& model, const std::function<double(const Model&)>& quantity) {
  double variance = 0;
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    const FittedBlock& block = model.blocks[b];
    const std::size_t size = block.coefficients.size();
    std::vector<double> slopes;
    for (std::size_t q = 0; q < size; ++q) {
      Model changed = model;
      changed.blocks[b].coefficients[q] += 0.01;
      const double above = quantity(changed);
      changed.blocks[b].coefficients[q] -= 0.02;
      slopes.push_back((above - quantity(changed)) / 0.02);
    }
    for (std::size_t q = 0; q < size; ++q)
      for (std::size_t r = 0; r < size; ++r) variance += slopes[q] * block.covariance[q * size + r] * slopes[r];
  }
  return std::sqrt(variance);
}

constexpr double relative = 1e-9;  // differences of 0.01 with the error of an evaluation: some 1e-12

void expect_equal(double value, double expected) { EXPECT_NEAR(value / expected, 1, relative); }
void expect_equal(const std::vector<Contribution>& budget, double expected) {
  ASSERT_EQ(budget.size(), 1U);
  EXPECT_EQ(budget.front().name, "fit");
  expect_equal(standard_uncertainty(budget), expected);
}

TEST(ReflectanceUncertainty, OfTheHemisphereIsThatOfTheSlopesOfTheValues) {
  const Model model = least_squares("ptfe-532");
  const UncertainModel at = uncertain(model, 0.532);
  const Direction direction{radians(60), 0.4};
  for (const Stokes& light : {Stokes{1, 1, 0, 0}, {1, -1, 0, 0}, {2, 0.3, 1.2, -0.8}}) {
    expect_equal(directional_hemispherical_budget(at, direction, light), by_differences(model, [&](const Model& m) {
                   return directional_hemispherical_reflectance(m, 0.532, direction, light);
                 }));
    expect_equal(hemispherical_directional_budget(at, direction, light), by_differences(model, [&](const Model& m) {
                   return hemispherical_directional_reflectance(m, 0.532, direction, light);
                 }));
  }
  expect_equal(bihemispherical_budget(at),
               by_differences(model, [](const Model& m) { return bihemispherical_reflectance(m, 0.532); }));
}

TEST(ReflectanceUncertainty, OfUnpolarizedLightIsTheClosedForm) {
  const Model model = least_squares("ptfe");
  const UncertainModel at = uncertain(model, 0.6);
  for (const double theta : {0.0, 0.6, 1.3}) {
    const double closed = at.fit.directional_hemispherical_reflectance({theta, 0});
    expect_equal(directional_hemispherical_budget(at, {theta, 0}), closed);
    expect_equal(hemispherical_directional_budget(at, {theta, 0}), closed);
  }
}

TEST(ReflectanceUncertainty, OfAMeanOverAperturesIsThatOfItsSlopes) {
  const Model model = least_squares("ptfe-532");
  const UncertainModel at = uncertain(model, 0.532);
  const Aperture source = Aperture::cone({radians(8), 0}, 0.1);
  const Aperture receiver = Aperture::ring(radians(40), radians(50));
  const Mueller u = standard_uncertainty(average_budget(at, source, receiver, 6).total);
  for (const auto& [row, column] : {std::pair(0, 0), std::pair(1, 1)})
    expect_equal(u(row, column), by_differences(model, [&, i = row, j = column](const Model& m) {
                   return average(prepare(m, 0.532), source, receiver).mueller(i, j);
                 }));
  const Geometry g{{radians(45), 0}, {0, 0}};
  const Mueller point = standard_uncertainty(
      average_budget(at, Aperture::direction(g.incident), Aperture::direction(g.reflected), 1).total);
  const Mueller expected = standard_uncertainty(at.fit.evaluate(g));
  for (std::size_t e = 0; e < 16; ++e) EXPECT_NEAR(point.elements[e], expected.elements[e], 1e-12) << e;
}

/// u of the second cause of a budget, the first being the fit.
double of_term(const std::vector<Contribution>& budget) { return budget.at(1).uncertainty; }

TEST(ReflectanceUncertainty, OfAScaleIsThatPartOfEachIntegral) {
  const Model model = least_squares("ptfe-532");
  const UncertainModel at = uncertain(model, 0.532, {{"plaque", ErrorOf::scale, 0.003, 12}});
  const Direction direction{radians(60), 0.4};
  const Stokes light{2, 0.3, 1.2, -0.8};
  expect_equal(of_term(directional_hemispherical_budget(at, direction, light)),
               0.003 * directional_hemispherical_reflectance(model, 0.532, direction, light));
  expect_equal(of_term(hemispherical_directional_budget(at, direction, light)),
               0.003 * hemispherical_directional_reflectance(model, 0.532, direction, light));
  expect_equal(of_term(bihemispherical_budget(at)), 0.003 * bihemispherical_reflectance(model, 0.532));
  const Aperture source = Aperture::cone({radians(8), 0}, 0.1), receiver = Aperture::ring(radians(40), radians(50));
  const Budget mean = average_budget(at, source, receiver, 6);
  expect_equal(standard_uncertainty(mean.terms.at(1).covariance)(0, 0),
               0.003 * average(at.model, source, receiver).mueller(0, 0));
  EXPECT_EQ(mean.terms.at(1).freedom, 12);
}

// A perfect diffuser seen by a detector at θr + d: ∫ cos(θr + d) / cos θr cos θr dΩ / π has the slope −2 ∫ sin²θ dθ.
TEST(ReflectanceUncertainty, OfADetectorAngleIsAQuarterTurnOfTheReflectanceOfADiffuser) {
  Model diffuse = diffuser({0.9 / std::numbers::pi});
  diffuse.blocks[0].covariance = {1e-8};
  const UncertainModel arm = uncertain(diffuse, 1, {{"arm", ErrorOf::theta_r, 1e-3}});
  const double u = of_term(directional_hemispherical_budget(arm, {radians(8), 0}));
  EXPECT_NEAR(u / (1e-3 * 0.9 * std::numbers::pi / 2), 1, 0.02);  // as the header promises
}

// Turning the receiver about the normal takes nothing out of the hemisphere; neither do errors of the other elements.
TEST(ReflectanceUncertainty, OfAnAzimuthOrACalibrationIsNoneForUnpolarizedLight) {
  for (const ErrorOf what : {ErrorOf::azimuth, ErrorOf::calibration}) {
    const UncertainModel at = uncertain(least_squares("ptfe-532"), 0.532, {{"error", what, 0.01}});
    EXPECT_NEAR(of_term(directional_hemispherical_budget(at, {radians(45), 0})), 0, 1e-10);
    EXPECT_NEAR(of_term(bihemispherical_budget(at)), 0, 1e-10);
  }
}

// u of s light with errors of m12 alone is theirs times the reflectance: one error for all directions, that does not
// average out.
TEST(ReflectanceUncertainty, OfACalibrationDoesNotAverageOut) {
  const Model model = least_squares("ptfe-532");
  const UncertainModel at = uncertain(model, 0.532, {{"retarder", ErrorOf::calibration, 0.001}});
  const Direction direction{radians(45), 0};
  expect_equal(of_term(directional_hemispherical_budget(at, direction, {1, 1, 0, 0})),
               0.001 * directional_hemispherical_reflectance(model, 0.532, direction));
}

/// A model misread by arms that stand d off, as the effect of the term says.
double misread(const PreparedModel& model, const Direction& incident, ErrorOf what, double d) {
  double sum = 0;
  for (const auto& [reflected, weight] : Aperture::hemisphere().quadrature(40)) {
    const Geometry g{what == ErrorOf::theta_i ? unfolded({incident.theta + d, incident.phi}) : incident, reflected};
    sum += weight * model.f11(g);
  }
  return sum;
}

TEST(ReflectanceUncertainty, OfASourceAngleIsTheSlopeOfTheReflectance) {
  const UncertainModel at = uncertain(least_squares("ptfe-532"), 0.532, {{"arm", ErrorOf::theta_i, 1e-3}});
  const Direction incident{radians(60), 0};
  const double slope =
      (misread(at.model, incident, ErrorOf::theta_i, 1e-3) - misread(at.model, incident, ErrorOf::theta_i, -1e-3)) / 2;
  EXPECT_NEAR(of_term(directional_hemispherical_budget(at, incident)) / std::abs(slope), 1, 1e-4);
}

TEST(ReflectanceUncertainty, RefusesLightThatCannotExist) {
  const Model model = least_squares("ptfe-532");
  const UncertainModel at = uncertain(model, 0.532);
  EXPECT_THROW(directional_hemispherical_budget(at, {0, 0}, {1, 1, 1, 0}), std::invalid_argument);
  EXPECT_THROW(hemispherical_directional_budget(at, {0, 0}, {0, 0, 0, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace mmbrdf
