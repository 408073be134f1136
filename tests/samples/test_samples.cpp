// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/samples/samples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "given/cases.hpp"
#include "given/published.hpp"

using namespace mmbrdf;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

Sample sample_at(double wavelength, double f11 = 0.3) { return {wavelength, {{0.1, 0}, {0.2, 1}}, f11, identity()}; }

/// Angle between the directions to the source and to the detector, in degrees.
double degrees_from_retro(const Geometry& g) {
  const Vector3 a = unit_vector(g.incident), b = unit_vector(g.reflected);
  return degrees(2 * std::asin(std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) / 2));
}

}  // namespace

TEST(Side, IsOfTheReceiverBesideThePlaneOfIncidence) {
  const auto at = [](double theta_i, double phi_i, double theta_r, double phi_r) {
    return side({{radians(theta_i), radians(phi_i)}, {radians(theta_r), radians(phi_r)}});
  };
  EXPECT_EQ(at(30, 20, 50, 110), positive_side);
  EXPECT_EQ(at(30, 20, 50, 290), negative_side);
  EXPECT_EQ(at(30, 20, 50, 200.05), plane_of_incidence);
  EXPECT_EQ(at(30, 20, 50, 201), negative_side);
  EXPECT_EQ(at(0.001, 180, 50, 90), plane_of_incidence);  // at the normal every plane is that of incidence
  EXPECT_EQ(at(50, 90, 0, 0), plane_of_incidence);
}

TEST(Wavelengths, AreDistinctAndRise) {
  const std::vector<Sample> samples{sample_at(0.633), sample_at(0.351), sample_at(0.633), sample_at(0.532)};
  EXPECT_EQ(wavelengths(samples), (std::vector<double>{0.351, 0.532, 0.633}));
  EXPECT_TRUE(wavelengths({}).empty());
}

TEST(Wavelengths, ThatDifferByLessThanTheResolutionAreOne) {
  const double step = wavelength_resolution;
  const std::vector<Sample> samples{sample_at(0.532 + 0.5 * step), sample_at(0.532), sample_at(0.532 + 1.5 * step)};
  EXPECT_EQ(wavelengths(samples), (std::vector<double>{0.532, 0.532 + 1.5 * step}));
}

TEST(Wavelengths, ThatAreNoneAreRefusedWithTheNumberOfTheSample) {
  const auto refusal = [](double wavelength) {
    return message_of([&] { wavelengths(std::vector<Sample>{sample_at(0.5), sample_at(wavelength)}); });
  };
  EXPECT_EQ(refusal(0), "sample 2: wavelength = 0 nm, must be positive");
  EXPECT_EQ(refusal(nan_value), "sample 2: wavelength = nan nm, must be positive");
}

TEST(Samples, AtSomeWavelengthsKeepTheirOrder) {
  const std::vector<Sample> samples{sample_at(0.633, 1), sample_at(0.351, 2), sample_at(0.633, 3), sample_at(0.532, 4)};
  std::vector<double> kept;
  for (const Sample& sample : at_wavelengths(samples, std::vector<double>{0.351, 0.633})) kept.push_back(sample.f11);
  EXPECT_EQ(kept, (std::vector<double>{1, 2, 3}));
}

TEST(Samples, AtAllTheirWavelengthsAreAllSamples) {
  std::vector<Sample> samples;
  for (int i = 0; i < 40; ++i) samples.push_back(sample_at(0.5 + 0.3 * i * wavelength_resolution));
  EXPECT_EQ(at_wavelengths(samples, wavelengths(samples)).size(), samples.size());
}

TEST(Samples, AtAWavelengthThatIsNotThereAreRefusedWithThoseThereAre) {
  const std::vector<Sample> samples{sample_at(0.633), sample_at(0.351)};
  EXPECT_EQ(message_of([&] {
              at_wavelengths(samples, std::vector<double>{0.351, 0.532});
            }),
            "wavelength = 532 nm: no sample; there are samples at 351, 633 nm");
  EXPECT_EQ(message_of([] { at_wavelengths({}, std::vector<double>{0.532}); }),
            "wavelength = 532 nm: there are no samples");
}

