// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/uncertainty/budget.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "given/cases.hpp"
#include "given/least_squares.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/polarization/gradients.hpp"
#include "mmbrdf/uncertainty/draws.hpp"

namespace mmbrdf {
namespace {

const Geometry oblique{{0.8, 0.3}, {0.5, 2.6}};

struct Ptfe {
  Model model = least_squares("ptfe-532");
  PreparedModel prepared = prepare(model, 0.532);
  PreparedUncertainty fit = prepare_uncertainty(model, 0.532);
};

double relative(const MuellerCovariance& v, const Mueller& f) { return std::sqrt(v(0, 0)) / f(0, 0); }

TEST(Term, IsReadAsPeopleTypeIt) {
  const TypeBTerm plaque = term_from("plaque: white:scale=0.3%,dof=12");
  EXPECT_EQ(plaque.name, "plaque: white");
  EXPECT_EQ(plaque.what, ErrorOf::scale);
  EXPECT_DOUBLE_EQ(plaque.uncertainty, 0.003);
  EXPECT_EQ(plaque.freedom, 12);
  EXPECT_EQ(term_from("calibration=0.001").name, "calibration");
  EXPECT_TRUE(std::isinf(term_from("calibration=0.001").freedom));
  for (const char* angle : {"theta_i=2deg", "theta_r=2", "azimuth=+2deg"})
    EXPECT_DOUBLE_EQ(term_from(angle).uncertainty, radians(2));
  for (const char* wrong : {"scale", "detector=1", "scale=", "scale=1deg", "theta_r=1%", "scale=-1%", "scale=nan",
                            "scale=1%,dof=0.5", "scale=1%,dof=", "scale=0.003,free=2"})
    EXPECT_THROW(term_from(wrong), std::invalid_argument) << wrong;
}

TEST(Budget, IsTheSumOfItsTermsAndKeepsThem) {
  const Ptfe ptfe;
  const std::vector<TypeBTerm> terms{{"plaque", ErrorOf::scale, 0.003}, {"aperture", ErrorOf::scale, 0.004}};
  const Budget b = budget(ptfe.prepared, ptfe.fit, terms, oblique, Frame::sp);
  ASSERT_EQ(b.terms.size(), 3U);
  EXPECT_EQ(b.terms[0].name, "fit");
  for (std::size_t i = 0; i < 256; ++i)
    EXPECT_NEAR(b.terms[0].covariance.values[i], ptfe.fit.evaluate(oblique, Frame::sp).values[i], 1e-20);  // rounding
  EXPECT_EQ(b.terms[2].name, "aperture");
  for (std::size_t i = 0; i < 256; ++i)
    EXPECT_NEAR(b.total.values[i],
                b.terms[0].covariance.values[i] + b.terms[1].covariance.values[i] + b.terms[2].covariance.values[i],
                1e-20);
  // Both scales together are one of 0.5 %, and it cancels in what is relative to f11.
  const Mueller f = ptfe.prepared.evaluate(oblique, Frame::sp);
  EXPECT_NEAR(std::pow(relative(b.total, f), 2) - std::pow(relative(b.terms[0].covariance, f), 2), 0.005 * 0.005,
              1e-12);
  // It is the square root of what rounding leaves of a variance of (0.003 f)².
  EXPECT_NEAR(standard_uncertainty(depolarization_gradient(f), b.terms[1].covariance), 0, 1e-10);
}

// GUM: u(f)/f = tan θr u(θr) where the BRDF itself does not vary (theory 4.6).
// A fit of several wavelengths has a reflectance table of its own, which is uncertain, too.
TEST(Budget, OfAFitAloneIsItsCovarianceHoweverItCameByItsReflectance) {
  for (const char* name : {"ptfe-532", "ptfe"}) {
    const Model model = least_squares(name);
    const PreparedUncertainty fit = prepare_uncertainty(model, 0.532);
    for (const Frame frame : {Frame::xy, Frame::sp, Frame::scattering_plane}) {
      const MuellerCovariance all = fit.evaluate(oblique, frame);
      const std::vector<BudgetTerm> parts = fit.parts(oblique, frame);
      ASSERT_EQ(parts.size(), 1U);
      for (std::size_t i = 0; i < 256; ++i)  // rounding of sums over the coefficients
        EXPECT_NEAR(parts[0].covariance.values[i], all.values[i], 1e-9 * all(0, 0)) << name;
    }
  }
}

TEST(Budget, OfADetectorAngleHasTheTangentOfTheMeasurementEquation) {
  Model lambertian = least_squares("ptfe-532");
  for (FittedBlock& block : lambertian.blocks)
    for (double& a : block.coefficients) a = &a == block.coefficients.data() && block.block.name == "11" ? 2 : 0;
  const PreparedModel prepared = prepare(lambertian, 0.532);
  const double f11 = prepared.f11({});
  for (const double theta : {0.0, 0.7, 1.3}) {
    const Geometry g{{0.4, 0}, {theta, 1}};
    const Mueller effect = effects({"arm", ErrorOf::theta_r, 1e-3}, prepared, g).front();
    EXPECT_NEAR(effect(0, 0), -1e-3 * std::tan(theta) * f11, 1e-12 * f11);
    EXPECT_NEAR(effects({"arm", ErrorOf::theta_i, 1e-3}, prepared, g).front()(0, 0), 0, 1e-12);
  }
}

/// What a polarimeter reports whose detector is at θr + d instead of θr, and so on, in the sp frame of its arms.
Mueller misread(const PreparedModel& model, const Geometry& g, ErrorOf what, double d) {
  Geometry moved = g;
  double factor = 1;
  if (what == ErrorOf::theta_i) moved.incident = unfolded({g.incident.theta + d, g.incident.phi});
  if (what == ErrorOf::theta_r) {
    moved.reflected = unfolded({g.reflected.theta + d, g.reflected.phi});
    factor = std::cos(g.reflected.theta + d) / std::cos(g.reflected.theta);
  }
  if (what == ErrorOf::azimuth) moved.reflected.phi += d;
  if (what == ErrorOf::scale) factor = 1 + d;
  return factor * model.evaluate(moved, Frame::sp);
}

// Of an error of 1e-4: what is left is its square times a second derivative of f11, and 2e-9 of the differences.
RC_GTEST_PROP(Budget, HasTheEffectOfASmallErrorOfTheMeasurement, ()) {
  static const Ptfe ptfe;
  const Geometry g{{between(0, 1.3), between(-3, 3)}, {between(0, 1.3), between(-3, 3)}};
  const Frame frame = *rc::gen::element(Frame::xy, Frame::sp, Frame::scattering_plane);
  constexpr double d = 1e-4;
  const Mueller f = ptfe.prepared.evaluate(g, frame);
  for (const ErrorOf what : {ErrorOf::scale, ErrorOf::theta_i, ErrorOf::theta_r, ErrorOf::azimuth}) {
    const Mueller wrong = change_frame(misread(ptfe.prepared, g, what, d), g, Frame::sp, frame);
    const std::vector<Mueller> effect = effects({"error", what, d}, ptfe.prepared, g, frame);
    RC_ASSERT(effect.size() == 1U);
    for (std::size_t e = 0; e < 16; ++e)
      RC_ASSERT(std::abs(effect[0].elements[e] - (wrong - f).elements[e]) < 20 * d * d);
  }
}

// Independent errors of one size of all normalised elements are so in each frame.
TEST(Budget, OfACalibrationIsTheSameInEachFrame) {
  const Ptfe ptfe;
  const TypeBTerm term{"retarder", ErrorOf::calibration, 0.001};
  const double f11 = ptfe.prepared.f11(oblique);
  for (const Frame frame : {Frame::xy, Frame::sp, Frame::scattering_plane}) {
    const Budget b = budget(ptfe.prepared, ptfe.fit, std::array{term}, oblique, frame);
    const Mueller u = standard_uncertainty(b.terms[1].covariance);
    EXPECT_EQ(u(0, 0), 0);
    for (std::size_t e = 1; e < 16; ++e) EXPECT_NEAR(u.elements[e], 0.001 * f11, 1e-16);
  }
  const Mueller turn = rotator(0.4), back = rotator(-1.1);
  MuellerCovariance turned;
  for (const Mueller& effect : effects(term, ptfe.prepared, oblique)) {
    const Mueller e = turn * effect * back;
    for (std::size_t a = 0; a < 16; ++a)
      for (std::size_t c = 0; c < 16; ++c) turned(a, c) += e.elements[a] * e.elements[c];
  }
  for (std::size_t a = 1; a < 16; ++a)
    for (std::size_t c = 1; c < 16; ++c) EXPECT_NEAR(turned(a, c), a == c ? std::pow(0.001 * f11, 2) : 0, 1e-19);
}

TEST(Budget, IsFiniteFromTheNormalToTheHorizon) {
  const Ptfe ptfe;
  const double grazing = std::acos(0.0);
  for (const double i : {0.0, 1.0, grazing})
    for (const double r : {0.0, 1.0, grazing})
      for (const ErrorOf what : {ErrorOf::theta_i, ErrorOf::theta_r, ErrorOf::azimuth, ErrorOf::calibration}) {
        if (what == ErrorOf::theta_r && r == grazing) continue;
        for (const Mueller& effect : effects({"error", what, 0.1}, ptfe.prepared, {{i, 0}, {r, 2}}))
          for (const double element : effect.elements) EXPECT_TRUE(std::isfinite(element));
      }
}

// 4000 draws: standard deviations are uncertain by 1.1 %.
// At 90 degrees the slope is one-sided.
TEST(Budget, OfThePolarAngleOfTheSourceIsContinuousUpToTheHorizon) {
  const Ptfe ptfe;
  const auto effect = [&](double theta_i) {
    return effects({"arm", ErrorOf::theta_i, 0.01}, ptfe.prepared, {{theta_i, 0}, {0.5, 2.6}}, Frame::sp).front();
  };
  const Mueller at = effect(std::numbers::pi / 2), before = effect(std::numbers::pi / 2 - 1e-3);
  for (std::size_t e = 0; e < 16; ++e)
    EXPECT_NEAR(at.elements[e], before.elements[e], 0.01 * std::abs(before(0, 0))) << e;
}

// Errors of terms and draws of coefficients have streams of their own. With one stream for both, draw k of a term would be
// one of the numbers behind the coefficients of another draw: the total is the same, and no law of it can tell.
TEST(Budget, DrawnAlongWithTheCoefficientsHasTheTotalUncertainty) {
  const Ptfe ptfe;
  const std::vector<TypeBTerm> terms{
      {"plaque", ErrorOf::scale, 0.002}, {"arm", ErrorOf::theta_r, 0.003}, {"retarder", ErrorOf::calibration, 0.001}};
  const auto draws = Draws(ptfe.model, 4000, 4).at(0.532);
  const Mueller u = standard_uncertainty(budget(ptfe.prepared, ptfe.fit, terms, oblique).total);
  const std::vector<Mueller> matrices = drawn(draws, ptfe.prepared, terms, oblique, Frame::xy, 4);
  for (const std::size_t e : {0u, 1u, 5u, 15u}) {
    std::vector<double> values;
    for (const Mueller& m : matrices) values.push_back(m.elements[e]);
    EXPECT_NEAR(distribution(values).standard_deviation / u.elements[e], 1, 0.045) << e;
  }
  EXPECT_EQ(matrices, drawn(draws, ptfe.prepared, terms, oblique, Frame::xy, 4));
}

TEST(Budget, RefusesTermsThatMakeNoSense) {
  const Ptfe ptfe;
  const auto of = [&](const TypeBTerm& term, const Geometry& g) {
    return message_of([&] { effects(term, ptfe.prepared, g); });
  };
  EXPECT_EQ(of({"plaque", ErrorOf::scale, -0.1}, oblique), "uncertainty -0.1 of plaque, must be in [0, 10]");
  EXPECT_EQ(of({"plaque", ErrorOf::scale, std::nan("")}, oblique), "uncertainty nan of plaque, must be in [0, 10]");
  EXPECT_EQ(of({"arm", ErrorOf::theta_r, 0.1}, {{}, {std::acos(0.0), 0}}),
            "theta_r = 90 degrees, where no measurement tells f11 and a term theta_r is infinite");
  EXPECT_THROW(effects({"plaque", ErrorOf::scale, 0.1}, ptfe.prepared, {{2, 0}, {}}), std::invalid_argument);
  EXPECT_EQ(message_of([] { error_from("phi"); }),
            "kind of error 'phi' is not one of scale, theta_i, theta_r, azimuth, calibration");
  for (const ErrorOf what :
       {ErrorOf::scale, ErrorOf::theta_i, ErrorOf::theta_r, ErrorOf::azimuth, ErrorOf::calibration})
    EXPECT_EQ(error_from(to_string(what)), what);
}

}  // namespace
}  // namespace mmbrdf
