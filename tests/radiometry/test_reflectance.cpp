// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "given/cases.hpp"
#include "given/published.hpp"
#include "given/random_model.hpp"
#include "mmbrdf/files/coefficients_file.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/numerics/quadrature.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"

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
      EXPECT_NEAR(directional_hemispherical_reflectance(model, 0.5, incident), dhr_by_quadrature(model, 0.5, incident),
                  1e-12)
          << to_string(mapping) << " " << to_string(family);
    }
}

// Theory 5.1, from the published coefficients, to six digits. The last column is the bihemispherical
// reflectance.
TEST(Radiometry, PublishedCoefficientsGiveTheReflectancesOfTheTheory) {
  if (published("PTFE.coeff.csv").empty()) GTEST_SKIP() << absent("PTFE.coeff.csv");
  constexpr double angles[] = {0, 8, 45, 60, 75};
  struct Row {
    int nanometres;
    double single[6], multi[6];
  };
  constexpr Row rows[] = {
      {351,
       {.975147, .975776, .987778, .990086, .987797, .985510},
       {.999609, .999923, 1.006700, 1.008007, 1.004496, 1.004966}},
      {532,
       {.984159, .984062, .984407, .984700, .979121, .983263},
       {.999858, 1.000038, 1.005025, 1.006231, 1.001740, 1.003412}},
      {633,
       {.984413, .984319, .984888, .985403, .979977, .983781},
       {.999997, 1.000102, 1.004091, 1.005240, 1.000201, 1.002545}},
      {1064,
       {.983339, .983277, .985492, .986855, .980084, .983979},
       {1.000590, 1.000376, 1.000103, 1.001011, .993637, .998845}},
  };
  const Model multi = read_coefficients(published("PTFE.coeff.csv"));
  for (const Row& row : rows) {
    const Model single = read_coefficients(published("PTFE." + std::to_string(row.nanometres) + ".coeff.csv"));
    const double wavelength = row.nanometres / 1000.0;
    EXPECT_NEAR(bihemispherical_reflectance(single, wavelength), row.single[5], 1e-6);
    EXPECT_NEAR(bihemispherical_reflectance(multi, wavelength), row.multi[5], 1e-6);
    for (int a = 0; a < 5; ++a) {
      const Direction incident{radians(angles[a]), 0};
      EXPECT_NEAR(directional_hemispherical_reflectance(single, wavelength, incident), row.single[a], 1e-6);
      EXPECT_NEAR(directional_hemispherical_reflectance(multi, wavelength, incident), row.multi[a], 1e-6);
    }
  }
}

// Theory 5.1, to eight digits.
TEST(Radiometry, PublishedCoefficientsGiveThePolarizedReflectancesOfTheTheory) {
  const std::string file = published("PTFE.532.coeff.csv");
  if (file.empty()) GTEST_SKIP() << absent("PTFE.532.coeff.csv");
  const Model model = read_coefficients(file);
  const Direction incident{radians(60), 0};
  EXPECT_NEAR(directional_hemispherical_reflectance(model, 0.532, incident, {1, 1, 0, 0}), .98511384, 5e-9);
  EXPECT_NEAR(directional_hemispherical_reflectance(model, 0.532, incident, {1, -1, 0, 0}), .98428629, 5e-9);
}

// Theory 5.1: π f at 0:45 and 0:0, to five digits. They are of the files of single wavelengths.
TEST(Radiometry, PublishedCoefficientsGiveTheReflectanceFactorsOfTheTheory) {
  if (published("PTFE.coeff.csv").empty()) GTEST_SKIP() << absent("PTFE.coeff.csv");
  struct Row {
    int nanometres;
    double at_45, at_0;
  };
  for (const Row& row :
       {Row{351, .99079, 1.0420}, {532, .99986, 1.0564}, {633, .99978, 1.0569}, {1064, .99774, 1.0642}}) {
    const Model model = read_coefficients(published("PTFE." + std::to_string(row.nanometres) + ".coeff.csv"));
    const PreparedModel prepared = prepare(model, row.nanometres / 1000.0);
    EXPECT_NEAR(reflectance_factor(prepared.f11({{0, 0}, {radians(45), pi}})), row.at_45, 5e-6);
    EXPECT_NEAR(reflectance_factor(prepared.f11({{0, 0}, {0, 0}})), row.at_0, 5e-5);
  }
}