TEST(Samples, ThatAreValidPass) {
  EXPECT_NO_THROW(require_valid(std::vector<Sample>{sample_at(0.532), sample_at(0.532, -0.1)}));
}

TEST(Samples, ThatAreInvalidAreRefusedWithTheirNumber) {
  const auto refusal = [](const std::function<void(Sample&)>& spoil) {
    std::vector<Sample> samples{sample_at(0.5), sample_at(0.5), sample_at(0.5)};
    spoil(samples[2]);
    return message_of([&] { require_valid(samples); });
  };
  EXPECT_EQ(refusal([](Sample& s) { s.wavelength = -0.5; }), "sample 3: wavelength = -500 nm, must be positive");
  EXPECT_EQ(refusal([](Sample& s) { s.geometry.reflected.theta = radians(91); }),
            "sample 3: theta_r = 91 degrees, must be in 0...90");
  EXPECT_EQ(refusal([](Sample& s) { s.f11 = infinite; }), "sample 3: f11 = inf, must be finite");
  EXPECT_EQ(refusal([](Sample& s) { s.normalized(1, 3) = -infinite; }), "sample 3: m24 = -inf, must be finite");
  EXPECT_EQ(refusal([](Sample& s) { s.uncertainty(0, 0) = nan_value; }),
            "sample 3: u_f11 = nan, must be finite and not negative");
  EXPECT_EQ(refusal([](Sample& s) { s.uncertainty(3, 3) = -0.1; }),
            "sample 3: u_m44 = -0.1, must be finite and not negative");
}

TEST(Samples, HaveAnUncertaintyIfThatOfAnyElementIsKnown) {
  Sample sample = sample_at(0.5);
  EXPECT_FALSE(has_uncertainty(sample));
  sample.uncertainty(2, 1) = 1e-3;
  EXPECT_TRUE(has_uncertainty(sample));
  EXPECT_TRUE(has_uncertainty(at_wavelengths(std::vector<Sample>{sample}, std::vector<double>{0.5}).front()));
}

TEST(Germer2017Grid, Has1824GeometriesAtSixIncidentAngles) {
  std::array<int, 6> counts{};
  for (const Geometry& g : germer2017_grid())
    ++counts[static_cast<std::size_t>(std::lround(degrees(g.incident.theta) / 15))];
  EXPECT_EQ(counts, (std::array<int, 6>{304, 303, 304, 304, 304, 305}));  // counted in the published file
}

TEST(Germer2017Grid, LiesOnSteps0Point1OfTheDirectionCosinesWithTheSourceAtAzimuth180) {
  for (const Geometry& g : germer2017_grid()) {
    const Vector3 v = unit_vector(g.reflected);
    EXPECT_EQ(g.incident.phi, pi);
    EXPECT_NEAR(10 * v[0], std::round(10 * v[0]), 1e-14);  // ten times a few roundings of numbers up to 1
    EXPECT_NEAR(10 * v[1], std::round(10 * v[1]), 1e-14);
    EXPECT_LE(degrees(g.reflected.theta), 81.87);  // i² + j² = 98
    EXPECT_GE(degrees_from_retro(g), 5);
  }
}

