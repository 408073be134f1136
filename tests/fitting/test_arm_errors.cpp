// SPDX-License-Identifier: BSD-3-Clause
// What a reading changes by when an arm stands at another angle than it says, where it is known without turning any frame.
#include "fitting/arm_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "given/random_model.hpp"
#include "mmbrdf/basis/modes.hpp"
#include "mmbrdf/model/prepared.hpp"

namespace mmbrdf {
namespace {

constexpr double albedo = 0.3, kept = 0.2;  // f11, and f22 = -f33, of all pairs of directions

/// f11, 22 and 33 are constant in the frame xy: only a detector that turns about its beam mixes 22 and 33.
PreparedModel keeping_polarization() {
  Model model = diffuser({albedo});
  for (Block& block : blocks(model.family, {0, 0})) {
    if (block.name != "22,23,32,33") continue;
    FittedBlock fitted{std::move(block), {}, {}, 0, 0};
    fitted.coefficients.resize(fitted.block.modes.size());
    fitted.coefficients[0] = 1;
    model.blocks.push_back(std::move(fitted));
  }
  const double of_one = prepare(model, 0.5).evaluate(Geometry{})(1, 1);
  for (double& coefficient : model.blocks[1].coefficients) coefficient *= kept / of_one;
  return prepare(model, 0.5);
}

Geometry at(double theta_r, double phi_r) { return {{0.5, 0}, {theta_r, phi_r}}; }

TEST(ArmErrors, ThatTurnTheReceiverTurnItsAxesByTheTangentOfHalfItsPolarAngleBesideThePlane) {
  const PreparedModel model = keeping_polarization();
  ASSERT_NEAR(model.evaluate(at(0.7, 1))(1, 1), kept, 1e-12);
  ASSERT_NEAR(model.evaluate(at(0.7, 1))(1, 2), 0, 1e-12);
  for (const double theta_r : {0.2, 0.7, 1.2}) {
    const std::vector<Geometry> beside{at(theta_r, std::numbers::pi / 2), at(theta_r, -std::numbers::pi / 2)};
    const ArmErrors errors = arm_errors(model, beside);
    // Axes that turn by an angle mix 22 and 33 by the sine of twice that; the arm's axis is nearly along the beam at the horizon.
    for (const Mueller& m : errors.receiver) {
      EXPECT_NEAR(std::abs(m(1, 2)), 2 * std::tan(theta_r / 2) * kept / albedo, 1e-7) << theta_r;
      EXPECT_NEAR(m(1, 2), m(2, 1), 1e-7);
      EXPECT_NEAR(m(1, 1), 0, 1e-7);
      EXPECT_NEAR(m(0, 0), 0, 1e-7);
    }
    EXPECT_NEAR(errors.receiver[0](1, 2), -errors.receiver[1](1, 2), 1e-7);  // its mirror image
  }
}

TEST(ArmErrors, TurnNoAxesInThePlaneOfIncidence) {
  const PreparedModel model = keeping_polarization();
  for (const double phi_r : {0.0, std::numbers::pi}) {
    const ArmErrors errors = arm_errors(model, std::vector{at(0.7, phi_r)});
    for (const Mueller& m : {errors.source[0], errors.receiver[0]})
      for (const double element : m.elements) EXPECT_NEAR(element, 0, 1e-7);
  }
}

TEST(ArmErrors, OfF11AreTheSlopesAlongEachArm) {
  const PreparedModel model = prepare(random_model(Family::isotropic, {4, 2}, 0, 1), 0.5);
  const double step = 1e-5, theta_i = 0.5, theta_r = 0.7;
  const auto f11 = [&](double i, double r) { return model.f11({{i, 0}, {r, std::numbers::pi}}); };
  const ArmErrors errors = arm_errors(model, std::vector{at(theta_r, std::numbers::pi)});
  // The axis is (0, -1, 0): the source, in +x, goes down, and the receiver, in -x, goes up.
  EXPECT_NEAR(std::abs(errors.source[0](0, 0)),
              std::abs((f11(theta_i + step, theta_r) - f11(theta_i - step, theta_r)) / (2 * step)), 1e-6);
  EXPECT_NEAR(std::abs(errors.receiver[0](0, 0)),
              std::abs((f11(theta_i, theta_r + step) - f11(theta_i, theta_r - step)) / (2 * step)), 1e-6);
}

}  // namespace
}  // namespace mmbrdf