// ---- polarized light, and the hemisphere on the other side or both -------------------------------------------------

/// ∫ F cos θr dΩr · light by a rule with these numbers of nodes and azimuths.
double polarized_dhr(const Model& model, const Direction& incident, const Stokes& light, int nodes, int azimuths) {
  const PreparedIncidence prepared = prepare(model, 0.5).at(incident);
  double sum = 0;
  for (const Node& node : gauss_legendre(nodes))
    for (int a = 0; a < azimuths; ++a) {
      const Stokes out = prepared.evaluate({std::acos(1 - node.x), 2 * pi * a / azimuths}, Frame::sp) * light;
      sum += node.weight * (1 - node.x) * out[0];
    }
  return sum * 2 * pi / azimuths / light[0];
}

Stokes any_light() {
  const double degree = between(0, 1), azimuth = between(-4, 4), ellipticity = between(-1.5, 1.5);
  return {2, 2 * degree * std::cos(azimuth) * std::cos(ellipticity),
          2 * degree * std::sin(azimuth) * std::cos(ellipticity), 2 * degree * std::sin(ellipticity)};
}

Direction any_direction(double largest_theta) { return {between(0, largest_theta), between(-4, 4)}; }

constexpr Family families[] = {Family::isotropic, Family::germer2017, Family::anisotropic};

// Theory 5.1. Both are sums of up to 2560 terms, with f11 up to 2 and elements as large in these random models.
RC_GTEST_PROP(Radiometry, FourNodesAndTwelveAzimuthsAreExactForOrders7And4, ()) {
  const Model model = random_model(Family::isotropic, {7, 4}, 1, *rc::gen::arbitrary<std::uint32_t>());
  const Direction incident = any_direction(pi / 2);
  const Stokes light = any_light();
  const double exact = polarized_dhr(model, incident, light, 4, 12);
  RC_ASSERT(std::abs(polarized_dhr(model, incident, light, 40, 64) - exact) < 1e-14);
  RC_ASSERT(std::abs(directional_hemispherical_reflectance(model, 0.5, incident, light) - exact) < 1e-14);
  RC_ASSERT(std::abs(polarized_dhr(model, incident, {1, 0, 0, 0}, 4, 12) -
                     directional_hemispherical_reflectance(model, 0.5, incident)) < dhr_error);
}

TEST(Radiometry, FewerNodesOrAzimuthsAreNotExact) {
  const Model model = random_model(Family::isotropic, {7, 4}, 0, 3);
  const Direction incident{radians(70), 0.3};
  const double exact = polarized_dhr(model, incident, {1, 1, 0, 0}, 4, 12);
  EXPECT_GT(std::abs(polarized_dhr(model, incident, {1, 1, 0, 0}, 3, 12) - exact), 1e-6);
  EXPECT_GT(std::abs(polarized_dhr(model, incident, {1, 1, 0, 0}, 4, 11) - exact), 1e-6);
}

RC_GTEST_PROP(Radiometry, HemisphereNodesAreEnoughForAnyModel, ()) {
  const Orders any{*rc::gen::inRange(0, 10), *rc::gen::inRange(0, 6)};
  const auto mapping = *rc::gen::element(DiscMapping::lambert, DiscMapping::projected);
  for (const Family family : families) {
    const Model model = random_model(family, any, 0, *rc::gen::arbitrary<std::uint32_t>(), mapping);
    const Direction direction = any_direction(pi / 2);
    const Stokes light = any_light();
    RC_ASSERT(std::abs(directional_hemispherical_reflectance(model, 0.5, direction, light) -
                       polarized_dhr(model, direction, light, 30, 40)) < 1e-13);
    double column = 0;
    const PreparedModel prepared = prepare(model, 0.5);
    for (const auto& [incident, weight] : Aperture::hemisphere().quadrature(12)) {
      const Stokes out = prepared.evaluate({incident, direction}, Frame::sp) * Stokes{1, 0, 0, 0};
      for (std::size_t i = 0; i < 4; ++i) column += weight * out[i] * light[i] / light[0];
    }
    RC_ASSERT(std::abs(hemispherical_directional_reflectance(model, 0.5, direction, light) - column) < 1e-13);
  }
}

