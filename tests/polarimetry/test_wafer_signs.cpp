// SPDX-License-Identifier: BSD-3-Clause
// Which of the eight instruments a calibration finds: from what is stated with the wafers, and from their film.
#include <gtest/gtest.h>

#include <utility>

#include "given/calibrations.hpp"

using namespace mmbrdf;

// Signs of S2, S3 and S4: which wafer amplitude is that of s, the sense of the dial, the sign of delta.
TEST(Calibration, HasEightExactSolutionsWhichThreeFactsTellApart) {
  const Goniometer goniometer(quiet(), 5);
  const std::vector<Reference> stated = with_stated_signs(goniometer.references(wavelength, 18, 6));
  CalibrationOptions options = without_film();
  for (const int exchange : {1, -1})
    for (const int opposite : {1, -1})
      for (const int sense : {1, -1}) {
        std::vector<Reference> references = stated;
        for (Reference& r : references) {
          r.s_exceeds_p *= exchange;
          r.delta_sign *= opposite;
        }
        options.dial_sense = sense;
        const Calibration found = calibrate(references, options);
        const Polarimeter expected =
            with_signs(scaled(goniometer.polarimeter()), exchange, exchange * sense, exchange * sense * opposite);
        EXPECT_LT(largest_difference(found.polarimeter, expected), 1e-12) << exchange << opposite << sense;
        EXPECT_LT(found.singular_ratio, 1e-12);
        EXPECT_LT(found.figure_of_merit.total, 1e-12);
      }
}

// One angle of incidence is explained by the film at several thicknesses, and with other signs; two seldom are, three
// hardly ever. An index that is 0.004 off makes another order of interference the best one.
TEST(Calibration, OfOneWaferOrFewHasTheRightSignsOrIsRefused) {
  GoniometerOptions made = quiet();
  made.gain_change = 0.02;
  made.noise.relative = 1e-3;
  const Goniometer goniometer(made, 3);
  const auto all = goniometer.references(wavelength, 18, 3);
  const Polarimeter truth = scaled(goniometer.polarimeter());
  int calibrated = 0;
  const auto right_or_refused = [&](std::initializer_list<int> wafers, const Film& film, bool refine) {
    CalibrationOptions options = with_film(refine);
    options.film = film;
    const auto few = with_wafers(all, wafers);
    try {
      const Polarimeter found = calibrate(few, options).polarimeter;
      ++calibrated;
      EXPECT_LT(largest_difference(found, truth), 0.05) << *wafers.begin() << ' ' << film.film_index;
    } catch (const std::invalid_argument& e) {
      const std::string why = e.what();
      EXPECT_TRUE(why.starts_with("the film leaves the signs of the wafers open: at ") ||
                  why.starts_with("the condition number of the "))
          << why;
    }
  };
  for (int k = 0; k < 18; ++k) {
    for (const double index : {1.4607, 1.465}) right_or_refused({k}, {index, 1, {4.15, 0.044}}, false);
    right_or_refused({k}, {1.465, 1.05, {4.15, 0.044}}, true);
  }
  EXPECT_EQ(calibrated, 0);  // within 20 % of its thickness one angle never tells
  int pairs = 0, triples = 0;
  const double thicknesses[] = {0.9, 1, 1.1};
  for (int k = 0; k < 18; ++k)
    for (int l = 0; l < k; ++l) {
      const Film film{1.465, thicknesses[pairs++ % 3], {4.15, 0.044}};
      right_or_refused({l, k}, film, false);
    }
  const int of_pairs = std::exchange(calibrated, 0);
  for (int k = 0; k < 18; ++k)
    for (int l = 0; l < k; ++l)
      for (int m = (k + 5 * l) % 8; m < l; m += 8) {
        const Film film{1.465, thicknesses[triples++ % 3], {4.15, 0.044}};
        right_or_refused({m, l, k}, film, false);
      }
  RecordProperty("pairs", std::to_string(of_pairs) + " of " + std::to_string(pairs));
  RecordProperty("triples", std::to_string(calibrated) + " of " + std::to_string(triples));
  EXPECT_GT(of_pairs, 0.7 * pairs);
  EXPECT_GT(calibrated, 0.9 * triples);
}

// The same wafers with their signs stated: those that tie S4 to the rest at all.
TEST(Calibration, OfOneWaferWithItsSignsStatedIsRight) {
  GoniometerOptions made = quiet();
  made.noise.relative = 1e-3;
  const Goniometer goniometer(made, 3);
  const auto all = with_stated_signs(goniometer.references(wavelength, 18, 3));
  for (const int k : {0, 6, 12, 17})
    for (const CalibrationOptions& options : {with_film(false), without_film(false)}) {
      const Calibration found = calibrate(with_wafers(all, {k}), options);
      EXPECT_LT(largest_difference(found.polarimeter, scaled(goniometer.polarimeter())), 0.02) << k;
    }
}

