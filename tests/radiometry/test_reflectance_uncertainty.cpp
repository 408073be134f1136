// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/radiometry/reflectance_uncertainty.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

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

TEST(ReflectanceUncertainty, OfTheHemisphereIsThatOfTheSlopesOfTheValues) {
  const Model model = material("ptfe-532");
  const PreparedUncertainty prepared = prepare_uncertainty(model, 0.532);
  const Direction direction{radians(60), 0.4};
  for (const Stokes& light : {Stokes{1, 1, 0, 0}, {1, -1, 0, 0}, {2, 0.3, 1.2, -0.8}}) {
    expect_equal(directional_hemispherical_uncertainty(model, prepared, direction, light),
                 by_differences(model, [&](const Model& m) {
                   return directional_hemispherical_reflectance(m, 0.532, direction, light);
                 }));
    expect_equal(hemispherical_directional_uncertainty(model, prepared, direction, light),
                 by_differences(model, [&](const Model& m) {
                   return hemispherical_directional_reflectance(m, 0.532, direction, light);
                 }));
  }
  expect_equal(bihemispherical_uncertainty(model, prepared),
               by_differences(model, [](const Model& m) { return bihemispherical_reflectance(m, 0.532); }));
}

TEST(ReflectanceUncertainty, OfUnpolarizedLightIsTheClosedForm) {
  const Model model = material("ptfe");
  const PreparedUncertainty prepared = prepare_uncertainty(model, 0.6);
  for (const double theta : {0.0, 0.6, 1.3}) {
    const double closed = prepared.directional_hemispherical_reflectance({theta, 0});
    expect_equal(directional_hemispherical_uncertainty(model, prepared, {theta, 0}), closed);
    expect_equal(hemispherical_directional_uncertainty(model, prepared, {theta, 0}), closed);
  }
}

TEST(ReflectanceUncertainty, OfAMeanOverAperturesIsThatOfItsSlopes) {
  const Model model = material("ptfe-532");
  const PreparedUncertainty prepared = prepare_uncertainty(model, 0.532);
  const Aperture source = Aperture::cone({radians(8), 0}, 0.1);
  const Aperture receiver = Aperture::ring(radians(40), radians(50));
  const Mueller u = standard_uncertainty(average_covariance(prepared, source, receiver, 6));
  for (const auto& [row, column] : {std::pair(0, 0), std::pair(1, 1)})
    expect_equal(u(row, column), by_differences(model, [&, i = row, j = column](const Model& m) {
                   return average(prepare(m, 0.532), source, receiver).mueller(i, j);
                 }));
  const Geometry g{{radians(45), 0}, {0, 0}};
  const Mueller point = standard_uncertainty(
      average_covariance(prepared, Aperture::direction(g.incident), Aperture::direction(g.reflected), 1));
  const Mueller expected = standard_uncertainty(prepared.evaluate(g));
  for (std::size_t e = 0; e < 16; ++e) EXPECT_NEAR(point.elements[e], expected.elements[e], 1e-12) << e;
}

TEST(ReflectanceUncertainty, RefusesLightThatCannotExist) {
  const Model model = material("ptfe-532");
  const PreparedUncertainty prepared = prepare_uncertainty(model, 0.532);
  EXPECT_THROW(directional_hemispherical_uncertainty(model, prepared, {0, 0}, {1, 1, 1, 0}), std::invalid_argument);
  EXPECT_THROW(hemispherical_directional_uncertainty(model, prepared, {0, 0}, {0, 0, 0, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace mmbrdf
