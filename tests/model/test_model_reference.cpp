// SPDX-License-Identifier: BSD-3-Clause
// Models against values that other programs computed from the same published coefficients.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "given/published.hpp"
#include "mmbrdf/files/coefficients_file.hpp"
#include "mmbrdf/model/prepared.hpp"

using namespace mmbrdf;

namespace {

constexpr double pi = std::numbers::pi;

Geometry in_degrees(double theta_i, double phi_i, double theta_r, double phi_r) {
  return {{radians(theta_i), radians(phi_i)}, {radians(theta_r), radians(phi_r)}};
}

/// The largest difference of two elements, relative to m11 of the second; infinite if a number is not finite.
double deviation(const Mueller& a, const Mueller& b) {
  double result = 0;
  for (std::size_t e = 0; e < 16; ++e) {
    const double difference = std::abs(a.elements[e] - b.elements[e]) / std::abs(b(0, 0));
    result = std::isfinite(difference) ? std::max(result, difference) : HUGE_VAL;
  }
  return result;
}

/// A row of the reference files: λ in µm, four angles in degrees, 16 elements.
Geometry geometry_of(const std::vector<double>& row) { return in_degrees(row[1], row[2], row[3], row[4]); }

Mueller matrix_of(const std::vector<double>& row) {
  Mueller m;
  std::copy_n(row.begin() + 5, 16, m.elements.begin());
  return m;
}

/// The largest deviation, relative to |m11|, from a file of SCATMECH; nothing if that or the coefficients are absent.
std::optional<double> deviation_from_scatmech(const std::string& file, const std::string& coefficients,
                                              Rotation rotation, Frame frame,
                                              const std::function<Geometry(const Geometry&)>& used) {
  const std::string values = reference("scatmech/" + file), model_file = published(coefficients);
  if (values.empty() || model_file.empty()) return {};
  Model read = read_coefficients(model_file);
  read.rotation = rotation;
  const PreparedModel model = prepare(read, 1);
  double result = 0;
  const auto rows = read_numbers(values);
  EXPECT_GE(rows.size(), 40u) << file;
  for (const auto& row : rows)
    result = std::max(result, deviation(model.at(row[0]).evaluate(used(geometry_of(row)), frame), matrix_of(row)));
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", result);
  testing::Test::RecordProperty(file, text);  // into --gtest_output=xml
  return result;
}

/// SCATMECH was run with the sample unturned, which puts the source at 180°, and with φr − φi kept. With the direction
/// of view along the normal it takes s along y as it does for the incident beam, whatever φr: the s of azimuth 180°. At
/// retro-reflection its ⊥ is ± k_in × x, which is along y as well: the s of the incident beam, as here.
Geometry unturned(const Geometry& g) {
  return {{g.incident.theta, pi},
          {g.reflected.theta, g.reflected.theta == 0 ? pi : pi + (g.reflected.phi - g.incident.phi)}};
}

// 17 digits are printed; an 80-bit evaluation of the same sums differs from SCATMECH by 1.3e-14.
constexpr double scatmech_error = 1e-12;

}  // namespace

TEST(ModelReference, ScatmechSumsAsPrinted) {
  const auto as_it_is = [](const Geometry& g) { return g; };
  for (const auto& [file, coefficients] :
       {std::pair("PTFE.xyxy.csv", "PTFE.coeff.csv"), std::pair("PTFE.532.xyxy.csv", "PTFE.532.coeff.csv")}) {
    const auto found = deviation_from_scatmech(file, coefficients, Rotation::as_printed, Frame::xy, as_it_is);
    if (!found) GTEST_SKIP() << absent(file);
    EXPECT_LE(*found, scatmech_error) << file;
  }
}

// Coefficients made for this test, every function of orders 7 and 4 at two powers of the wavelength.
TEST(ModelReference, ScatmechSumsCoefficientsThatAreInTheTree) {
  const Model made = as_printed(read_coefficients(reference("scatmech/made.coeff.csv")));
  EXPECT_EQ(orders(made), (Orders{7, 4}));
  const PreparedModel model = prepare(made, 1);
  const auto rows = read_numbers(reference("scatmech/made.xyxy.csv"));
  EXPECT_EQ(rows.size(), 40u);
  for (const auto& row : rows)
    EXPECT_LE(deviation(model.at(row[0]).evaluate(geometry_of(row)), matrix_of(row)), scatmech_error) << row[0];
}

TEST(ModelReference, ScatmechOfAnUnturnedSampleInAllFrames) {
  const std::pair<const char*, Frame> files[] = {{"PTFE.xyxy.rotation0.csv", Frame::xy},
                                                 {"PTFE.psps.rotation0.csv", Frame::sp},
                                                 {"PTFE.plane.rotation0.csv", Frame::scattering_plane}};
  for (const auto& [file, frame] : files)
    for (const Rotation rotation : {Rotation::covariant, Rotation::as_printed}) {  // the same with the source at 180°
      const auto found = deviation_from_scatmech(file, "PTFE.coeff.csv", rotation, frame, unturned);
      if (!found) GTEST_SKIP() << absent(file);
      EXPECT_LE(*found, scatmech_error) << file;
    }
}

// In the frames that turn with the sample a covariant model gives the same at the azimuths of the rows themselves. With
// the direction of view along the normal, φi takes the place of φr there.
TEST(ModelReference, ScatmechOfAnUnturnedSampleInTheFramesThatTurnWithIt) {
  const std::pair<const char*, Frame> files[] = {{"PTFE.psps.rotation0.csv", Frame::sp},
                                                 {"PTFE.plane.rotation0.csv", Frame::scattering_plane}};
  const auto with_phi_i_at_the_normal = [](Geometry g) {
    if (g.reflected.theta == 0) g.reflected.phi = g.incident.phi;
    return g;
  };
  for (const auto& [file, frame] : files) {
    const auto found =
        deviation_from_scatmech(file, "PTFE.coeff.csv", Rotation::covariant, frame, with_phi_i_at_the_normal);
    if (!found) GTEST_SKIP() << absent(file);
    EXPECT_LE(*found, scatmech_error) << file;
  }
}

// An independent prototype in numpy; f11 is printed with 17 digits, the normalised elements with 12 decimals.
TEST(ModelReference, GoldenGeometriesInAllFrames) {
  const std::string path = reference("golden_geometries.json");
  if (path.empty() || published("PTFE.coeff.csv").empty()) GTEST_SKIP() << absent("golden_geometries.json");
  std::ifstream file(path);
  const auto cases = nlohmann::json::parse(file)["cases"];
  EXPECT_EQ(cases.size(), 21u);
  for (const auto& one : cases) {
    const Model model = read_coefficients(published(one["file"]));
    const double wavelength = one["lambda"] == 0 ? only_wavelength(model) : one["lambda"].get<double>();
    const PreparedModel prepared = prepare(model, wavelength);
    const Geometry geometry = in_degrees(one["thetai"], one["phii"], one["thetar"], one["phir"]);
    for (const auto& [name, frame] :
         {std::pair("m_xy", Frame::xy), std::pair("m_sp", Frame::sp), std::pair("m_plane", Frame::scattering_plane)}) {
      const Mueller m = prepared.evaluate(geometry, frame);
      EXPECT_NEAR(m(0, 0), one["f11"].get<double>(), evaluation_error);
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j)
          EXPECT_NEAR(m.elements[4 * i + j] / m(0, 0), one[name][i][j].get<double>(), 5.1e-13)
              << one["file"] << " " << one["thetai"] << " " << one["thetar"] << " " << name << i << j;
    }
  }
}
