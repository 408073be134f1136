// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarimetry/calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <string>

#include "given/calibrations.hpp"
#include "given/files.hpp"

using namespace mmbrdf;

// 1e-12: rounding of 1e-16 times condition numbers of the order of 1000.
TEST(Calibration, OfReadingsWithoutNoiseIsExact) {
  for (const double extinction : {0., 1e-5})
    for (const bool refine : {false, true}) {
      GoniometerOptions made = quiet();
      made.extinction = extinction;
      const Goniometer goniometer(made, 3);
      CalibrationOptions options = with_film(refine);
      options.extinction = extinction;
      options.film->thickness = 0.9;  // is found
      const Calibration found = calibrate(goniometer.references(wavelength, 18, 4), options);
      EXPECT_LT(error(found.polarimeter, goniometer.polarimeter()), 1e-12);
      EXPECT_LT(largest_difference(found.polarimeter, scaled(goniometer.polarimeter())), 1e-12);
      EXPECT_LT(found.singular_ratio, 1e-12);
      EXPECT_LT(found.figure_of_merit.total, 1e-12);
      EXPECT_NEAR(found.polarizer_offset, made.polarizer_offset, 1e-12);
      EXPECT_NEAR(found.extinction, extinction, 1e-12);
      EXPECT_NEAR(found.film_thickness, 1, 1e-8);
      EXPECT_GT(found.identifiability, 0.2);
      EXPECT_EQ(found.degrees_of_freedom, 742);
    }
}

// Compain's limits: an extinction of 1e-5 that is not known makes elements wrong by some 1e-5; the refinement finds it.
TEST(Calibration, RefinementFindsTheExtinctionOfThePolarizer) {
  GoniometerOptions made = quiet();
  made.extinction = 1e-5;
  const Goniometer goniometer(made, 3);
  const std::vector<Reference> references = goniometer.references(wavelength, 18, 4);
  const Calibration linear = calibrate(references, with_film(false)), refined = calibrate(references, with_film());
  const double ignored = error(linear.polarimeter, goniometer.polarimeter());
  EXPECT_TRUE(ignored > 5e-6 && ignored < 1e-4) << ignored;
  EXPECT_NEAR(linear.figure_of_merit.total, 1.3e-3, 0.1e-3);
  EXPECT_LT(error(refined.polarimeter, goniometer.polarimeter()), 1e-12);
  EXPECT_NEAR(refined.extinction, 1e-5, 1e-12);
  EXPECT_LT(refined.figure_of_merit.total, 1e-12);
}

TEST(Calibration, RefinementFindsThePhaseOfThePolarizer) {
  const Goniometer goniometer(quiet(), 3);
  std::vector<Reference> references = goniometer.references(wavelength, 18, 4);
  for (Reference& r : references)
    if (r.kind == ReferenceKind::polarizer)
      r.readings = readings(goniometer.polarimeter(), polarizer(radians(23) + r.angle, 1e-4, 0.7));
  CalibrationOptions options = with_film();
  options.fit_polarizer_phase = true;
  const Calibration found = calibrate(references, options);
  EXPECT_LT(error(found.polarimeter, goniometer.polarimeter()), 1e-12);
  EXPECT_NEAR(found.polarizer_phase, 0.7, 1e-9);
  EXPECT_EQ(found.degrees_of_freedom, 741);
}

