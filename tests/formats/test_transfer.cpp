// SPDX-License-Identifier: BSD-3-Clause
// What codes of radiative transfer are given, read from its description (docs/formats.md) alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "given/foreign.hpp"
#include "given/random_model.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/numerics/quadrature.hpp"
#include "mmbrdf/polarization/elements.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"

namespace mmbrdf {
namespace {

using std::numbers::pi;

std::string written(const Model& model, const std::string& format, const ExportOptions& options) {
  std::ostringstream out;
  Export(model, export_format(format), options).write(out);
  return out.str();
}

/// The arrays of VLIDORT's supplement: moments [q, reflected, incident][m], exact values [q, view, azimuth, sun].
class Supplement {
 public:
  explicit Supplement(const std::string& text) : in_(text) {
    std::size_t lines = 0;
    in_ >> lines >> stokes >> streams >> moments >> suns >> views >> azimuths;
    std::string line;
    for (std::size_t skipped = 0; skipped <= lines; ++skipped) std::getline(in_, line);
    for (std::size_t i = 0; i < streams; ++i) cosines.push_back(next()), weights.push_back(next());
    for (std::size_t i = 0; i < suns; ++i) sun.push_back(next());
    for (std::size_t i = 0; i < views; ++i) view.push_back(next());
    for (std::size_t i = 0; i < azimuths; ++i) azimuth.push_back(next());
    f_0 = array(moments * 16 * streams * suns);
    f = array(moments * 16 * streams * streams);
    exact = array(16 * views * azimuths * suns);
    user_f_0 = array(moments * 16 * views * suns);
    user_f = array(moments * 16 * views * streams);
    in_ >> std::ws;
    EXPECT_TRUE(in_.eof());
  }

  /// The BRDF that the moments of an array (m, q, reflected, incident) add up to.
  double resummed(const std::vector<double>& array, std::size_t reflected_count, std::size_t q, std::size_t reflected,
                  std::size_t incident, double phi) const {
    double sum = 0;
    for (std::size_t m = 0; m < moments; ++m) {
      const double moment = array[((incident * reflected_count + reflected) * 16 + q - 1) * moments + m];
      const double angle = static_cast<double>(m) * phi;
      const bool upper = q == 3 || q == 4 || q == 7 || q == 8, lower = q == 9 || q == 10 || q == 13 || q == 14;
      sum += moment * (upper ? -std::sin(angle) : lower ? std::sin(angle) : std::cos(angle));
    }
    return sum;
  }

  std::size_t stokes = 0, streams = 0, moments = 0, suns = 0, views = 0, azimuths = 0;
  std::vector<double> cosines, weights, sun, view, azimuth, f_0, f, exact, user_f_0, user_f;