TEST(Germer2017Grid, IsThatOfThePublishedFileRowByRow) {
  const std::string file = published("PTFE.data.csv");
  if (file.empty()) GTEST_SKIP() << absent("PTFE.data.csv");
  const std::vector<std::vector<double>> rows = read_numbers(file);
  const std::vector<Geometry> grid = germer2017_grid();
  ASSERT_EQ(rows.size(), 4 * grid.size());  // four wavelengths
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Geometry& g = grid[i % grid.size()];
    const Direction incident = unfolded({radians(rows[i][1]), radians(rows[i][2])});
    const Vector3 v = unit_vector(g.reflected), w = unit_vector({radians(rows[i][3]), radians(rows[i][4])});
    EXPECT_NEAR(degrees(incident.theta), degrees(g.incident.theta), 0.0011);  // 0 is written as −0.001
    EXPECT_EQ(incident.phi, g.incident.phi);
    // Six digits of angles below 180°, and theta_r = 0 is written as 0.001°: 1.8e-5 in direction cosines.
    EXPECT_LE(std::hypot(v[0] - w[0], v[1] - w[1], v[2] - w[2]), 1.8e-5) << "row " << i + 1;
  }
}

TEST(RandomGeometries, AreTheSameForTheSameSeed) {
  EXPECT_EQ(random_geometries(10, 1), random_geometries(10, 1));
  EXPECT_NE(random_geometries(10, 1), random_geometries(10, 2));
  const std::vector<Geometry> more = random_geometries(20, 1), fewer = random_geometries(10, 1);
  EXPECT_TRUE(std::equal(fewer.begin(), fewer.end(), more.begin()));
}

TEST(RandomGeometries, AreTheSameOnEveryComputer) {
  // From mt19937_64 written out in Python. Its bits are standardized; what is left is the rounding of sin and asin.
  const Geometry g = random_geometries(1, 1).front();
  EXPECT_NEAR(degrees(g.incident.theta), 20.69689327463781, 1e-12);
  EXPECT_NEAR(degrees(g.incident.phi), -130.89346690816902, 1e-12);
  EXPECT_NEAR(degrees(g.reflected.theta), 40.453961409935694, 1e-12);
  EXPECT_NEAR(degrees(g.reflected.phi), -172.43127776997827, 1e-12);
}

TEST(RandomGeometries, FillTheDiscOfDirectionCosinesUniformly) {
  const int count = 20000;
  const double theta_max = radians(75), radius = std::sin(theta_max);
  std::array<int, 16> cells{};  // four rings of equal area times four quadrants, for both beams together
  for (const Geometry& g : random_geometries(count, 7))
    for (const Direction& d : {g.incident, g.reflected}) {
      ASSERT_LE(d.theta, theta_max);
      ASSERT_LE(std::abs(d.phi), pi);
      const double share = std::pow(std::sin(d.theta) / radius, 2);
      const int ring = std::min(3, static_cast<int>(4 * share)),
                quadrant = std::min(3, static_cast<int>((d.phi / pi + 1) * 2));
      ++cells[static_cast<std::size_t>(4 * ring + quadrant)];
    }
  // 2500 expected in each cell, standard deviation 48. A right program fails at five of them once in 1e5 seeds.
  for (int cell : cells) EXPECT_NEAR(cell, 2500, 5 * 48);
}

TEST(RandomGeometries, HaveNoRelationBetweenTheTwoBeams) {
  const int count = 20000;
  double sum = 0;
  for (const Geometry& g : random_geometries(count, 7)) {
    const Vector3 a = unit_vector(g.incident), b = unit_vector(g.reflected);
    sum += a[0] * b[0] + a[1] * b[1];
  }
  // Var(a·b) = 2 (R²/4)² = 0.109 with R = sin 75°: five standard deviations of the mean.
  EXPECT_NEAR(sum / count, 0, 5 * std::sqrt(0.109 / count));
}

TEST(RandomGeometries, RefuseANegativeCountAndAnglesOutsideTheHemisphere) {
  EXPECT_TRUE(random_geometries(0, 1).empty());
  EXPECT_EQ(message_of([] { random_geometries(-1, 1); }), "count = -1, must not be negative");
  EXPECT_EQ(message_of([] { random_geometries(1, 1, radians(91)); }), "theta_max = 91 degrees, must be in (0, 90]");
  EXPECT_THROW(random_geometries(1, 1, 0), std::invalid_argument);
  EXPECT_NO_THROW(random_geometries(1, 1, radians(90)));
}

