// SPDX-License-Identifier: BSD-3-Clause
// Zemax tabular BSDF: scatter angles about the specular ray, azimuth 180 pointing away from the normal.
#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "given/foreign.hpp"

namespace mmbrdf {
namespace {

std::string list(const char* name, const std::vector<double>& angles) {
  std::string text = std::string(name) + "\t" + std::to_string(angles.size()) + "\n";
  for (const double angle : angles) text += " " + std::to_string(angle);
  return text + "\n";
}

/// In the plane of incidence, away from the normal is the direction in which the polar angle of the specular ray grows.
std::string file(const char* symmetry, const std::vector<double>& rotations, const std::vector<double>& azimuths,
                 const Brdf& f) {
  const std::vector<double> incidences{0, 25, 60}, radials{0, 10, 40, 85};
  std::string text = "# a remark\nSource  Measured by hand\nSymmetry  " + std::string(symmetry) +
                     "\nSpectralContent  Monochrome\nScatterType  BRDF\n" + list("SampleRotation", rotations) +
                     list("AngleOfIncidence", incidences) + list("ScatterAzimuth", azimuths) +
                     list("ScatterRadial", radials) + "\nMonochrome\nDataBegin\n";
  for (const double rotation : rotations)
    for (const double theta : incidences) {
      text += "TIS 0.9\n";
      const Vector i = at(theta * degree, rotation * degree), specular = {-i[0], -i[1], i[2]};
      const Vector grows = at((90 - theta) * degree, rotation * degree);  // perpendicular, upwards: towards the normal
      const Vector side = {-std::sin(rotation * degree), std::cos(rotation * degree), 0};
      for (const double azimuth : azimuths) {
        for (const double radial : radials) {
          const Vector about = sum(std::cos(azimuth * degree), grows, std::sin(azimuth * degree), side);
          const Vector o = sum(std::cos(radial * degree), specular, std::sin(radial * degree), about);
          char value[32];
          std::snprintf(value, sizeof value, " %.12g", o[2] > 0 ? f(i, o) : 0);
          text += value;
        }
        text += "\n";
      }
    }
  return text + "DataEnd\n";
}

constexpr double twelve_digits = 1e-11;

TEST(Zemax, TurnsAnglesAboutTheSpecularRayIntoThoseOfTheSurface) {
  const Folder folder;
  put(folder / "x", file("PlaneSymmetrical", {0}, {0, 60, 120, 180}, isotropic));
  const ForeignRead read = read_foreign_file(folder / "x", {0.633});
  EXPECT_GE(read.samples.size(), 20U);
  expect_values(read.samples, isotropic, twelve_digits);
  // Light from 25 degrees, 10 degrees beyond the specular ray: theta_r 35, at azimuth 180 from the source.
  bool found = false;
  for (const Sample& s : read.samples)
    found = found || (std::abs(s.geometry.incident.theta - 25 * degree) < 1e-12 &&
                      std::abs(s.geometry.reflected.theta - 35 * degree) < 1e-12 &&
                      std::abs(std::cos(s.geometry.reflected.phi) + 1) < 1e-12);
  EXPECT_TRUE(found);
  EXPECT_TRUE(says(read.understood,
                   {"a Zemax tabular BSDF file: PlaneSymmetrical", "633 nm as told", "TIS not read",
                    "of 39 values at or below the horizon passed over", "repeats of a direction passed over: 9"}));
}

TEST(Zemax, HasSampleRotationsAndBothSides) {
  const Folder folder;
  put(folder / "x", file("ASymmetrical4D", {0, 40, 110}, {0, 90, 180, 270, 360}, oriented));
  const ForeignRead read = read_foreign_file(folder / "x", {0.633});
  EXPECT_GE(read.samples.size(), 60U);
  expect_values(read.samples, oriented, twelve_digits);
}

TEST(Zemax, IsRefusedInOneLineIfItIsCutOffOrWrong) {
  const Folder folder;
  const std::string path = folder / "x", good = file("Asymmetrical", {0}, {0, 90, 180, 270}, isotropic);
  put(path, good);
  expect_refused_where_cut(path, {0.633});
  EXPECT_TRUE(says(foreign_refusal(path), {"x: does not say the wavelength of its values"}));
  const auto refusal = [&](const std::string& what, const std::string& by) {
    std::string changed = good;
    changed.replace(changed.find(what), what.size(), by);
    put(path, changed);
    return foreign_refusal(path, {0.633});
  };
  EXPECT_TRUE(says(refusal("ScatterRadial\t4", "ScatterRadial\t4000000000000"),
                   {"x:12: ScatterRadial: 4e+12 is no number of angles"}));
  EXPECT_TRUE(says(refusal("ScatterRadial\t4", "ScatterRadial\t5"), {"x:15: ScatterRadial: 'Monochrome'"}));
  EXPECT_TRUE(says(refusal("ScatterRadial\t4", "ScatterRadial\t-1"), {"-1 is no number of angles"}));
  EXPECT_TRUE(says(refusal(" 60.0", " 95.0"), {"x:9: AngleOfIncidence: 95 degrees, must be in [0, 90]"}));
  EXPECT_TRUE(says(refusal("Monochrome", "XYZ"), {"x:4: SpectralContent 'XYZ'", "write the file as Monochrome"}));
  EXPECT_TRUE(says(refusal("BRDF", "BTDF"), {"x:5: ScatterType 'BTDF'"}));
  EXPECT_TRUE(says(refusal("TIS 0.9\n", "TIS 0.9\n inf"), {"x:18: value: 'inf'"}));
  EXPECT_TRUE(says(refusal("TIS 0.9\n", "TIS 0.9\n 1"), {"in place of TIS"}));
  EXPECT_TRUE(says(refusal("Asymmetrical", "Mirrored"), {"x:3: Symmetry 'Mirrored' is none of"}));
}

}  // namespace
}  // namespace mmbrdf