// The limits are those of the specification, for another instrument with imperfections of the same size.
TEST(Calibration, OfNoisyReadingsIsAsGoodAsTheNumberOfReferencesPromisesAndScattersAsItsCovarianceSays) {
  constexpr int seeds = 40;
  double linear_error = 0, refined_error = 0, linear_merit = 0, refined_merit = 0, reduced = 0;
  double observed = 0, predicted = 0;
  GoniometerOptions made = quiet();
  made.gain_change = 0.02;
  made.noise.relative = 1e-3;
  for (unsigned long seed = 1; seed <= seeds; ++seed) {
    const Goniometer goniometer(made, seed);
    const std::vector<Reference> references = goniometer.references(wavelength, 18, seed);
    const Calibration linear = calibrate(references, with_film(false)), refined = calibrate(references, with_film());
    linear_error += error(linear.polarimeter, goniometer.polarimeter()) / seeds;
    refined_error += error(refined.polarimeter, goniometer.polarimeter()) / seeds;
    linear_merit += linear.figure_of_merit.total / seeds;
    refined_merit += refined.figure_of_merit.total / seeds;
    reduced += refined.chi_squared / static_cast<double>(refined.degrees_of_freedom) / seeds;
    const Reduction reduction(refined.polarimeter, refined.covariance);
    for (const Mueller& m : test_matrices()) {
      const Mueller found = reduction.mueller(readings(goniometer.polarimeter(), m));
      const Mueller difference = normalized(found) - m;
      const Mueller u = standard_uncertainty(normalized(reduction.from_instrument(found), found));
      for (std::size_t e = 1; e < 16; ++e) {
        observed += difference.elements[e] * difference.elements[e];
        predicted += u.elements[e] * u.elements[e];
      }
    }
  }
  RecordProperty("linear_error", std::to_string(linear_error));
  RecordProperty("refined_error", std::to_string(refined_error));
  RecordProperty("figures_of_merit", std::to_string(linear_merit) + ", " + std::to_string(refined_merit));
  RecordProperty("observed_over_predicted", std::to_string(std::sqrt(observed / predicted)));
  EXPECT_LT(linear_error, 2e-4);
  EXPECT_LT(refined_error, 1e-4);
  EXPECT_NEAR(linear_merit, 7.5e-4, 0.75e-4);
  EXPECT_NEAR(refined_merit, 7.5e-4, 0.75e-4);
  EXPECT_NEAR(reduced, 1, 4 * std::sqrt(2. / 742 / seeds));
  EXPECT_NEAR(std::sqrt(observed / predicted), 1, 0.1);
}

TEST(Calibration, TakesMoreThanFourStates) {
  GoniometerOptions made = quiet();
  made.azimuths = optimal_angles(made.retardance, 6);
  const Goniometer goniometer(made, 7);
  CalibrationOptions options = with_film();
  options.generator_states = options.analyzer_states = 6;
  const Calibration found = calibrate(goniometer.references(wavelength, 10, 8), options);
  EXPECT_LT(error(found.polarimeter, goniometer.polarimeter()), 1e-12);
  EXPECT_LT(largest_difference(found.polarimeter, scaled(goniometer.polarimeter())), 1e-12);
}

// Transposed readings Wᵀ Mᵀ Aᵀ are those of an instrument with the arms exchanged: Mᵀ has the other sign of Δ, which is
// one of the eight again.
TEST(Calibration, ExplainsReadingsWithExchangedArmsByAnExchangedInstrument) {
  const Goniometer goniometer(quiet(), 5);
  std::vector<Reference> references = goniometer.references(wavelength, 18, 6);
  for (Reference& r : references)
    for (std::size_t q = 0; q < 4; ++q)
      for (std::size_t p = 0; p < q; ++p) std::swap(r.readings[4 * q + p], r.readings[4 * p + q]);
  const Calibration found = calibrate(references, with_film());
  const Polarimeter exchanged{goniometer.polarimeter().analyzer, goniometer.polarimeter().generator};
  EXPECT_LT(largest_difference(found.polarimeter, with_signs(scaled(exchanged), 1, 1, -1)), 1e-12);
  EXPECT_LT(found.figure_of_merit.total, 1e-12);
}