// It is the film that tells which of the eight instruments it is: a wrong one must not pass.
TEST(Calibration, RefusesAFilmThatIsNotThatOfTheWafers) {
  const Goniometer goniometer(quiet(), 1);
  const auto references = goniometer.references(wavelength, 18, 2);
  for (const Film& wrong :
       {Film{1.4607, 0.5, {4.15, 0.044}}, Film{1.4607, 1.4, {4.15, 0.044}}, Film{1.5, 1, {1.5, 0}}}) {
    CalibrationOptions options = with_film();
    options.film = wrong;
    EXPECT_TRUE(refusal(references, options).starts_with("the film is not that of the wafers: "));
  }
}

// 0.7 µm and 20 % reach another order of interference, at 0.7745 µm, 5 degrees off: its signs are right by chance.
TEST(Calibration, RefusesAThicknessThatIsOutOfRange) {
  const Goniometer goniometer(quiet(), 1);
  const auto references = goniometer.references(wavelength, 18, 2);
  const auto refused = [&](double thickness) {
    CalibrationOptions options = with_film(false);
    options.film->thickness = thickness;
    return refusal(references, options);
  };
  EXPECT_EQ(refused(0.7),
            "the film is not that of the wafers: at 0.7745 um it is 5.06 degrees off psi and delta, rms, and nowhere "
            "within 20 % of 0.7 um less");
  EXPECT_EQ(refused(1.2495),
            "the thickness of the film comes out at 1 um, an end of the range of 20 % around the given 1.2495 um: give "
            "one that is nearer");
  EXPECT_EQ(refused(0.85), "nothing was thrown");
}

TEST(Calibration, SaysHowFarTheFilmIsOff) {
  const Goniometer goniometer(quiet(), 1);
  const auto references = goniometer.references(wavelength, 18, 2);
  CalibrationOptions options = with_film(false);
  EXPECT_LT(calibrate(references, options).film_misfit, 1e-8);
  options.film->film_index = 1.47;
  EXPECT_NEAR(calibrate(references, options).film_misfit, 0.011, 0.001);  // of the prototype
}

// Whatever is stated, the readings fit eight instruments as well: a sign that disagrees with the others must not pass,
// nor may the larger number of wrong ones decide.
TEST(Calibration, RefusesStatedSignsThatContradictEachOther) {
  GoniometerOptions made = quiet();
  made.noise.relative = 1e-3;
  const auto right = with_stated_signs(Goniometer(made, 3).references(wavelength, 18, 3));
  EXPECT_EQ(refusal(right, without_film(false)), "nothing was thrown");
  for (int Reference::*const sign : {&Reference::s_exceeds_p, &Reference::delta_sign}) {
    auto all_the_same = right;
    for (Reference& r : all_the_same) r.*sign = r.kind == ReferenceKind::wafer ? 1 : 0;
    for (const bool refine : {false, true}) {
      const std::string message = refusal(all_the_same, without_film(refine));
      EXPECT_TRUE(message.ends_with(", but together with the other references its readings say -1") ||
                  message.ends_with(", but together with the other references its readings say 1"))
          << message;
    }
    auto one = right;
    one[40].*sign *= -1;
    const std::string message = refusal(one, without_film(false));
    EXPECT_TRUE(message.starts_with("reference 41: ")) << message;
  }
}

TEST(Calibration, RefusesStatedSignsThatContradictTheFilm) {
  GoniometerOptions made = quiet();
  made.noise.relative = 1e-3;
  const auto right = with_stated_signs(Goniometer(made, 3).references(wavelength, 18, 3));
  EXPECT_EQ(refusal(right, with_film(false)), "nothing was thrown");
  for (int Reference::*const sign : {&Reference::s_exceeds_p, &Reference::delta_sign}) {
    auto opposite = right;  // agrees with itself
    for (Reference& r : opposite) r.*sign *= -1;
    EXPECT_EQ(refusal(opposite, without_film(false)), "nothing was thrown");
    const std::string message = refusal(opposite, with_film(false));
    EXPECT_TRUE(message.ends_with(", which contradicts the film at 1 um")) << message;
    auto all_the_same = right;
    for (Reference& r : all_the_same) r.*sign = r.kind == ReferenceKind::wafer ? -1 : 0;
    EXPECT_TRUE(refusal(all_the_same, with_film(false)).ends_with(", which contradicts the film at 1 um"));
  }
}

// At 45 degrees of psi nothing tells s from p, and a sign that is stated there says nothing.
TEST(Calibration, NeedsAWaferThatTellsItsSigns) {
  const Goniometer goniometer(quiet(), 3);
  auto references = with_stated_signs(with_wafers(goniometer.references(wavelength, 18, 3), {0}));
  references.back().readings =
      readings(goniometer.polarimeter(), mueller({0.3, std::numbers::pi / 4, std::numbers::pi / 2}));
  EXPECT_EQ(refusal(references, without_film()),
            "the wafers leave the instrument open: s_exceeds_p is lost in the noise at all their angles; add wafer "
            "angles");
}
