// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarimetry/rotating_retarders.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "given/calibrations.hpp"
#include "given/cases.hpp"
#include "given/files.hpp"
#include "given/random_mueller.hpp"
#include "mmbrdf/polarimetry/judgement.hpp"
#include "mmbrdf/polarimetry/reduction.hpp"

namespace mmbrdf {
namespace {

constexpr double right_angle = radians(90);

Polarimeter turning(double ratio, double step_deg, std::size_t frames, double retardance = right_angle) {
  RotatingRetarders ideal;
  ideal.generator.retardance = ideal.analyzer.retardance = retardance;
  return polarimeter(ideal, dial_angles(ratio, radians(step_deg), frames));
}

/// None of the numbers is what it should be.
RotatingRetarders imperfect() {
  return {{radians(86), radians(2.5), radians(1), 0.02}, {radians(93), radians(-1.5), radians(-2), -0.01}, 1e-3, 1.7};
}

const std::vector<DialAngles> sixty_one = dial_angles(5, radians(6), 61);

GoniometerOptions turning_goniometer() {
  GoniometerOptions options;
  options.dials = sixty_one;
  options.retardance = right_angle;
  options.imperfections.azimuth = radians(2);
  options.extinction = 0;
  return options;
}

CalibrationOptions turning_options() {
  CalibrationOptions options;
  options.wavelength = wavelength;
  options.retarders.emplace();
  options.retarders->dials = sixty_one;
  return options;
}

std::vector<Reference> air(const Goniometer& goniometer, int count, unsigned long seed) {
  return only(goniometer.references(wavelength, count, seed),
              [](const Reference& r) { return r.kind == ReferenceKind::empty; });
}

/// Readings of a retarder, its fast axis at an azimuth.
Reference retarder_reference(const Polarimeter& p, double retardance, double azimuth, int sign = 0) {
  return {ReferenceKind::retarder, azimuth, readings(p, 0.9 * retarder(retardance, azimuth)), 0, sign};
}

/// Of axes: modulo 180 degrees.
double azimuths(const RotatingRetarders& a, const RotatingRetarders& b, std::size_t k) {
  return std::remainder(parameters(a)[k] - parameters(b)[k], std::numbers::pi);
}

double largest_difference(const RotatingRetarders& a, const RotatingRetarders& b) {
  double result = 0;
  for (std::size_t k = 0; k < retarder_parameters; ++k)
    result = std::max(result, std::abs(k == 1 || k == 2 || k == 5 || k == 6 ? azimuths(a, b, k)
                                                                            : parameters(a)[k] - parameters(b)[k]));
  return result;
}

// ---- states ---------------------------------------------------------------------------------------------------------

TEST(RotatingRetarders, AreProductsOfTheirElements) {
  const RotatingRetarders r = imperfect();
  const std::vector<DialAngles> dials{{0.3, 1.7}};
  const Polarimeter p = polarimeter(r, dials);
  const auto plate = [](const RetarderArm& arm, double dial) {
    return rotated(mueller({1, std::acos(arm.diattenuation) / 2, arm.retardance}), arm.offset + dial);
  };
  const Stokes w = plate(r.generator, 0.3) * (polarizer(r.generator.polarizer, r.extinction) * Stokes{2, 0, 0, 0});
  const Stokes a =
      transpose(polarizer(r.analyzer.polarizer, r.extinction) * plate(r.analyzer, 1.7)) * Stokes{1, 0, 0, 0};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(p.generator[0][k], w[k], 1e-15);
    EXPECT_NEAR(p.analyzer[0][k], 1.7 * a[k], 1e-15);
  }
  EXPECT_EQ(p.pairs, (std::vector<StatePair>{{0, 0}}));
}

// That the states are those of polarizer and retarder as elements.hpp has them.
TEST(RotatingRetarders, WithoutDefectsAreTheIdealPolarimeterReadPairwise) {
  const Polarimeter p = turning(1, 7, 5), ideal = ideal_polarimeter(right_angle, std::vector<double>{0, radians(7)});
  for (std::size_t s = 0; s < 2; ++s)
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(p.generator[s][k], ideal.generator[s][k], 1e-15);
      EXPECT_NEAR(p.analyzer[s][k], ideal.analyzer[s][k], 1e-15);
    }
}