// Helmholtz: the beam runs backwards, and its third Stokes component changes sign.
RC_GTEST_PROP(Radiometry, ExchangingTheHemisphereAndTheBeamGivesTheSameReflectance, ()) {
  const Family family = *rc::gen::element(Family::isotropic, Family::anisotropic);
  const Model model = random_model(family, {4, 3}, 1, *rc::gen::arbitrary<std::uint32_t>());
  const Direction direction = any_direction(pi / 2);
  const Stokes light = any_light();
  const Stokes reversed{light[0], light[1], -light[2], light[3]};
  RC_ASSERT(std::abs(hemispherical_directional_reflectance(model, 0.5, direction, light) -
                     directional_hemispherical_reflectance(model, 0.5, direction, reversed)) < 1e-13);
  RC_ASSERT(std::abs(hemispherical_directional_reflectance(model, 0.5, direction) -
                     hemispherical_directional_reflectance(model, 0.5, direction, {1, 0, 0, 0})) < 1e-13);
}

TEST(Radiometry, BihemisphericalReflectanceIsTheMeanOfTheDirectionalOne) {
  for (const DiscMapping mapping : {DiscMapping::lambert, DiscMapping::projected})
    for (const Family family : families) {
      Model model = random_model(family, {5, 2}, 1, 7, mapping);
      model.reflectance = {{0.4, 0.6}, {0.9, 0.7}};
      double mean = 0;
      for (const auto& [incident, weight] : Aperture::hemisphere().mean_rule(6))
        mean += weight * directional_hemispherical_reflectance(model, 0.5, incident);
      EXPECT_NEAR(bihemispherical_reflectance(model, 0.5), mean, dhr_error) << to_string(family);
    }
}

// Theory 5.1, from the coefficients of Eq. 9: the only ones that count.
TEST(Radiometry, BihemisphericalReflectanceOfPublishedCoefficientsHasThreeTerms) {
  const Model model = random_model(Family::germer2017, {7, 0}, 0, 5);
  double expected = 0;
  const FittedBlock& f11 = model.blocks.front();
  for (std::size_t q = 0; q < f11.coefficients.size(); ++q) {
    const auto& [function, n, m, k, l] = f11.block.modes[q];
    if (k == 0 && n <= 2) expected += f11.coefficients[q] * (n == 0 ? 1 / 2. : m == 0 ? -1 / std::sqrt(6) : 1 / 6.);
  }
  EXPECT_NEAR(bihemispherical_reflectance(model, 0.5), expected, dhr_error);
}

TEST(Radiometry, RefusesLightThatCannotExist) {
  const Model model = material("ptfe-532");
  for (const Stokes& light : {Stokes{1, 1, 0.1, 0}, {0, 0, 0, 0}, {-1, 0, 0, 0}, {1, std::nan(""), 0, 0}}) {
    EXPECT_THROW(directional_hemispherical_reflectance(model, 0.532, {0, 0}, light), std::invalid_argument);
    EXPECT_THROW(hemispherical_directional_reflectance(model, 0.532, {0, 0}, light), std::invalid_argument);
  }
}

TEST(Radiometry, DirectionalReflectanceRefusesWhatNoModelOrDirectionIs) {
  const Model model = material("ptfe-532");
  EXPECT_THROW(directional_hemispherical_reflectance(model, 0, {0, 0}), std::invalid_argument);
  EXPECT_THROW(directional_hemispherical_reflectance(model, 0.532, {radians(95), 0}), std::invalid_argument);
  EXPECT_THROW(directional_hemispherical_reflectance(Model{}, 0.532, {0, 0}), std::invalid_argument);
}

// ---- finite apertures -----------------------------------------------------------------------------------------------

double largest_difference(const Mueller& a, const Mueller& b) {
  double largest = 0;
  for (std::size_t e = 0; e < 16; ++e) largest = std::max(largest, std::abs(a.elements[e] - b.elements[e]));
  return largest;
}