TEST(Grouped, JoinsValuesWithoutAGapLargerThanTheTolerance) {
  const std::vector<double> values{3, 1, 1.1, 2, 1.05, 3.1};
  EXPECT_EQ(grouped(values, 0.2), (std::vector<std::size_t>{2, 0, 0, 1, 0, 2}));
  EXPECT_EQ(grouped(values, 1), (std::vector<std::size_t>{0, 0, 0, 0, 0, 0}));
  EXPECT_TRUE(grouped({}, 1).empty());
}

// Its matrix in the sp frame is that of a sample which looks the same from every side: it does not change.
TEST(Sample, AtZeroAzimuthKeepsItsMatrixInTheSpFrame) {
  Sample sample = sample_at(0.5);
  sample.geometry = {{0.7, 2.1}, {1.2, -0.4}};
  for (std::size_t e = 1; e < 16; ++e) sample.normalized.elements[e] = std::sin(static_cast<double>(e));
  const Sample turned_sample = at_zero_azimuth(sample);
  EXPECT_EQ(turned_sample.geometry.incident.phi, 0);
  EXPECT_NEAR(turned_sample.geometry.reflected.phi, -2.5, 1e-15);
  const Mueller before = change_frame(sample.normalized, sample.geometry, Frame::xy, Frame::sp);
  const Mueller after = change_frame(turned_sample.normalized, turned_sample.geometry, Frame::xy, Frame::sp);
  for (std::size_t e = 0; e < 16; ++e) EXPECT_NEAR(after.elements[e], before.elements[e], frame_error);
}

namespace {

Sample with_uncertainty(double phi_i) {
  Sample sample = sample_at(0.5);
  sample.geometry = {{0.7, phi_i}, {1.2, -0.4}};
  for (std::size_t e = 0; e < 16; ++e) {
    const auto number = static_cast<double>(e);
    sample.normalized.elements[e] = e == 0 ? 1 : std::sin(number);
    sample.uncertainty.elements[e] = 1e-3 * (1 + number / 10);
  }
  return sample;
}

}  // namespace

// Each element of the turned sample is linear in those of the sample, so a change of one shows its coefficient.
TEST(Sample, AtZeroAzimuthHasTheUncertaintiesOfUncorrelatedElements) {
  const Sample sample = with_uncertainty(2.1);
  const Mueller before = at_zero_azimuth(sample).normalized;
  Mueller squares;
  for (std::size_t from = 1; from < 16; ++from) {
    Sample changed = sample;
    changed.normalized.elements[from] += sample.uncertainty.elements[from];
    const Mueller after = at_zero_azimuth(changed).normalized;
    for (std::size_t to = 0; to < 16; ++to) squares.elements[to] += std::pow((after - before).elements[to], 2);
  }
  const Mueller turned_uncertainty = at_zero_azimuth(sample).uncertainty;
  EXPECT_EQ(turned_uncertainty(0, 0), sample.uncertainty(0, 0));
  // Differences of elements near 1: a few roundings of 1e-16.
  for (std::size_t e = 1; e < 16; ++e)
    EXPECT_NEAR(turned_uncertainty.elements[e], std::sqrt(squares.elements[e]), 1e-15) << e;
}

TEST(Sample, AtZeroAzimuthKeepsItsUncertaintiesWhereItIsTurnedByHalfTurnsOrNot) {
  for (const double phi_i : {0.0, pi, -pi}) {
    const Sample sample = with_uncertainty(phi_i), after = at_zero_azimuth(sample);
    for (std::size_t e = 0; e < 16; ++e)  // sin 2π is 2e-16
      EXPECT_NEAR(after.uncertainty.elements[e], sample.uncertainty.elements[e], 1e-17);
  }
}