/// Spec of the instrument: frames, step, ratio; rank; condition with plates of 90 and of 127 degrees.
struct Row {
  std::size_t frames;
  double step, ratio;
  int rank;
  double condition_90 = 0, condition_127 = 0;
};

// The rank is a trap: frames that look plenty measure 14 combinations of elements, or 4. Computed with numpy.
TEST(RotatingRetarders, HaveTheRankAndConditionOfThePrototype) {
  const std::vector<Row> rows{{61, 6, 5, 16, 13.04, 3.48},
                              {60, 6, 5, 16, 13.05, 3.48},
                              {31, 6, 5, 16, 13.08, 3.52},
                              {25, 7.2, 5, 16, 13.05, 3.48},
                              {36, 10, 5, 14},
                              {32, 11.25, 5, 14},
                              {30, 12, 5, 12},
                              {24, 15, 5, 11},
                              {20, 18, 5, 4},
                              {16, 22.5, 5, 7},
                              {36, 10, 2.5, 16, 13.05, 3.48},
                              {32, 11.25, 2.5, 16, 13.05, 3.48},
                              {30, 12, 2.5, 16, 13.05, 3.48},
                              {31, 6, 2.5, 16, 324, 146},
                              {18, 10, 2.5, 16, 716, 321}};
  for (const Row& row : rows) {
    const Reduction at_90(turning(row.ratio, row.step, row.frames));
    const Reduction at_127(turning(row.ratio, row.step, row.frames, radians(127)));
    EXPECT_EQ(at_90.rank(), row.rank) << row.frames << " x " << row.step;
    EXPECT_EQ(at_127.rank(), row.rank) << row.frames << " x " << row.step;
    EXPECT_EQ(at_90.undetermined().none(), row.rank == 16);
    if (row.rank < 16) continue;
    EXPECT_NEAR(at_90.condition(), row.condition_90, row.condition_90 > 100 ? 0.5 : 0.005) << row.frames;
    EXPECT_NEAR(at_127.condition(), row.condition_127, row.condition_127 > 100 ? 0.5 : 0.005) << row.frames;
  }
  for (const auto& [frames, step] : {std::pair(61U, 6.), {36U, 10.}, {25U, 7.2}, {90U, 4.}})
    EXPECT_LE(Reduction(turning(3, step, frames)).rank(), 15) << frames;
}

// To the rounding of the readings, that of elements of 1, times a condition of 13 over the root of 61 readings; measured
// 2.7e-16 of the elements, rms.
TEST(RotatingRetarders, GiveTheMatrixOfTheirReadings) {
  const Polarimeter p = turning(5, 6, 61);
  const Reduction reduction(p);
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> element(-1, 1);
  double errors = 0, squares = 0;
  for (int n = 0; n < 1000; ++n) {
    Mueller m;
    for (double& e : m.elements) e = element(engine);
    const Mueller d = reduction.mueller(readings(p, m)) - m;
    for (std::size_t e = 0; e < 16; ++e) {
      errors += d.elements[e] * d.elements[e];
      squares += m.elements[e] * m.elements[e];
    }
  }
  RecordProperty("relative", std::to_string(1e16 * std::sqrt(errors / squares)) + "e-16");
  EXPECT_LE(std::sqrt(errors / squares), 4e-16);
  EXPECT_LE(std::sqrt(errors / (16 * 1000)), 2e-16);  // of the largest that an element can be, as M11 is
}

TEST(RotatingRetarders, OfRankFourteenDetermineSomeElementsAndSayWhich) {
  const Polarimeter p = turning(5, 10, 36);
  const Reduction reduction(p);
  const Mueller m = test_matrices()[3], found = reduction.mueller(readings(p, m));
  EXPECT_GT(reduction.undetermined().count(), 0u);
  EXPECT_LT(reduction.undetermined().count(), 16u);
  for (std::size_t e = 0; e < 16; ++e) {
    EXPECT_EQ(std::isnan(found.elements[e]), reduction.undetermined()[e]);
    if (reduction.undetermined()[e]) continue;
    EXPECT_NEAR(found.elements[e], m.elements[e], 1e-13) << e;
  }
}