 private:
  double next() {
    double value = NAN;
    EXPECT_TRUE(in_ >> value);
    return value;
  }
  std::vector<double> array(std::size_t count) {
    std::vector<double> result;
    for (std::size_t i = 0; i < count; ++i) result.push_back(next());
    return result;
  }
  std::istringstream in_;
};

const TransferAngles some_angles{
    8, 0, {radians(30), radians(62)}, {radians(0), radians(20), radians(70)}, {radians(180), radians(240), radians(5)}};

/// Element q of a matrix of the frame sp.
double with_its_signs(const Mueller& m_sp, std::size_t q) {
  return m_sp.elements[q - 1] * ((q - 1) / 4 % 2 != (q - 1) % 2 ? -1 : 1);
}

/// π M between Stokes vectors with Q > 0 along the meridian planes and V > 0 right-handed, at an azimuth that counts from forward.
double expected(const PreparedModel& model, double mu_i, double mu_r, double phi, std::size_t q) {
  return pi * with_its_signs(model.evaluate({{std::acos(mu_i), pi}, {std::acos(mu_r), phi}}, Frame::sp), q);
}

// Ten digits are written.
constexpr double of_ten_digits = 1e-8;

TEST(Vlidort, MomentsAndValuesAreThoseOfTheModelInTheSupplementsOrderAndSigns) {
  const Model model = random_model(Family::isotropic, {5, 4}, 0, 3);
  const PreparedModel prepared = prepare(model, 0.5);
  const Supplement read(written(model, "vlidort", {.wavelengths = {0.5}, .transfer = some_angles}));
  EXPECT_EQ(read.stokes, 4U);
  EXPECT_EQ(read.moments, 16U);  // m = 0 … 2 × 8 − 1: all that the model has, up to 5 + 4 + 2
  EXPECT_EQ(read.azimuth, (std::vector<double>{0, 60, 185}));
  EXPECT_TRUE(std::ranges::is_sorted(read.cosines));
  for (std::size_t q = 1; q <= 16; ++q)
    for (const double phi : {0.0, 0.4, 2.0, -1.3}) {
      for (std::size_t r = 0; r < 8; ++r) {
        for (std::size_t i = 0; i < 8; ++i)
          ASSERT_NEAR(read.resummed(read.f, 8, q, r, i, phi),
                      expected(prepared, read.cosines[i], read.cosines[r], phi, q), of_ten_digits);
        for (std::size_t i = 0; i < 2; ++i)
          ASSERT_NEAR(read.resummed(read.f_0, 8, q, r, i, phi),
                      expected(prepared, std::cos(some_angles.suns[i]), read.cosines[r], phi, q), of_ten_digits);
      }
      for (std::size_t r = 0; r < 3; ++r) {
        const double mu_r = std::cos(some_angles.views[r]);
        for (std::size_t i = 0; i < 8; ++i)
          ASSERT_NEAR(read.resummed(read.user_f, 3, q, r, i, phi), expected(prepared, read.cosines[i], mu_r, phi, q),
                      of_ten_digits);
        for (std::size_t i = 0; i < 2; ++i)
          ASSERT_NEAR(read.resummed(read.user_f_0, 3, q, r, i, phi),
                      expected(prepared, std::cos(some_angles.suns[i]), mu_r, phi, q), of_ten_digits);
      }
    }
  for (std::size_t b = 0; b < 2; ++b)
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t v = 0; v < 3; ++v)
        for (std::size_t q = 1; q <= 16; ++q)
          ASSERT_NEAR(read.exact[((b * 3 + a) * 3 + v) * 16 + q - 1],
                      expected(prepared, std::cos(some_angles.suns[b]), std::cos(some_angles.views[v]),
                               radians(read.azimuth[a]), q),
                      of_ten_digits);
}

// What GCMCRI of VLIDORT 2.8.3 prints for an index of 1.5 + 0.7i, without shadows: facets that turn light from one
// direction into the other, whatever the slopes of the sea.
TEST(Vlidort, SignsAreThoseOfItsOwnKernelOfAWavySea) {
  struct Printed {
    double mu_i, mu_r, phi;  // phi = 0 is forward
    std::array<double, 16> f;
  };
  const Printed all[] = {{0.8,
                          0.6,
                          0.3,
                          {6.1879306E-01, -3.5134078E-01, -1.8178057E-01, 0, -3.7069598E-01, 4.4758633E-01,
                           3.9679033E-01, 7.7844472E-02, -1.3809058E-01, 3.7286238E-01, -2.5058930E-01, -2.0896887E-01,
                           0, -1.0247341E-01, 1.9805795E-01, -4.2034817E-01}},
                         {0.5,
                          0.7,
                          -0.4,
                          {3.6614674E-01, -2.3811138E-01, 1.5537128E-01, 0, -2.1636665E-01, 1.7746536E-01,
                           -2.3791668E-01, -1.0928125E-01, 1.8445254E-01, -2.6449146E-01, 2.9337902E-02, -1.2818917E-01,
                           0, 9.2051685E-02, 1.4107211E-01, -1.5764300E-01}}};
  for (const Printed& one : all) {
    const Geometry g{{std::acos(one.mu_i), pi}, {std::acos(one.mu_r), one.phi}};
    const double facet = std::acos(dot(at(g.incident.theta, pi), at(g.reflected.theta, one.phi))) / 2;
    const Mueller m =
        change_frame(mueller(reflection({1, 0, {1.5, 0.7}}, 0.5, facet)), g, Frame::scattering_plane, Frame::sp);
    for (std::size_t q = 1; q <= 16; ++q)
      EXPECT_NEAR(with_its_signs(m, q) / m(0, 0), one.f[q - 1] / one.f[0], 1e-7) << q;  // eight digits
  }
}

TEST(Vlidort, AzimuthsAreThoseThatItTakes) {
  TransferAngles around = some_angles;
  around.azimuths = {0, radians(90), radians(-10), radians(179.5), radians(-180), radians(360), radians(-360)};
  const Supplement read(written(material("ptfe-532"), "vlidort", {.transfer = around}));
  EXPECT_EQ(read.azimuth, (std::vector<double>{180, 270, 170, 359.5, 0, 180, 180}));  // 0 ... 360, 0 is forward
}

TEST(Vlidort, HasNoNegativeZero) {
  const std::string text = written(diffuser({0.3 / pi}), "vlidort", {.wavelengths = {0.5}, .transfer = some_angles});
  EXPECT_EQ(text.find("-0 "), std::string::npos);
  EXPECT_EQ(text.find("-0\n"), std::string::npos);
}

TEST(Vlidort, SurfaceOfAPerfectDiffuserIsItsAlbedoInMomentZeroAlone) {
  const Supplement read(written(diffuser({0.3 / pi}), "vlidort", {.wavelengths = {0.5}, .transfer = some_angles}));
  for (std::size_t r = 0; r < 8; ++r)
    for (std::size_t q = 0; q < 16; ++q)
      for (std::size_t m = 0; m < 16; ++m) ASSERT_EQ(read.f_0[(r * 16 + q) * 16 + m], q == 0 && m == 0 ? 0.3 : 0);
}

TEST(Vlidort, QuadratureOfMomentZeroGivesTheReflectance) {
  const Model model = material("ptfe-532");
  const Supplement read(written(model, "vlidort", {.transfer = some_angles}));
  for (std::size_t b = 0; b < 2; ++b) {
    double flux = 0;
    for (std::size_t r = 0; r < 8; ++r)
      flux += 2 * read.weights[r] * read.cosines[r] * read.f_0[((b * 8 + r) * 16) * read.moments];
    EXPECT_NEAR(flux, directional_hemispherical_reflectance(model, 0.532, {some_angles.suns[b], 0}), 1e-8);
  }
}

TEST(Vlidort, OfWhatWasNotMeasuredHasFewerStokesComponents) {
  Model model = random_model(Family::isotropic, {3, 2}, 0, 1);
  std::erase_if(model.blocks, [](const FittedBlock& fitted) { return fitted.block.name != "11"; });
  model.not_measured.set().reset(0);
  const Export table(model, export_format("vlidort"), {.wavelengths = {0.5}, .transfer = some_angles});
  EXPECT_TRUE(says(table.understood(), {"1 Stokes component", "f11 alone was measured"}));
  const Supplement read(written(model, "vlidort", {.wavelengths = {0.5}, .transfer = some_angles}));
  EXPECT_EQ(read.stokes, 1U);
  for (std::size_t k = 0; k < read.exact.size(); ++k) EXPECT_EQ(read.exact[k] != 0, k % 16 == 0);
}

TEST(Vlidort, SaysWhatTooFewStreamsLeaveOut) {
  TransferAngles few = some_angles;
  few.streams = 3;
  const Export table(material("ptfe-532"), export_format("vlidort"), {.transfer = few});
  EXPECT_TRUE(says(table.understood(), {"6 moments at 3 streams", "up to m = 13", "left out add up to at most"}));
}

TEST(Vlidort, RefusesWhatItCannotHold) {
  const auto refusal = [](const TransferAngles& angles, const Model& model = material("ptfe-532")) {
    return export_refusal(model, "vlidort", {.transfer = angles});
  };
  TransferAngles angles = some_angles;
  angles.moments = 17;
  EXPECT_TRUE(says(refusal(angles), {"17 moments", "8 cosines in each hemisphere carries at most 16"}));
  angles.moments = -3;
  EXPECT_TRUE(says(refusal(angles), {"-3 moments: must be 1 to 16, or 0 for all"}));
  angles = some_angles, angles.azimuths = {1e300};
  EXPECT_TRUE(says(refusal(angles), {"an azimuth = ", "degrees, must be in -360...360"}));
  angles = some_angles, angles.streams = 0;
  EXPECT_TRUE(says(refusal(angles), {"needs its number of streams"}));
  angles = some_angles, angles.suns = {};
  EXPECT_TRUE(says(refusal(angles), {"needs suns, their polar angles"}));
  angles = some_angles, angles.azimuths = {};
  EXPECT_TRUE(says(refusal(angles), {"come together"}));
  angles = some_angles, angles.suns = {2};
  EXPECT_TRUE(says(refusal(angles), {"a sun = 114.59", "must be in 0...90"}));
  EXPECT_TRUE(
      says(refusal(some_angles, material("ptfe")), {"351, 532, 633 and 1064 nm", "has one wavelength: choose it"}));
  Model anisotropic = random_model(Family::anisotropic, {2, 1}, 0, 1);
  anisotropic.validity.wavelengths = {0.5};
  EXPECT_TRUE(says(refusal(some_angles, anisotropic), {"depends on the azimuth of the source"}));
  EXPECT_TRUE(says(export_refusal(handed(), "vlidort", {.wavelengths = {0.5}, .transfer = some_angles}),
                   {"a sample that is its own mirror image", "sines of phi_r - phi_i"}));
  EXPECT_TRUE(says(export_refusal(material("ptfe-532"), "astm", {.transfer = some_angles}), {"angles of its own"}));
}

std::vector<std::vector<double>> lines_of_numbers(const std::string& text, std::size_t from) {
  std::vector<std::vector<double>> result;
  std::istringstream in(text);
  std::string line;
  for (std::size_t number = 0; std::getline(in, line); ++number) {
    if (number < from) continue;
    std::istringstream words(line);
    result.emplace_back();
    for (double value = 0; words >> value;) result.back().push_back(value);
  }
  return result;
}

TEST(Sixs, TablesAreReflectancesForTheSunAndForTheViewAtAzimuthsFromThatOfTheScene) {
  const Model model = material("ptfe-532");
  const PreparedModel prepared = prepare(model, 0.532);
  const std::string text = written(model, "6s", {.transfer = {0, 0, {radians(30)}, {radians(50)}, {radians(40)}}});
  EXPECT_EQ(text.substr(0, 2), "0 ");
  const auto lines = lines_of_numbers(text, 3);
  ASSERT_EQ(lines.size(), 28U);
  const double zeniths[] = {0, 10, 20, 30, 40, 50, 60, 70, 80, 85};
  constexpr double digits = 6e-8;  // seven decimals
  for (std::size_t t = 0; t < 2; ++t)
    for (std::size_t a = 0; a < 13; ++a) {
      ASSERT_EQ(lines[13 * t + a].size(), 10U);
      for (std::size_t z = 0; z < 10; ++z)
        EXPECT_NEAR(lines[13 * t + a][z],
                    pi * prepared.f11(in_degrees(t == 0 ? 30 : 50, 0, zeniths[z],
                                                 (t == 0 ? 40 : -40) + 30 * static_cast<double>(a))),
                    digits);
    }
  EXPECT_NEAR(lines[26][0], bihemispherical_reflectance(model, 0.532), digits);
  EXPECT_NEAR(lines[27][0], pi * prepared.f11(in_degrees(30, 0, 50, 40)), digits);
}

TEST(Sixs, SurfaceOfAPerfectDiffuserIsItsAlbedoEverywhere) {
  for (const auto& line : lines_of_numbers(
           written(diffuser({0.3 / pi}), "6s", {.wavelengths = {0.5}, .transfer = {0, 0, {0.5}, {0.1}, {0}}}), 3))
    for (const double value : line) EXPECT_EQ(value, 0.3);
}

TEST(Sixs, RefusesWhatItCannotHold) {
  const auto refusal = [](const TransferAngles& angles) {
    return export_refusal(material("ptfe-532"), "6s", {.transfer = angles});
  };
  EXPECT_TRUE(says(refusal({}), {"for one sun, one view and the azimuth"}));
  EXPECT_TRUE(says(refusal({0, 0, {0.1, 0.2}, {0.1}, {0}}), {"for one sun, one view"}));
  EXPECT_TRUE(says(refusal({4, 0, {0.1}, {0.1}, {0}}), {"neither streams nor moments"}));
  EXPECT_TRUE(says(refusal({0, 0, {0.1}, {0.1}, {radians(361)}}), {"an azimuth = 361 degrees", "in -360...360"}));
  EXPECT_TRUE(says(refusal({0, 0, {0.1}, {-0.1}, {0}}), {"the view = -5.7", "must be in 0...90"}));
}

}  // namespace
}  // namespace mmbrdf
