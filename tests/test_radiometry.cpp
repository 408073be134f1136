// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "mmbrdf/io.hpp"
#include "mmbrdf/materials.hpp"
#include "mmbrdf/radiometry.hpp"
#include "published.hpp"

namespace mmbrdf {
namespace {

constexpr double pi = std::numbers::pi;

/// ∫ f11 cos θr dΩr by quadrature: Gauss–Legendre in u = 1 − cos θ, equidistant in azimuth. With more nodes than the
/// degree of the polynomial it is exact but for rounding.
double dhr_by_quadrature(const Model& model, double wavelength, const Direction& incident) {
  const PreparedModel prepared = prepare(model, wavelength);
  constexpr int azimuths = 40;
  double sum = 0;
  for (const Node& node : gauss_legendre(40))
    for (int a = 0; a < azimuths; ++a)
      sum += node.weight * (1 - node.x) * prepared.f11({incident, {std::acos(1 - node.x), 2 * pi * a / azimuths}});
  return sum * 2 * pi / azimuths;
}

TEST(Radiometry, GaussLegendreIsExactForPolynomialsUpToDegreeTwiceTheNodesLessOne) {
  for (const int count : {1, 2, 5, 16, 64}) {
    for (int degree = 0; degree < 2 * count; ++degree) {
      double sum = 0;
      for (const Node& node : gauss_legendre(count)) sum += node.weight * std::pow(node.x, degree);
      EXPECT_NEAR(sum, 1.0 / (degree + 1), 1e-14) << count << " nodes, degree " << degree;
    }
    double beyond = 0;
    for (const Node& node : gauss_legendre(count)) beyond += node.weight * std::pow(node.x, 2 * count);
    if (count <= 5) {
      EXPECT_GT(std::abs(beyond - 1.0 / (2 * count + 1)), 1e-8) << count;
    }
  }
  EXPECT_THROW(gauss_legendre(0), std::invalid_argument);
}

// The closed form and the quadrature are different sums of the same numbers; dhr_error is for DHR of about 1, and the
// quadrature has 1600 terms, each with the error of an evaluation.
TEST(Radiometry, ClosedFormOfTheDirectionalReflectanceIsTheIntegral) {
  const Model model = material("ptfe");
  for (const double theta : {0.0, 8.0, 45.0, 60.0, 75.0, 90.0})
    for (const double wavelength : {0.351, 0.45, 0.532, 1.064}) {
      const Direction incident{radians(theta), 0.7};
      EXPECT_NEAR(directional_hemispherical_reflectance(model, wavelength, incident),
                  dhr_by_quadrature(model, wavelength, incident), dhr_error)
          << theta;
    }
}

TEST(Radiometry, ClosedFormHoldsForTheOtherMappingAndTheOtherFamilies) {
  for (const DiscMapping mapping : {DiscMapping::lambert, DiscMapping::projected})
    for (const Family family : {Family::isotropic, Family::germer2017, Family::anisotropic}) {
      Model model;
      model.family = family;
      model.mapping = mapping;
      model.powers = 1;
      model.reflectance = {{0.4, 0.6}, {0.9, 0.7}};
      for (const Block& block : blocks(family, {4, 2})) {
        FittedBlock fitted{block, {}, {}, 0, 0};
        for (std::size_t i = 0; i < 2 * block.modes.size(); ++i)
          fitted.coefficients.push_back(std::sin(1.0 + 1.7 * static_cast<double>(i)));
        model.blocks.push_back(fitted);
      }
      const Direction incident{radians(33), radians(70)};
      // ρ² is no polynomial of 1 − cos θ for the projected mapping, so 40 nodes are not exact there
      EXPECT_NEAR(directional_hemispherical_reflectance(model, 0.5, incident), dhr_by_quadrature(model, 0.5, incident),
                  1e-12)
          << to_string(mapping) << " " << to_string(family);
    }
}

// Theory 4.3, from the published coefficients; six digits are printed.
TEST(Radiometry, PublishedCoefficientsGiveTheDirectionalReflectancesOfTheTheory) {
  if (published("PTFE.coeff.csv").empty()) GTEST_SKIP() << absent("PTFE.coeff.csv");
  constexpr double angles[] = {0, 8, 45, 60, 75};
  struct Row {
    int nanometres;
    double single[5], multi[5];
  };
  constexpr Row rows[] = {
      {351, {.975147, .975776, .987778, .990086, .987797}, {.999609, .999923, 1.006700, 1.008007, 1.004496}},
      {532, {.984159, .984062, .984407, .984700, .979121}, {.999858, 1.000038, 1.005025, 1.006231, 1.001740}},
      {633, {.984413, .984319, .984888, .985403, .979977}, {.999997, 1.000102, 1.004091, 1.005240, 1.000201}},
      {1064, {.983339, .983277, .985492, .986855, .980084}, {1.000590, 1.000376, 1.000103, 1.001011, .993637}},
  };
  const Model multi = read_coefficients(published("PTFE.coeff.csv"));
  for (const Row& row : rows) {
    const Model single = read_coefficients(published("PTFE." + std::to_string(row.nanometres) + ".coeff.csv"));
    for (int a = 0; a < 5; ++a) {
      const double wavelength = row.nanometres / 1000.0;
      const Direction incident{radians(angles[a]), 0};
      EXPECT_NEAR(directional_hemispherical_reflectance(single, wavelength, incident), row.single[a], 1e-6);
      EXPECT_NEAR(directional_hemispherical_reflectance(multi, wavelength, incident), row.multi[a], 1e-6);
    }
  }
}

TEST(Radiometry, DirectionalReflectanceRefusesWhatNoModelOrDirectionIs) {
  const Model model = material("ptfe-532");
  EXPECT_THROW(directional_hemispherical_reflectance(model, 0, {0, 0}), std::invalid_argument);
  EXPECT_THROW(directional_hemispherical_reflectance(model, 0.532, {radians(95), 0}), std::invalid_argument);
  EXPECT_THROW(directional_hemispherical_reflectance(Model{}, 0.532, {0, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace mmbrdf