TEST(Sample, AtZeroAzimuthDoesNotKnowWhatDependsOnAnUnknownUncertainty) {
  Sample sample = with_uncertainty(2.1);
  sample.uncertainty(0, 1) = 0;
  const Mueller after = at_zero_azimuth(sample).uncertainty;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      EXPECT_EQ(after(row, column) == 0, row == 0 && (column == 1 || column == 2)) << row << column;
  sample.geometry.incident.phi = pi;  // 12 and 13 do not mix
  EXPECT_GT(at_zero_azimuth(sample).uncertainty(0, 2), 0);
  sample.uncertainty = {};
  EXPECT_FALSE(has_uncertainty(at_zero_azimuth(sample)));
}

TEST(Sample, InAFrameHasTheMatrixOfThatFrameAndComesBack) {
  const Sample sample = with_uncertainty(2.1);
  for (const Frame frame : {Frame::xy, Frame::sp, Frame::scattering_plane}) {
    const Sample there = in_frame(sample, frame), back = from_frame(there, frame);
    const Mueller expected = change_frame(sample.normalized, sample.geometry, Frame::xy, frame);
    for (std::size_t e = 0; e < 16; ++e) {
      EXPECT_NEAR(there.normalized.elements[e], expected.elements[e], frame_error);
      EXPECT_NEAR(back.normalized.elements[e], sample.normalized.elements[e], 2 * frame_error);
    }
    EXPECT_EQ(there.uncertainty == sample.uncertainty, frame == Frame::xy);
  }
}

TEST(Sample, InTheFrameOfItsMeasurementIsAsItWasMeasured) {
  Sample measured = with_uncertainty(2.1);
  measured.normalized(1, 2) = nan_value;
  const Sample in_xy = from_frame(measured, Frame::sp), there = in_frame(in_xy, Frame::sp);
  EXPECT_GT(not_measured(in_xy).count(), 1U);
  EXPECT_EQ(not_measured(there), not_measured(measured));
  EXPECT_EQ(there.normalized(0, 1), measured.normalized(0, 1));
  EXPECT_EQ(there.uncertainty, measured.uncertainty);
  EXPECT_EQ(not_measured(in_frame(in_xy, Frame::xy)), not_measured(in_xy));
  EXPECT_EQ(in_frame(in_xy, Frame::xy).uncertainty, in_xy.uncertainty);
}

// Each element in sr⁻¹ is f11 m: a change of one input shows what it gives.
TEST(Sample, HasTheCovarianceOfUncorrelatedElements) {
  const Sample sample = with_uncertainty(2.1);
  MuellerCovariance expected;
  for (std::size_t from = 0; from < 16; ++from) {
    Sample changed = sample;
    (from == 0 ? changed.f11 : changed.normalized.elements[from]) += sample.uncertainty.elements[from];
    const Mueller part = measured_matrix(changed) - measured_matrix(sample);
    for (std::size_t e = 0; e < 16; ++e)
      for (std::size_t other = 0; other < 16; ++other) expected(e, other) += part.elements[e] * part.elements[other];
  }
  const MuellerCovariance found = covariance(sample);
  for (std::size_t e = 0; e < 16; ++e)  // differences of numbers near 1, of 1e-3: a few roundings of 1e-16
    for (std::size_t other = 0; other < 16; ++other) EXPECT_NEAR(found(e, other), expected(e, other), 1e-18);
}

TEST(Sample, DoesNotKnowTheCovarianceOfWhatHasNoUncertaintyOrWasNotMeasured) {
  Sample sample = with_uncertainty(2.1);
  sample.uncertainty(0, 1) = 0;
  sample.normalized(3, 3) = nan_value;
  const MuellerCovariance found = covariance(sample);
  for (std::size_t e = 0; e < 16; ++e) EXPECT_EQ(std::isnan(found(e, e)), e == 1 || e == 15) << e;
  Sample without_f11 = sample;
  without_f11.f11 = nan_value;
  EXPECT_TRUE(std::isnan(covariance(without_f11)(0, 0)));
  sample.uncertainty(0, 0) = 0;  // all have f11 in them
  EXPECT_TRUE(std::isnan(covariance(sample)(5, 5)));
}