TEST(RotatingRetarders, HaveSlopesThatAreFiniteDifferences) {
  const RotatingRetarders r = imperfect();
  const std::vector<DialAngles> dials{{0.3, 1.7}, {1.1, -0.4}};
  const std::vector<double> slope = slopes(r, dials);
  const auto component = [&](const RotatingRetarders& at, std::size_t c) {
    const Polarimeter p = polarimeter(at, dials);
    return c < 8 ? p.generator[c / 4][c % 4] : p.analyzer[c / 4 - 2][c % 4];
  };
  const double step = 1e-5;  // its square times third derivatives of up to 8: 1e-9
  for (std::size_t k = 0; k < retarder_parameters; ++k) {
    RotatingRetarders above = r, below = r;
    *parameters(above)[k] += step;
    *parameters(below)[k] -= step;
    for (std::size_t c = 0; c < 16; ++c)
      EXPECT_NEAR((component(above, c) - component(below, c)) / (2 * step), slope[c * retarder_parameters + k], 3e-9)
          << parameter_name(k) << ", component " << c;
  }
}

TEST(RotatingRetarders, RefuseNumbersThatAreNone) {
  const auto refusal = [](const std::function<void(RotatingRetarders&)>& spoil) {
    RotatingRetarders r = imperfect();
    spoil(r);
    return message_of([&] { polarimeter(r, sixty_one); });
  };
  EXPECT_EQ(refusal([](RotatingRetarders& r) { r.analyzer.diattenuation = 1.5; }),
            "a diattenuation of 1.5, must be within -1 ... 1");
  EXPECT_EQ(refusal([](RotatingRetarders& r) { r.generator.diattenuation = -1.5; }),
            "a diattenuation of -1.5, must be within -1 ... 1");
  EXPECT_EQ(refusal([](RotatingRetarders& r) { r.extinction = -0.1; }), "extinction -0.1 is not in [0, 1]");
  EXPECT_EQ(refusal([](RotatingRetarders& r) { r.generator.offset = std::nan(""); }),
            "a number of the rotating retarders is not finite");
  EXPECT_EQ(message_of([] { dial_angles(5, radians(6), 101); }), "101 frames, must be 1 to 100");
  EXPECT_EQ(message_of([] { dial_angles(0, radians(6), 61); }), "a ratio of 0");
  EXPECT_EQ(refusal([](RotatingRetarders& r) { r.extinction = 1.1; }), "extinction 1.1 is not in [0, 1]");
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(message_of([&] { dial_angles(infinite, radians(6), 61); }), "a ratio of inf");
  EXPECT_EQ(message_of([&] { dial_angles(5, infinite, 61); }), "steps of inf degrees");
  EXPECT_EQ(message_of([] { dial_angles(5, 0, 61); }), "steps of 0 degrees");
  EXPECT_EQ(message_of([] { dial_angles(5, radians(6), 0); }), "0 frames, must be 1 to 100");
  EXPECT_EQ(message_of([] { dial_angles(1e200, 1e200, 2); }), "a step and a ratio that leave no finite angles");
  for (double DialAngles::*const dial : {&DialAngles::generator, &DialAngles::analyzer}) {
    std::vector<DialAngles> dials = sixty_one;
    dials.back().*dial = infinite;
    EXPECT_EQ(message_of([&] { polarimeter(imperfect(), dials); }), "an angle of a dial is not finite");
  }
  EXPECT_EQ(message_of([] { state_covariance(imperfect(), sixty_one, std::vector<double>(99)); }),
            "the covariance of the retarders has 99 numbers, expected 100");
}

// ---- calibration ----------------------------------------------------------------------------------------------------