/// One of each shape, somewhere below some 80 degrees.
Aperture any_aperture(double turn = 0) {
  const Direction axis{between(0, 0.9), between(-4, 4) + turn};
  const double half = between(0.01, 0.4), other = between(0.01, 0.3);
  switch (*rc::gen::inRange(0, 6)) {
    case 0:
      return Aperture::direction(axis);
    case 1:
      return Aperture::cone(axis, half);
    case 2:
      return Aperture::annulus(axis, half / 2, half);
    case 3:
      return Aperture::ellipse(axis, half, other, half);
    case 4:
      return Aperture::rectangle(axis, half, other, other);
    default:
      return Aperture::ring(axis.theta, axis.theta + other);
  }
}

// f11 of curvature c changes by some c α² / 4 over a cone.
TEST(Radiometry, MeanOverVanishingAperturesIsTheValueAtTheirAxes) {
  const PreparedModel model = prepare(material("ptfe"), 0.532);
  const Geometry g{{radians(30), 0.4}, {radians(55), 2}};
  const Mueller value = model.evaluate(g);
  EXPECT_LT(largest_difference(
                average(model, Aperture::direction(g.incident), Aperture::direction(g.reflected)).mueller, value),
            1e-15);
  for (const double half : {2 * smallest_width, 1e-6, 1e-4}) {
    const Average cones = average(model, Aperture::cone(g.incident, half), Aperture::cone(g.reflected, half));
    const Average others = average(model, Aperture::rectangle(g.incident, half, half / 2),
                                   Aperture::ellipse(g.reflected, half, half / 2, 1));
    EXPECT_LT(largest_difference(cones.mueller, value), half * half + 1e-14) << half;
    EXPECT_LT(largest_difference(others.mueller, value), half * half + 1e-14) << half;
  }
}

// The mean over the hemisphere is 1/π of the reflectance.
TEST(Radiometry, MeanOverTheHemisphereIsTheClosedForm) {
  const Model model = material("ptfe");
  const PreparedModel prepared = prepare(model, 0.532);
  const Aperture beam = Aperture::direction({radians(8), 1}), all = Aperture::hemisphere();
  EXPECT_NEAR(pi * average(prepared, beam, all).mueller(0, 0),
              directional_hemispherical_reflectance(model, 0.532, {radians(8), 1}), 1e-14);
  EXPECT_NEAR(pi * average(prepared, all, beam).mueller(0, 0),
              hemispherical_directional_reflectance(model, 0.532, {radians(8), 1}), 1e-14);
  EXPECT_NEAR(pi * average(prepared, all, all).mueller(0, 0), bihemispherical_reflectance(model, 0.532), 1e-14);
  const Average dhr = average(prepared, beam, all);
  EXPECT_TRUE(dhr.converged);
  EXPECT_LT(dhr.error, 1e-12);
  EXPECT_EQ(static_cast<std::size_t>(dhr.geometries), mean_rule(beam, all, dhr.nodes).size());
}

// Theory 5.1, with Legendre's polynomials. R_n^0(ρ) = P_{n/2}(2u − 1), so K_n^0 is that times √((n+1)/2π).
TEST(Radiometry, ReflectanceIntoARingIsTheClosedFormWithLegendrePolynomials) {
  const auto p = [](int q, double x) { return q < 0 ? 1 : std::legendre(static_cast<unsigned>(q), x); };
  const auto big_q = [&](int q, double x) { return q == 0 ? x : (p(q + 1, x) - p(q - 1, x)) / (2 * q + 1); };
  const auto primitive = [&](int q, double x) {
    return big_q(q, x) - (q == 0 ? big_q(1, x) : ((q + 1) * big_q(q + 1, x) + q * big_q(q - 1, x)) / (2 * q + 1));
  };
  const Model model = random_model(Family::germer2017, {7, 0}, 0, 11);
  const Direction incident{radians(50), 0};
  const double from = radians(40), to = radians(50);
  double expected = 0;
  const FittedBlock& f11 = model.blocks.front();
  for (std::size_t mode = 0; mode < f11.coefficients.size(); ++mode)
    for (const Term& term : terms(f11.block.modes[mode], model.family))
      for (int n = 0; n <= 7; n += 2)
        if (term.reflected == zernike_index(n, 0)) {
          int m = 0;
          while (m <= 7 && term.incident != zernike_index(m, 0)) ++m;
          const double ring =
              pi / 2 * (primitive(n / 2, 1 - 2 * std::cos(to)) - primitive(n / 2, 1 - 2 * std::cos(from)));
          expected +=
              f11.coefficients[mode] * term.weight * zernike(m, 0, incident) * std::sqrt((n + 1) / (2 * pi)) * ring;
        }
  const Aperture ring = Aperture::ring(from, to);
  const Average mean = average(prepare(model, 0.5), Aperture::direction(incident), ring);
  EXPECT_NEAR(mean.mueller(0, 0) * ring.projected_solid_angle(), expected, 2e-14);
}