// A wafer whose plane of incidence is turned by 0.1 degrees turns the axes of both arms, and no reading shows it.
TEST(Calibration, TurnsWithTheWafer) {
  const double tilt = radians(0.1);
  const Goniometer goniometer(quiet(), 5);
  std::vector<Reference> references = goniometer.references(wavelength, 18, 6);
  for (Reference& r : references)
    if (r.kind == ReferenceKind::wafer) {
      const Mueller wafer = mueller(reflection(goniometer.options().film, wavelength, r.angle));
      r.readings = readings(goniometer.polarimeter(), rotated(wafer, tilt));
    }
  const Calibration found = calibrate(references, with_film());
  EXPECT_LT(found.figure_of_merit.total, 1e-12);
  const double wrong = error(found.polarimeter, goniometer.polarimeter());
  RecordProperty("error_of_a_tilt", std::to_string(wrong));
  EXPECT_TRUE(wrong > 5e-4 && wrong < 5e-3) << wrong;  // 2 tilt = 3.5e-3 times differences of elements
  const Reduction reduction(found.polarimeter);
  const Mueller m = test_matrices()[7];
  const Mueller difference =
      reduction.mueller(readings(goniometer.polarimeter(), m)) - rotator(tilt) * m * rotator(-tilt);
  for (const double d : difference.elements) EXPECT_NEAR(d, 0, 1e-12);
}

// Three azimuths of the polarizer and one wafer are enough, and poorer: s15/s1 says so.
TEST(Calibration, OfFewReferencesIsLessDetermined) {
  const Goniometer goniometer(quiet(), 9);
  const auto all = goniometer.references(wavelength, 18, 10);
  const auto few = only(with_stated_signs(with_wafers(all, {0})), [&](const Reference& r) {
    return r.kind != ReferenceKind::polarizer || r.angle < radians(5) || std::abs(r.angle - radians(65)) < radians(26);
  });
  const Calibration many = calibrate(all, with_film()), less = calibrate(few, without_film());
  EXPECT_LT(less.identifiability, many.identifiability / 2);
  EXPECT_LT(error(less.polarimeter, goniometer.polarimeter()), 1e-10);  // the smaller that ratio, the more rounding
}

// Near Δ = 180 degrees one wafer hardly ties S4 to the rest, and noise does the rest to the instrument.
TEST(Calibration, RefusesAnInstrumentThatTheReferencesHardlyDetermine) {
  GoniometerOptions made = quiet();
  made.noise.relative = 1e-3;
  const Goniometer goniometer(made, 9);
  const std::string message = refusal(with_wafers(goniometer.references(wavelength, 18, 10), {3}), with_film());
  EXPECT_TRUE(message.starts_with("the condition number of the ")) << message;
  EXPECT_TRUE(message.ends_with("or the references do not determine them")) << message;
}

// An error of the dial shows in the figure of merit.
TEST(Calibration, FigureOfMeritShowsErrorsOfTheReferences) {
  GoniometerOptions made = quiet();
  made.dial_error = radians(0.05);
  const Goniometer goniometer(made, 11);
  const Calibration found = calibrate(goniometer.references(wavelength, 18, 12), with_film(false));
  EXPECT_NEAR(error(found.polarimeter, goniometer.polarimeter()), 8.5e-5, 0.5 * 8.5e-5);
  EXPECT_NEAR(found.figure_of_merit.total, 5e-4, 2.5e-4);
  const FigureOfMerit& m = found.figure_of_merit;
  EXPECT_NEAR(3 * m.total * m.total, m.empty * m.empty + m.polarizer * m.polarizer + m.wafer * m.wafer, 1e-15);
  EXPECT_GT(m.polarizer, m.empty);
  EXPECT_NEAR(m.corrected / m.total, std::sqrt(54 * 16 / static_cast<double>(found.degrees_of_freedom)), 1e-12);
}

