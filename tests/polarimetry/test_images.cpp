// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarimetry/images.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "given/calibrations.hpp"
#include "given/cases.hpp"
#include "mmbrdf/polarimetry/reduction.hpp"

namespace mmbrdf {
namespace {

/// Instruments near to the best one, one behind the other.
struct Camera {
  std::vector<Polarimeter> pixels;
  std::vector<double> generators, analyzers;
  std::vector<float> readings;

  Camera(Polarimeter like, std::size_t count) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    for (std::size_t i = 0; i < count; ++i) {
      for (auto* arm : {&like.generator, &like.analyzer})
        for (Stokes& state : *arm)
          for (double& component : state) component += 0.003 * normal(random);
      pixels.push_back(like);
      for (const Stokes& s : like.generator) generators.insert(generators.end(), s.begin(), s.end());
      for (const Stokes& s : like.analyzer) analyzers.insert(analyzers.end(), s.begin(), s.end());
      Mueller m = diagonal(1, 0.5, 0.4, 0.3);
      for (std::size_t e = 1; e < 16; ++e) m.elements[e] += 0.05 * normal(random);
      for (const double reading : mmbrdf::readings(like, m)) readings.push_back(static_cast<float>(reading));
    }
  }
};

void expect_as_alone(const Camera& camera, double tolerance) {
  const std::size_t count = camera.pixels.size(), n = camera.pixels[0].readings();
  const PixelInverses inverses = pixel_inverses(camera.generators, camera.analyzers, camera.pixels[0]);
  ASSERT_EQ(inverses.pixels(), count);
  std::vector<float> elements(16 * count);
  muellers(inverses, camera.readings, elements);
  for (std::size_t i = 0; i < count; ++i) {
    const std::vector<double> own(camera.readings.begin() + static_cast<std::ptrdiff_t>(n * i),
                                  camera.readings.begin() + static_cast<std::ptrdiff_t>(n * (i + 1)));
    const Mueller alone = Reduction(camera.pixels[i]).mueller(own);
    for (std::size_t e = 0; e < 16; ++e) EXPECT_NEAR(elements[16 * i + e], alone.elements[e], tolerance);
  }
}

// Inverses of single precision, of condition 3 and 4: some units of 6e-8, sixteen and sixty-one of them.
TEST(Images, ReduceEachPixelAsItsOwnInstrumentDoes) {
  const std::vector<double> angles{radians(-51.69), radians(-15.12), radians(15.12), radians(51.69)};
  expect_as_alone(Camera(ideal_polarimeter(radians(131.81), angles), 50), 2e-6);
  const std::vector<double> six{radians(-60), radians(-40), radians(-15), radians(10), radians(35), radians(70)};
  expect_as_alone(Camera(ideal_polarimeter(radians(120), six), 50), 2e-6);
  RotatingRetarders retarders;
  retarders.generator.retardance = retarders.analyzer.retardance = radians(127);
  expect_as_alone(Camera(polarimeter(retarders, dial_angles(5, radians(6), 61)), 20), 2e-6);
}

TEST(Images, DoNotDependOnThreadsOrNeighbours) {
  const std::vector<double> angles{radians(-51.69), radians(-15.12), radians(15.12), radians(51.69)};
  const Camera camera(ideal_polarimeter(radians(131.81), angles), 10000);
  const PixelInverses inverses = pixel_inverses(camera.generators, camera.analyzers, camera.pixels[0]);
  std::vector<float> one(16 * 10000), many(16 * 10000);
  muellers(inverses, camera.readings, one, 1);
  muellers(inverses, camera.readings, many, 3);
  EXPECT_EQ(one, many);
  const PixelInverses few = pixel_inverses(std::span(camera.generators).subspan(16 * 7, 16 * 3),
                                           std::span(camera.analyzers).subspan(16 * 7, 16 * 3), camera.pixels[0]);
  std::vector<float> three(48);
  muellers(few, std::span(camera.readings).subspan(16 * 7, 48), three);
  EXPECT_TRUE(std::equal(three.begin(), three.end(), one.begin() + 16 * 7));
}

TEST(Images, HaveNoNumbersWhereThereAreNone) {
  const std::vector<double> angles{radians(-51.69), radians(-15.12), radians(15.12), radians(51.69)};
  Camera camera(ideal_polarimeter(radians(131.81), angles), 3);
  for (std::size_t k = 0; k < 4; ++k) camera.generators[16 + 4 * k + 3] = 0;  // of the second: no circular light
  camera.readings[2 * 16 + 5] = std::nanf("");
  std::vector<float> elements(48);
  muellers(pixel_inverses(camera.generators, camera.analyzers, camera.pixels[0]), camera.readings, elements);
  for (std::size_t i = 0; i < 48; ++i) EXPECT_EQ(std::isnan(elements[i]), i >= 16);
}

// Frames of retarders that do not turn far enough leave elements open, and so does the one pixel that lost its circular light.
TEST(Images, OfFramesHaveNoNumbersInPixelsThatTheyLeaveOpen) {
  RotatingRetarders retarders;
  retarders.generator.retardance = retarders.analyzer.retardance = radians(127);
  Camera camera(polarimeter(retarders, dial_angles(5, radians(6), 61)), 2);
  for (std::size_t k = 0; k < 61; ++k) camera.generators[4 * 61 + 4 * k + 3] = 0;
  std::vector<float> elements(32);
  muellers(pixel_inverses(camera.generators, camera.analyzers, camera.pixels[0]), camera.readings, elements);
  for (std::size_t i = 0; i < 32; ++i) EXPECT_EQ(std::isnan(elements[i]), i >= 16) << i;
}

TEST(Images, RefuseSizesThatDoNotFit) {
  const Polarimeter like = ideal_polarimeter(radians(131.81), std::vector{0.1, 0.5, 1.0, 2.0});
  EXPECT_THROW(pixel_inverses(std::vector<double>(31), std::vector<double>(32), like), std::invalid_argument);
  EXPECT_THROW(pixel_inverses(std::vector<double>(32), std::vector<double>(31), like), std::invalid_argument);
  EXPECT_THROW(pixel_inverses(std::vector<double>(32), std::vector<double>(16), like), std::invalid_argument);
  for (const auto arm : {&Polarimeter::generator, &Polarimeter::analyzer}) {
    Polarimeter none = like;
    (none.*arm).clear();
    EXPECT_THROW(pixel_inverses({}, {}, none), std::invalid_argument);
  }
  const PixelInverses inverses = pixel_inverses(std::vector<double>(32), std::vector<double>(32), like);
  std::vector<float> elements(32);
  EXPECT_THROW(muellers(inverses, std::vector<float>(31), elements), std::invalid_argument);
  const std::vector<float> readings(32);
  EXPECT_NO_THROW(muellers(inverses, readings, elements));
  EXPECT_THROW(muellers(inverses, readings, elements, 1, 1), std::invalid_argument);  // one pixel from the second on
  EXPECT_THROW(muellers(inverses, readings, elements, 1, 3), std::invalid_argument);
  elements.resize(33);
  EXPECT_THROW(muellers(inverses, readings, elements), std::invalid_argument);
}

TEST(Images, RefuseMoreStatesThanThereCanBeInEitherArm) {
  const Polarimeter like = ideal_polarimeter(radians(131.81), std::vector{0.1, 0.5, 1.0, 2.0});
  for (const auto arm : {&Polarimeter::generator, &Polarimeter::analyzer}) {
    Polarimeter many = like;
    (many.*arm).resize(most_states);
    EXPECT_EQ(pixel_inverses({}, {}, many).pixels(), 0u);
    (many.*arm).resize(most_states + 1);
    EXPECT_THROW(pixel_inverses({}, {}, many), std::invalid_argument);
  }
}

TEST(Images, AreCalibratedFromAStartWithTheSameReferencesAlone) {
  const Goniometer goniometer(quiet(), 1);
  std::vector<Reference> references = goniometer.references(wavelength, 6, 1);
  const Calibration start = calibrate(references, with_film());
  const auto refused = [&] { return message_of([&] { calibrate_pixels(start, references, {}, with_film()); }); };
  EXPECT_EQ(refused(), "nothing was thrown");
  const std::size_t each = 16 * references.size();
  EXPECT_EQ(message_of([&] { calibrate_pixels(start, references, std::vector<float>(each + 1), with_film()); }),
            std::to_string(each + 1) + " readings are not those of whole pixels of " + std::to_string(each));
  for (const std::size_t i : {std::size_t{7}, references.size() - 1}) {  // a polarizer, and a wafer
    const Reference given = references[i];
    references[i].angle += radians(1);
    EXPECT_EQ(refused(), "reference " + std::to_string(i + 1) + " is not that of the start");
    references[i] = given;
    references[i].kind = ReferenceKind::retarder;
    EXPECT_EQ(refused(), "reference " + std::to_string(i + 1) + " is not that of the start");
    references[i] = given;
  }
}

// With shot noise alone the start is already the best without an extinction of a pixel that it was made of: nothing but the
// extinction is left to be moved. The readings are of single precision, 6e-8: the extinction is good to some of these.
TEST(Images, FindTheExtinctionOfEachPixelThoughTheStartHasNone) {
  CalibrationOptions options;
  options.wavelength = wavelength;
  options.noise = {.dark = 0, .shot = 1e-3, .relative = 0};
  options.retarders.emplace().dials = dial_angles(5, radians(6), 61);
  RotatingRetarders instrument;
  instrument.generator.retardance = instrument.analyzer.retardance = radians(86);
  const std::vector<double> extinctions{1e-3, 0, 1e-4, 1e-2};
  std::vector<float> pixels;
  for (const double extinction : extinctions) {
    instrument.extinction = extinction;
    for (const double reading : readings(polarimeter(instrument, options.retarders->dials), identity()))
      pixels.push_back(static_cast<float>(reading));
  }
  const std::vector<Reference> first{{ReferenceKind::empty, 0, {pixels.begin(), pixels.begin() + 61}}};
  CalibrationOptions without = options;
  without.retarders->fit_extinction = false;
  const PixelCalibrations found = calibrate_pixels(calibrate(first, without), first, pixels, options);
  for (std::size_t i = 0; i < extinctions.size(); ++i) {
    EXPECT_EQ(found.failures[i], PixelFailure::none) << i;
    EXPECT_NEAR(found.retarders[retarder_parameters * i + 8], extinctions[i], 1e-6) << i;
  }
}

}  // namespace
}  // namespace mmbrdf