// Off the normal, where published models are not smooth. Either mean has an error of 1e-10.
RC_GTEST_PROP(Radiometry, TurningSourceAndReceiverTogetherTurnsTheMeanMatrix, ()) {
  const Family family = *rc::gen::element(Family::isotropic, Family::germer2017);
  const PreparedModel model = prepare(random_model(family, {5, 3}, 0, *rc::gen::arbitrary<std::uint32_t>()), 0.5);
  const Direction i{between(0.3, 1), between(-4, 4)}, r{between(0.3, 1), between(-4, 4)};
  const double turn = between(-3, 3), half = between(0.01, 0.12);
  const auto mean = [&](double by) {
    return average(model, Aperture::cone({i.theta, i.phi + by}, half),
                   Aperture::rectangle({r.theta, r.phi + by}, half, half / 2, 0.4))
        .mueller;
  };
  const Mueller expected = turned(mean(0), turn);
  RC_ASSERT(largest_difference(mean(turn), expected) < 1e-9 * (1 + std::abs(expected(0, 0))));
  RC_ASSERT(std::abs(mean(turn)(0, 0) - expected(0, 0)) < 1e-9);
}

RC_GTEST_PROP(Radiometry, ExchangingTheAperturesGivesTheExchangedMatrix, ()) {
  const Family family = *rc::gen::element(Family::isotropic, Family::anisotropic);
  const PreparedModel model = prepare(random_model(family, {4, 2}, 0, *rc::gen::arbitrary<std::uint32_t>()), 0.5);
  const Aperture source = any_aperture(), receiver = any_aperture();
  RC_ASSERT(largest_difference(average(model, receiver, source).mueller,
                               exchanged(average(model, source, receiver).mueller)) < 1e-13);
}

// 8:d without and with the specular port: the flux of both adds up.
TEST(Radiometry, FluxThroughAPortAndPastItAddsUp) {
  const PreparedModel model = prepare(material("ptfe"), 0.633);
  const Aperture beam = Aperture::cone({radians(8), 0}, radians(1));
  const Aperture all = Aperture::hemisphere(), port = Aperture::cone({radians(8), pi}, radians(4));
  const auto flux = [&](const Aperture& receiver) {
    return receiver.projected_solid_angle() * average(model, beam, receiver).mueller(0, 0);
  };
  EXPECT_NEAR(flux(all.without(port)) + flux(port), flux(all), 1e-11);  // the tolerance of each, and an area of π
  EXPECT_GT(flux(port), 0.004);
}

// Rules that agree to 1e-13 count as exact: of the tolerances tried, all but the smallest are far above.
RC_GTEST_PROP(Radiometry, ErrorOfTheMeanIsAtMostTheEstimate, ()) {
  const PreparedModel model =
      prepare(random_model(Family::isotropic, {7, 4}, 0, *rc::gen::arbitrary<std::uint32_t>()), 0.5);
  const Aperture source = any_aperture(), receiver = any_aperture();
  AverageOptions options;
  options.tolerance = std::pow(10, between(-10, -2));
  const Average mean = average(model, source, receiver, options);
  options.tolerance = 1e-13;
  const Mueller exact = average(model, source, receiver, options).mueller;
  RC_ASSERT(mean.converged);
  RC_ASSERT(largest_difference(mean.mueller, exact) <= mean.error);
}