// From air alone; without noise nothing but rounding is left, in the numbers some thousand times that of readings.
TEST(TurningRetarders, AreFoundFromAirAlone) {
  GoniometerOptions made = turning_goniometer();
  made.noise = {};
  for (unsigned long seed = 1; seed <= 10; ++seed) {
    const Goniometer goniometer(made, seed);
    const Calibration c = calibrate(air(goniometer, 1, seed), turning_options());
    RotatingRetarders found = c.retarders->values;
    found.responsivity = 1;  // of the one empty reference, whose gain nobody knows
    EXPECT_LE(largest_difference(found, *goniometer.retarders()), 1e-9) << seed;
    EXPECT_LE(c.figure_of_merit.total, 1e-9);
    EXPECT_TRUE(judged(c, {}, turning_options().retarders).doubts.empty());
  }
}

// Far from the nominal numbers the way down the hill ends in another valley; other starts find the deepest.
TEST(TurningRetarders, AreFoundFarFromTheirNominalNumbers) {
  RotatingRetarders far;
  far.generator = {radians(112), radians(38), 0, 0.01};
  far.analyzer = {radians(75), radians(-40), radians(-63), -0.02};
  const Polarimeter p = polarimeter(far, sixty_one);
  const std::vector<Reference> one{{ReferenceKind::empty, 0, readings(p, identity())}};
  const Calibration c = calibrate(one, turning_options());
  EXPECT_LE(largest_difference(c.retarders->values, far), 1e-9);
  const Verdict verdict = judged(c, {}, turning_options().retarders);
  ASSERT_EQ(verdict.doubts.size(), 1u);
  EXPECT_TRUE(says(verdict.doubts[0], {"a fast axis is 40.0 degrees from its nominal azimuth"}));
}

// Fast axes of both for slow ones, and the diattenuations turned with them: the same readings of air, and S4 with the other
// sign. A retarder of known axes tells; two that contradict each other are refused.
TEST(TurningRetarders, ExchangeFastAndSlowAxesUnseenInAirAndSeenWithARetarder) {
  RotatingRetarders turned;
  for (RetarderArm* arm : {&turned.generator, &turned.analyzer}) arm->offset = radians(90);
  const Polarimeter p = polarimeter(turned, sixty_one), straight = polarimeter(RotatingRetarders{}, sixty_one);
  for (std::size_t j = 0; j < 61; ++j)
    EXPECT_NEAR(readings(p, identity())[j], readings(straight, identity())[j],
                5e-15);  // cosines of 360 degrees and more
  std::vector<Reference> references{{ReferenceKind::empty, 0, readings(p, identity())}};
  const Calibration in_air = calibrate(references, turning_options());
  EXPECT_LE(largest_difference(in_air.retarders->values, RotatingRetarders{}), 1e-9);  // the nearer one, and wrong
  references.push_back(retarder_reference(p, radians(60), radians(20)));
  const Calibration right = calibrate(references, turning_options());
  EXPECT_LE(largest_difference(right.retarders->values, turned), 1e-8);
  EXPECT_TRUE(judged(right, {}, turning_options().retarders).doubts.empty());
  EXPECT_NEAR(right.references[1].element.delta, radians(60), 1e-9);
  EXPECT_NEAR(right.references[1].element.tau, 0.9, 1e-9);
  references.push_back(retarder_reference(p, radians(60), radians(70), -1));
  EXPECT_TRUE(says(refusal(references, turning_options()),
                   {"delta_sign is stated as", "but together with the other references its readings say"}));
  // A half-wave plate does not tell.
  std::vector<Reference> half{references[0], retarder_reference(p, radians(179), radians(20))};
  CalibrationOptions nominal = turning_options();
  nominal.retarders->nominal.generator.offset = nominal.retarders->nominal.analyzer.offset = radians(40);
  EXPECT_TRUE(
      says(judged(calibrate(half, nominal), {}, nominal.retarders).doubts.at(0), {"a fast axis is 4", "slow one"}));
}