TEST(Calibration, SaysWhatIsMissing) {
  const Goniometer goniometer(quiet(), 1);
  const auto all = goniometer.references(wavelength, 18, 2);
  const auto without = [&](ReferenceKind kind) {
    return only(all, [=](const Reference& r) { return r.kind != kind; });
  };
  EXPECT_EQ(refusal(without(ReferenceKind::empty), with_film()),
            "no empty reference: the arms aligned, nothing between");
  EXPECT_EQ(refusal(without(ReferenceKind::polarizer), with_film()),
            "no reference with a polarizer: the others alone leave solutions mixed");
  EXPECT_EQ(refusal(without(ReferenceKind::wafer), with_film()),
            "no reference with a wafer or a retarder: polarizers alone leave the scale and sign of S4 open");
  EXPECT_EQ(refusal(only(all,
                         [](const Reference& r) {
                           return r.kind != ReferenceKind::polarizer || r.angle == 0 ||
                                  std::abs(r.angle - radians(90)) < 0.01;
                         }),
                    with_film()),
            "all dial angles of the polarizer are 0 or 90 degrees apart: that leaves its sense open");
  EXPECT_EQ(refusal(all, without_film()),
            "reference 37: a wafer without signs: give a film, or state whether s exceeds p and the sign of delta");
  auto wrong = all;
  wrong[2].readings.pop_back();
  EXPECT_EQ(refusal(wrong, with_film()), "reference 3: 15 readings, expected 16");
  wrong = all;
  wrong[2].readings[4] = std::nan("");
  EXPECT_EQ(refusal(wrong, with_film()), "reference 3: a reading is not finite");
  for (Reference& r : wrong) r.readings.assign(16, 1);
  EXPECT_EQ(refusal(wrong, with_film()),
            "the readings of the empty beam have fewer than four independent states: generator and analyzer need four "
            "each");
}

TEST(Calibration, RefusesOptionsAndAnglesThatAreNone) {
  const double infinite = std::numeric_limits<double>::infinity();
  const auto references = Goniometer(quiet(), 1).references(wavelength, 18, 2);
  const auto refused = [&](const std::function<void(CalibrationOptions&)>& spoil) {
    CalibrationOptions options = with_film();
    spoil(options);
    return refusal(references, options);
  };
  for (const double bad : {infinite, -infinite, std::nan("")})
    EXPECT_EQ(refused([&](CalibrationOptions& o) { o.polarizer_near = bad; }),
              "the polarizer's rough azimuth is not finite");
  for (const auto states : {&CalibrationOptions::generator_states, &CalibrationOptions::analyzer_states}) {
    const std::string arm = states == &CalibrationOptions::generator_states ? "generator" : "analyzer";
    EXPECT_EQ(refused([&](CalibrationOptions& o) { o.*states = 3; }), "3 states of the " + arm + ", four are needed");
    EXPECT_EQ(refused([&](CalibrationOptions& o) { o.*states = 101; }), "101 states of the " + arm + ", more than 100");
  }
  for (const int sense : {0, 2, -2})
    EXPECT_EQ(refused([&](CalibrationOptions& o) { o.dial_sense = sense; }),
              "a dial sense of " + std::to_string(sense) + ", not 1 or -1");
  EXPECT_EQ(refused([](CalibrationOptions& o) { o.extinction = -0.1; }), "extinction -0.1 is not in [0, 1)");
  EXPECT_EQ(refused([](CalibrationOptions& o) { o.extinction = 1; }), "extinction 1 is not in [0, 1)");
  for (const ReadingNoise& noise : {ReadingNoise{0, 0, 0}, ReadingNoise{-1, 2, 2}, ReadingNoise{2, -1, 2},
                                    ReadingNoise{2, 2, -1}, ReadingNoise{infinite, 0, 0}})
    EXPECT_EQ(refused([&](CalibrationOptions& o) { o.noise = noise; }),
              "the noise of the readings must be finite, and positive somewhere");
  const auto turned = [&](std::size_t number, double angle) {
    auto wrong = references;
    wrong[number - 1].angle = angle;
    return refusal(wrong, with_film());
  };
  EXPECT_EQ(turned(3, infinite), "reference 3: its angle is not finite");
  EXPECT_EQ(turned(37, std::nan("")), "reference 37: its angle is not finite");
  EXPECT_EQ(turned(37, radians(90)), "reference 37: an angle of incidence of 90 degrees");
  EXPECT_EQ(turned(37, radians(-1)), "reference 37: an angle of incidence of -1 degrees");
}