// Rules of few nodes know nothing of the middle of a long ellipse: two of them agreed on 0.99971 where 0.9905 is right.
TEST(Radiometry, ErrorOfTheMeanIsAtMostTheEstimateForAperturesThatReachTheHorizon) {
  const PreparedModel model = prepare(material("ptfe-532"), 0.532);
  const Aperture source = Aperture::direction({0.7, 0});
  for (const double longer : {80.0, 89.0, 89.999})
    for (const double shorter : {0.001, 45.0, 80.0}) {
      const double a = radians(shorter), b = radians(longer);
      for (const Aperture& receiver : {Aperture::ellipse({}, a, b, 0.4), Aperture::rectangle({}, b, a, 0.4)}) {
        const Mueller exact = average(model, source, receiver, {.tolerance = 1e-11}).mueller;
        for (const double tolerance : {0.1, 1e-3, 1e-6, 1e-9}) {
          const Average mean = average(model, source, receiver, {.tolerance = tolerance});
          EXPECT_TRUE(mean.converged);
          EXPECT_LE(largest_difference(mean.mueller, exact), mean.error) << longer << ' ' << shorter;
        }
      }
    }
}

// The ellipse and the rectangle that are thin are both a line; the mean along it is that of a few nodes.
TEST(Radiometry, MeanOverAThinEllipseIsThatAlongItsLongAxis) {
  const PreparedModel model = prepare(material("ptfe-532"), 0.532);
  for (const double half : {1.0, 1.4, radians(89.999)}) {
    double sum = 0, weights = 0;  // cos θ × the width of the ellipse over its length: cos θ √(1 − sin²η / sin²b)
    for (const Node& node : gauss_legendre(200)) {
      const double s = std::numbers::pi * (node.x - 0.5), sine = std::sin(half) * std::sin(s);
      const double weight = node.weight * std::cos(s) * std::cos(s);
      sum += weight * model.f11({{0.7, 0}, {std::asin(std::abs(sine)), sine < 0 ? -1.6 : 1.6 - std::numbers::pi}});
      weights += weight;
    }
    const Average mean =
        average(model, Aperture::direction({0.7, 0}), Aperture::ellipse({0, -1.6}, half, 1e-7), {.tolerance = 1e-9});
    EXPECT_NEAR(mean.mueller(0, 0), sum / weights, 1e-8);
  }
}

TEST(Radiometry, MeanOfZeroEndsWithTheRoundingOfWhatCancels) {
  for (const int n : {2, 8, 40}) {
    Model model = random_model(Family::isotropic, {0, 0}, 0, 1);
    model.blocks.resize(1);
    model.blocks[0] = {
        blocks(Family::isotropic, std::vector<Mode>{{Function::m11, n, n, n, -n}}).front(), {1}, {}, 0, 0};
    for (const double theta : {0.1, 1.2}) {
      const Average mean = average(prepare(model, 0.5), Aperture::direction({theta, 0}), Aperture::hemisphere());
      EXPECT_TRUE(mean.converged) << n;
      EXPECT_LE(std::abs(mean.mueller(0, 0)), mean.error);
      EXPECT_LT(mean.geometries, 100'000);
    }
  }
}

TEST(Radiometry, MeanSaysWhereItsToleranceIsNotReached) {
  const PreparedModel model = prepare(random_model(Family::isotropic, {7, 4}, 0, 1), 0.5);
  AverageOptions options;
  options.most_geometries = 1;
  const Average mean = average(model, Aperture::hemisphere(), Aperture::hemisphere(), options);
  EXPECT_FALSE(mean.converged);
  EXPECT_EQ(mean.nodes, 3);
  EXPECT_GT(mean.error, 1e-6);
  for (const double tolerance : {0.0, 1e-14, 1.0, std::nan("")}) {
    options.tolerance = tolerance;
    EXPECT_THROW(average(model, Aperture::hemisphere(), Aperture::hemisphere(), options), std::invalid_argument);
  }
}

}  // namespace
}  // namespace mmbrdf