// A wafer, whose plane is the scattering plane, or a retarder at a known azimuth show how the first polarizer stands.
TEST(TurningRetarders, AreTurnedAsTheirReferencesSay) {
  GoniometerOptions made = turning_goniometer();
  made.noise = {};
  RotatingRetarders turned = *Goniometer(made, 3).retarders();
  for (RetarderArm* arm : {&turned.generator, &turned.analyzer}) {
    arm->polarizer += radians(1.5);
    arm->offset += radians(1.5);
  }
  const Polarimeter p = polarimeter(turned, sixty_one);
  std::vector<Reference> references{{ReferenceKind::empty, 0, readings(p, identity())}};
  const Calibration in_air = calibrate(references, turning_options());
  EXPECT_EQ(in_air.retarders->values.generator.polarizer, 0);
  EXPECT_EQ(in_air.retarders->covariance[2 * retarder_parameters + 2], 0);
  references.push_back(retarder_reference(p, radians(60), radians(20)));
  for (const double dial : {0., 40., 80.})
    references.push_back(
        {ReferenceKind::polarizer, radians(dial), readings(p, 0.8 * polarizer(radians(dial + 23), 1e-4))});
  const DiattenuatorRetarder film = reflection(GoniometerOptions{}.film, wavelength, radians(65));
  references.push_back({ReferenceKind::wafer, radians(65), readings(p, mueller(film)), film.psi < radians(45) ? 1 : -1,
                        film.delta > 0 ? 1 : -1});
  const Calibration c = calibrate(references, turning_options());
  EXPECT_LE(largest_difference(c.retarders->values, turned), 1e-8);
  EXPECT_NEAR(c.polarizer_offset, radians(23), 1e-8);
  EXPECT_NEAR(c.extinction, 1e-4, 1e-8);
  EXPECT_NEAR(c.references.back().element.psi, film.psi, 1e-8);
  EXPECT_LE(c.figure_of_merit.total, 1e-8);
  references.back().delta_sign = film.delta > 0 ? -1 : 1;
  EXPECT_TRUE(says(refusal(references, turning_options()), {"reference", "is stated as", "readings say"}));
  references.back().delta_sign = 0;
  EXPECT_TRUE(says(refusal(references, turning_options()), {"reference 6: a wafer without signs"}));
}

// A first polarizer along p, where it was thought along s: a wafer of known signs shows it, a film too, whose thickness is
// fitted.
TEST(TurningRetarders, AreFoundWithTheFirstPolarizerAcrossWhereAWaferTells) {
  RotatingRetarders across = imperfect();
  across.extinction = 0;
  for (RetarderArm* arm : {&across.generator, &across.analyzer}) {
    arm->polarizer += right_angle;
    arm->offset += right_angle;
  }
  const Polarimeter p = polarimeter(across, sixty_one);
  CalibrationOptions options = turning_options();
  options.film = GoniometerOptions{}.film;
  std::vector<Reference> references{{ReferenceKind::empty, 0, readings(p, identity())}};
  for (const double theta_i : {35., 50., 58., 66., 72.})
    references.push_back({ReferenceKind::wafer, radians(theta_i),
                          readings(p, mueller(reflection(*options.film, wavelength, radians(theta_i))))});
  options.film->thickness *= 1.04;
  const Calibration c = calibrate(references, options);
  EXPECT_LE(error(c.polarimeter, p), 1e-7);
  EXPECT_NEAR(c.film_thickness, GoniometerOptions{}.film.thickness, 1e-6);
  EXPECT_NEAR(azimuths(c.retarders->values, across, 2), 0, 1e-7);
  options.film->thickness = 0.7;
  EXPECT_TRUE(says(refusal(references, options), {"the film"}));
}

TEST(TurningRetarders, AreFoundThoughTheSourceDrifts) {
  GoniometerOptions made = turning_goniometer();
  made.noise = {};
  made.drift = 0.05;
  const Goniometer goniometer(made, 5);
  const std::vector<Reference> one = air(goniometer, 1, 2);
  const Calibration c = calibrate(one, turning_options());
  EXPECT_LE(error(c.polarimeter, goniometer.polarimeter()), 1e-9);
  EXPECT_NEAR(c.references[0].drift, 0.05, 1e-9);
  CalibrationOptions steady = turning_options();
  steady.retarders->fit_drift = false;
  EXPECT_GT(error(calibrate(one, steady).polarimeter, goniometer.polarimeter()), 1e-4);
}