TEST(Calibration, OfAPolarizerInsteadOfWafersLeavesMoreThanOneInstrument) {
  const Goniometer goniometer(quiet(), 1);
  auto references = goniometer.references(wavelength, 18, 2);
  for (Reference& r : references)
    if (r.kind == ReferenceKind::wafer) {
      r.readings = readings(goniometer.polarimeter(), polarizer(0));
      r.s_exceeds_p = r.delta_sign = 1;
    }
  const std::string message = refusal(references, without_film());
  EXPECT_TRUE(message.starts_with("the references leave more than one instrument: nothing ties ")) << message;
}

// The experimental standard deviation of a mean of n gains: s / √n, s² = Σ (g − 1)² / (n − 1).
namespace {

/// In place of the wafers retarders, their fast axes at known azimuths, the same one or of several retardances.
std::vector<Reference> with_retarders(const Goniometer& goniometer, const std::vector<double>& retardances_deg,
                                      unsigned long seed) {
  std::vector<Reference> references = only(goniometer.references(wavelength, 6, seed),
                                           [](const Reference& r) { return r.kind != ReferenceKind::wafer; });
  for (const double retardance : retardances_deg)
    for (const double azimuth : {0., 35., 70., 110.}) {
      const Mueller m = rotated(mueller({0.9, radians(44.8), radians(retardance)}), radians(azimuth));
      references.push_back({ReferenceKind::retarder, radians(azimuth), goniometer.readings(m, seed + references.size()),
                            0, retardance > 180 ? -1 : 0});
    }
  return references;
}

CalibrationOptions with_polarizer_near(double azimuth_deg) {
  CalibrationOptions options = without_film();
  options.polarizer_near = radians(azimuth_deg);
  return options;
}

}  // namespace

// A retarder of known axes ties S4 to S2 and S3, as a wafer does, and fixes the azimuth; of 23 and 113 degrees for the
// polarizer it leaves the choice, since it turns orthogonal states alike.
TEST(Calibration, TakesRetardersOfKnownAxesInPlaceOfWafers) {
  for (const std::vector<double>& retardances : {std::vector<double>{70}, {40, 265}}) {
    const Goniometer goniometer(quiet(), 2);
    const std::vector<Reference> references = with_retarders(goniometer, retardances, 3);
    const Calibration c = calibrate(references, with_polarizer_near(40));
    EXPECT_LE(error(c.polarimeter, goniometer.polarimeter()), 1e-10);
    EXPECT_NEAR(c.polarizer_offset, radians(23), 1e-10);
    EXPECT_NEAR(std::remainder(c.references.back().element.delta - radians(retardances.back()), radians(360)), 0,
                1e-10);
    EXPECT_NEAR(c.references.back().element.psi, radians(44.8), 1e-10);
    EXPECT_GT(c.figure_of_merit.retarder, 0);
    EXPECT_EQ(c.figure_of_merit.wafer, 0);
    // The opposite states explain the same readings.
    const Calibration other = calibrate(references, with_polarizer_near(120));
    EXPECT_LE(largest_difference(other.polarimeter, with_signs(scaled(goniometer.polarimeter()), -1, -1, -1)), 1e-9);
    EXPECT_NEAR(other.polarizer_offset, radians(113), 1e-10);
  }
}

TEST(Calibration, WithRetardersAndNoiseIsAsGoodAsItsCovarianceSays) {
  GoniometerOptions made = quiet();
  made.noise.relative = 1e-3;
  double sum = 0, predicted = 0;
  for (unsigned long seed = 1; seed <= 20; ++seed) {
    const Goniometer goniometer(made, seed);
    const Calibration c = calibrate(with_retarders(goniometer, {70, 110}, seed), with_polarizer_near(20));
    const Reduction reduction(c.polarimeter, c.covariance);
    for (const Mueller& m : test_matrices()) {
      const Mueller off = normalized(reduction.mueller(readings(goniometer.polarimeter(), m))) - m;
      const MuellerCovariance v = normalized(reduction.from_instrument(m), m);
      for (std::size_t e = 1; e < 16; ++e) {
        sum += off.elements[e] * off.elements[e];
        predicted += v(e, e);
      }
    }
  }
  RecordProperty("observed_over_predicted", std::to_string(std::sqrt(sum / predicted)));
  EXPECT_NEAR(std::sqrt(sum / predicted), 1, 0.15);  // 20 instruments, each of a few independent errors
}

