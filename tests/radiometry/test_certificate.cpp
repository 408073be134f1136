// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/radiometry/certificate.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <vector>

#include "given/cases.hpp"
#include "given/least_squares.hpp"
#include "given/random_model.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/files/model_file.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"
#include "mmbrdf/radiometry/reflectance_uncertainty.hpp"
#include "mmbrdf/uncertainty/draws.hpp"

namespace mmbrdf {
namespace {

const std::vector<CertifiedReflectance> plaque{{0.6, 0.985, 0.003}, {0.443, 0.99, 0.004}, {0.532, 0.988, 0.005, 0}};

// Reflectances are exact to dhr_error; the covariance adds and takes away terms of one size, so 1e-9 of u remains.
TEST(Certificate, IsTheReflectanceOfTheModelAndItsUncertainty) {
  const Model model = certified(least_squares("ptfe"), plaque).model;
  for (const CertifiedReflectance& one : plaque) {
    const Direction incident{one.theta, 1};
    EXPECT_NEAR(directional_hemispherical_reflectance(model, one.wavelength, incident), one.value, 1e-13);
    const double u = prepare_uncertainty(model, one.wavelength).directional_hemispherical_reflectance(incident);
    EXPECT_NEAR(u / one.uncertainty, 1, 1e-9);
  }
}

// What the fit knows of the ratio of f11 to the reflectance remains, beside the certificate.
TEST(Certificate, CarriesItsUncertaintyIntoEveryOther) {
  const Model before = least_squares("ptfe");
  std::vector<CertifiedReflectance> exact = plaque;
  for (CertifiedReflectance& one : exact) one.uncertainty = 0;
  const Model sharp = certified(before, exact).model, model = certified(before, plaque).model;
  const Geometry g{{0.8, 0}, {0.5, 2.6}};
  for (const CertifiedReflectance& one : plaque) {
    const double alone = prepare_uncertainty(sharp, one.wavelength).evaluate(g)(0, 0),
                 all = prepare_uncertainty(model, one.wavelength).evaluate(g)(0, 0),
                 f11 = prepare(model, one.wavelength).f11(g);
    EXPECT_GT(alone, 0);
    EXPECT_NEAR(all - alone, std::pow(f11 * one.uncertainty / one.value, 2), 1e-9 * all);
  }
}

TEST(Certificate, OfTheReflectanceThatAModelHasChangesNothing) {
  const Model before = least_squares("ptfe");
  const double c = directional_hemispherical_reflectance(before, 0.532, {radians(8), 0});
  const CertifiedModel same = certified(before, std::vector<CertifiedReflectance>{{0.532, c, 0.001}});
  EXPECT_LT(same.change, 1e-13);
  const Geometry g{{0.8, 0}, {0.5, 2.6}};
  const Mueller a = prepare(before, 0.532).evaluate(g), b = prepare(same.model, 0.532).evaluate(g);
  for (std::size_t e = 0; e < 16; ++e) EXPECT_NEAR(a.elements[e], b.elements[e], 1e-13);
}

TEST(Certificate, LeavesTheOtherElementsOverF11AndTellsHowMuchF11Changes) {
  const Model before = least_squares("ptfe-532");
  const CertifiedModel grey = certified(before, std::vector<CertifiedReflectance>{{0.532, 0.5, 0.005}});
  EXPECT_GT(grey.change, noticeable_change);
  EXPECT_EQ(grey.wavelength, 0.532);
  const Geometry g{{0.8, 0}, {0.5, 2.6}};
  const Mueller a = prepare(before, 0.532).evaluate(g), b = prepare(grey.model, 0.532).evaluate(g);
  for (std::size_t e = 0; e < 16; ++e) EXPECT_NEAR((1 - grey.change) * a.elements[e], b.elements[e], 1e-13);
}

TEST(Certificate, NarrowsTheRangeOfTheModelToItsWavelengths) {
  EXPECT_EQ(certified(least_squares("ptfe"), plaque).model.validity.wavelengths, (std::vector{0.443, 0.532, 0.6}));
  const std::vector<CertifiedReflectance> one{{0.5, 0.98, 0.01}};
  EXPECT_EQ(certified(least_squares("ptfe"), one).model.validity.wavelengths, (std::vector{0.5}));
  const std::vector<CertifiedReflectance> at_fitted{{0.351, 0.98, 0.01}, {0.633, 0.98, 0.01}};  // each stays one
  const Model model = certified(least_squares("ptfe"), at_fitted).model;
  EXPECT_EQ(model.validity.wavelengths, (std::vector{0.351, 0.532, 0.633}));
}

TEST(Certificate, IsDrawnFromAsItIsUncertain) {
  const Model model = certified(least_squares("ptfe"), plaque).model;
  const Geometry g{{0.8, 0}, {0.5, 2.6}};
  const auto drawn = values(Draws(model, 4000, 1).at(0.443), [&](const PreparedModel& m) { return m.f11(g); });
  EXPECT_NEAR(distribution(drawn).standard_deviation / std::sqrt(prepare_uncertainty(model, 0.443).evaluate(g)(0, 0)),
              1, 0.045);  // 1.1 % each
}

TEST(Certificate, OfAModelWithoutACovarianceChangesItsValuesAlone) {
  Model model = diffuser({0.3});
  model = certified(model, std::vector<CertifiedReflectance>{{0.5, 0.9, 0.01}}).model;
  EXPECT_NEAR(directional_hemispherical_reflectance(model, 0.5, {0.7, 0}), 0.9, 1e-13);
  EXPECT_FALSE(knows_uncertainty(model));
}

TEST(Certificate, ThatMakesNoSenseIsRefused) {
  const Model model = least_squares("ptfe");
  const auto what = [&](const std::vector<CertifiedReflectance>& list) {
    return message_of([&] { certified(model, list); });
  };
  EXPECT_EQ(what({}), "a certificate without values");
  EXPECT_EQ(what({{1.1, 0.9, 0.01}}), "the model was not fitted at 1100 nm, where the certificate has a value");
  EXPECT_EQ(what({{0.5, 98.8, 0.4}}),
            "reflectance 98.8 of the certificate at 500 nm: must be in (0, 1.2], a part of 1");
  EXPECT_EQ(what({{0.5, 0.9, -1}}), "uncertainty -1 of the certificate at 500 nm: must be in [0, 0.9]");
  EXPECT_EQ(what({{0.5, 0.9, 0.01, radians(90)}}),
            "polar angle 90 degrees of the certificate at 500 nm: must be in [0, 90)");
  EXPECT_EQ(what({{0.5, 0.9, 0.01}, {0.5, 0.91, 0.01}}), "two values of the certificate at 500 nm");
}

/// Of a simulated sample, with the error of the scale that is declared.
Model with_posterior(double scale) {
  FitOptions options;
  options.declared = {scale, radians(0.5), 0};
  return fit_sample(simulate(material("ptfe-532"), std::array{0.532}, random_geometries(150, 1), 0.006, 2), {}, options)
      .model;
}

// What a posterior leaves open of the scale, the declared error of it among them, the certificate knows.
TEST(Certified, UncertaintyOfAPosteriorIsThatOfTheCertificateWhereItHolds) {
  const Model before = with_posterior(0.003);
  const CertifiedReflectance sphere{0.532, 0.95, 0.002, radians(30)};
  const Model model = certified(before, std::vector{sphere}).model;
  const UncertainModel u = uncertain(model, 0.532);
  const auto of = [&](double theta) {
    return standard_uncertainty(directional_hemispherical_budget(u, {radians(theta), 0}));
  };
  EXPECT_NEAR(of(30), 0.002, 1e-12);
  EXPECT_GT(of(70), 0.0021);
  const std::vector<BudgetTerm> parts = u.fit.parts({{radians(30), 0}, {radians(45), 0}});
  const auto scale = std::ranges::find(parts, "declared scale", &BudgetTerm::name);
  ASSERT_NE(scale, parts.end());
  EXPECT_LT(std::sqrt(scale->covariance(0, 0)), 1e-3 * prepare(model, 0.532).f11({{radians(30), 0}, {radians(45), 0}}));
  const Model read = model_from_json(to_json(model), "read");
  EXPECT_EQ(standard_uncertainty(directional_hemispherical_budget(uncertain(read, 0.532), {radians(70), 0})), of(70));
}

// The scale of the fit and the reflectance are drawn against each other, or f11 would be as uncertain as the scale: 0.03.
TEST(Certified, PosteriorIsDrawnFromAsItIsUncertain) {
  const Model model = certified(with_posterior(0.03), std::vector<CertifiedReflectance>{{0.532, 0.95, 0.002}}).model;
  const Geometry g{{0.8, 0}, {0.5, 2.6}};
  const double u = std::sqrt(prepare_uncertainty(model, 0.532).evaluate(g)(0, 0));
  EXPECT_LT(u, 0.01 * prepare(model, 0.532).f11(g));
  const auto drawn = values(Draws(model, 1000, 1).at(0.532), [&](const PreparedModel& m) { return m.f11(g); });
  EXPECT_NEAR(distribution(drawn).standard_deviation / u, 1, 0.09);  // 2.2 % each
}

}  // namespace
}  // namespace mmbrdf