TEST(TurningRetarders, HaveAnExtinctionThatAirTells) {
  RotatingRetarders leaky = imperfect();
  leaky.generator.polarizer = 0;
  leaky.extinction = 0.01;
  const std::vector<Reference> one{{ReferenceKind::empty, 0, readings(polarimeter(leaky, sixty_one), identity())}};
  EXPECT_LE(largest_difference(calibrate(one, turning_options()).retarders->values, leaky), 1e-7);
  CalibrationOptions tight = turning_options();
  tight.retarders->fit_extinction = false;
  const Calibration c = calibrate(one, tight);
  EXPECT_GT(largest_difference(c.retarders->values, leaky), 1e-3);
  EXPECT_TRUE(says(judged(c).doubts.back(), {"chi^2/dof is", "more than 4"}));
}

TEST(TurningRetarders, AreRefusedWithWhatIsMissing) {
  const Goniometer goniometer(turning_goniometer(), 1);
  std::vector<Reference> references = air(goniometer, 1, 1);
  const std::vector<Reference> none =
      only(goniometer.references(wavelength, 1, 1), [](const Reference& r) { return r.kind != ReferenceKind::empty; });
  CalibrationOptions film = turning_options();
  film.film = GoniometerOptions{}.film;
  EXPECT_TRUE(says(refusal(none, film), {"no empty reference"}));
  CalibrationOptions few = turning_options();
  few.retarders->dials.resize(8);
  EXPECT_EQ(refusal(references, few), "reference 1: 61 readings, expected 8");
  references[0].readings.resize(8);
  EXPECT_TRUE(says(refusal(references, few), {"fewer readings of the empty beam than unknowns"}));
  CalibrationOptions still = turning_options();
  for (DialAngles& dial : still.retarders->dials) dial.analyzer = 0;
  references = air(goniometer, 1, 1);
  references[0].readings = readings(polarimeter(RotatingRetarders{}, still.retarders->dials), identity());
  EXPECT_TRUE(says(refusal(references, still), {"the references leave the", "open", "add frames or references"}));
  references[0].readings.assign(61, 0);
  EXPECT_TRUE(says(refusal(references, turning_options()), {"reference 1: the readings of the empty beam are not"}));
}

// Retardance errors of 3 degrees, offsets of 2, diattenuations of 1 %, 0.1 % noise: of 200 instruments the numbers lie in
// their 95 % intervals as often as they should, each with the scatter of 200 draws, 1.5 %, and all of them within 2 %;
// matrices are right to 3e-4 but for their scale.
TEST(TurningRetarders, HaveUncertaintiesThatHold) {
  constexpr int instruments = 200;
  std::array<int, retarder_parameters> inside{};
  double squares = 0;
  for (unsigned long seed = 1; seed <= instruments; ++seed) {
    const Goniometer goniometer(turning_goniometer(), seed);
    const Calibration c = calibrate(air(goniometer, 2, seed), turning_options());
    const auto found = parameters(c.retarders->values), truth = parameters(*goniometer.retarders());
    for (std::size_t k = 0; k < retarder_parameters; ++k) {
      const double u = std::sqrt(c.retarders->covariance[k * (retarder_parameters + 1)]);
      inside[k] += std::abs(found[k] - truth[k]) <= 1.96 * u;
    }
    squares += std::pow(error(c.polarimeter, goniometer.polarimeter()), 2) / instruments;
  }
  double all = 0;
  for (const std::size_t k : {0U, 1U, 3U, 4U, 5U, 6U, 7U, 8U}) {  // the scale is that of two gains
    const double share = inside[k] / double(instruments);
    RecordProperty("inside_" + std::to_string(k), std::to_string(share));
    EXPECT_NEAR(share, 0.95, 3 * std::sqrt(0.95 * 0.05 / instruments)) << parameter_name(k);
    all += share / 8;
  }
  RecordProperty("inside", std::to_string(all));
  RecordProperty("rms", std::to_string(std::sqrt(squares)));
  std::cout << "inside " << all << ", rms " << std::sqrt(squares) << '\n';
  EXPECT_NEAR(all, 0.95, 0.02);
  EXPECT_LE(std::sqrt(squares), 2e-4);
}

}  // namespace
}  // namespace mmbrdf