TEST(Calibration, RefusesRetardersWhoseSignsContradictEachOther) {
  std::vector<Reference> references = with_retarders(Goniometer(quiet(), 2), {80}, 3);
  references.back().delta_sign = -1;
  EXPECT_TRUE(says(refusal(references, with_polarizer_near(20)), {"delta_sign is stated as", "its readings say"}));
}

TEST(Calibration, WithoutAWaferAsksRoughlyHowThePolarizerStands) {
  const std::vector<Reference> references = with_retarders(Goniometer(quiet(), 2), {70}, 3);
  EXPECT_TRUE(says(refusal(references, without_film()),
                   {"retarders leave open whether the polarizer's azimuth at dial 0 is", "degrees or 90 more"}));
  EXPECT_TRUE(says(refusal(references, with_polarizer_near(70)), {"the given 70 does not tell which"}));
}

TEST(Calibration, HasTheStandardDeviationOfTheMeanGainAsTheUncertaintyOfItsScale) {
  const std::vector<Reference> all = Goniometer(quiet(), 3).references(wavelength, 18, 4);
  for (const int kept : {2, 3, 5}) {
    int empty = 0;
    std::vector<double> gains;
    std::vector<Reference> references =
        only(all, [&](const Reference& r) { return r.kind != ReferenceKind::empty || empty++ < kept; });
    for (Reference& r : references) {
      if (r.kind != ReferenceKind::empty) continue;
      gains.push_back(1 + 0.02 * std::sin(5.0 * static_cast<double>(gains.size() + 1)));
      for (double& reading : r.readings) reading *= gains.back();
    }
    const auto n = static_cast<double>(gains.size());
    const double mean = std::accumulate(gains.begin(), gains.end(), 0.0) / n;
    double squares = 0;
    for (const double gain : gains) squares += (gain / mean - 1) * (gain / mean - 1);
    ASSERT_GT(n, 1);
    EXPECT_NEAR(calibrate(references, with_film()).scale_uncertainty, std::sqrt(squares / (n - 1) / n), 1e-5) << kept;
  }
}

// With gains that change by 2 % from one reference to the next, the mean of 18 is known to 0.5 %, and says so.
TEST(Calibration, KnowsHowUncertainItsScaleIsFromTheScatterOfTheEmptyReferences) {
  GoniometerOptions made = quiet();
  made.gain_change = 0.02;
  made.noise.relative = 1e-3;
  double sum = 0, observed = 0, predicted = 0;
  constexpr int seeds = 25;
  for (unsigned long seed = 1; seed <= seeds; ++seed) {
    const Goniometer goniometer(made, seed);
    const Calibration found = calibrate(goniometer.references(wavelength, 18, seed), with_film());
    const Reduction reduction(found.polarimeter, found.covariance);
    const Mueller m = reduction.mueller(readings(goniometer.polarimeter(), identity()));
    observed += std::pow(m(0, 0) - 1, 2) / seeds;
    const double variance = reduction.from_instrument(m)(0, 0);
    EXPECT_NEAR(variance, std::pow(found.scale_uncertainty, 2), 1e-6);  // the rest is of noise of 1e-3
    predicted += variance / seeds;
    sum += found.scale_uncertainty / seeds;
  }
  EXPECT_NEAR(sum, 0.02 / std::sqrt(18.), 0.0005);                             // 1/√36 of it, over √25
  EXPECT_NEAR(std::sqrt(observed / predicted), 1, 3 / std::sqrt(2. * seeds));  // the scatter of such a ratio
}
