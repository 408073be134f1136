// SPDX-License-Identifier: BSD-3-Clause
// ALTA text in each parametrization that is read. Its difference angles are those of the view, and so are the first
// three numbers of CARTESIAN.
#include <gtest/gtest.h>

#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "given/foreign.hpp"

namespace mmbrdf {
namespace {

/// Coordinates of a pair of directions, light and view.
using Coordinates = std::function<std::vector<double>(const Vector& light, const Vector& view)>;

double polar(const Vector& v) { return std::acos(v[2]); }
double azimuth(const Vector& v) { return std::atan2(v[1], v[0]); }

/// theta_h, phi_h, theta_d, phi_d of the view.
std::vector<double> half(const Vector& light, const Vector& view) {
  const Vector h = unit(sum(1, light, 1, view)), up = {0, 0, 1}, b = unit(cross(up, h)), t = cross(b, h);
  return {polar(h), azimuth(h), std::acos(dot(h, view)), std::atan2(dot(view, b), dot(view, t))};
}

std::string rows(const Coordinates& coordinates, const Brdf& f, bool cosine = false) {
  std::string text;
  const auto write = [&](double number) {
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, "%.17g ", number);
    text += buffer;
  };
  for (const double theta_i : {12.0, 40.0, 65.0})
    for (const double phi_i : {0.0, 100.0})
      for (const double theta_r : {5.0, 33.0, 71.0})
        for (const double phi_r : {-30.0, 90.0, 175.0}) {
          const Vector light = at(theta_i * degree, phi_i * degree), view = at(theta_r * degree, phi_r * degree);
          for (const double number : coordinates(light, view)) write(number);
          write(f(light, view) * (cosine ? view[2] : 1));
          text += "\n";
        }
  return text;
}

std::string head(const std::string& name, int coordinates, const std::string& output = "INV_STERADIAN") {
  return "#SAMPLE \"one\"\n# a comment\n#DIM " + std::to_string(coordinates) + " 1\n#VS 0\n#PARAM_IN " + name +
         "\n#PARAM_OUT " + output + "\n";
}

double between(const Vector& light, const Vector& view) {
  return std::remainder(azimuth(view) - azimuth(light), 2 * std::numbers::pi);
}

struct Case {
  const char* name;
  int coordinates;
  Coordinates of;
  Brdf f;
};

const std::vector<Case> cases{
    {"SPHERICAL_TL_PL_TV_PV", 4,
     [](const Vector& l, const Vector& v) {
       return std::vector{polar(l), azimuth(l), polar(v), azimuth(v)};
     },
     oriented},
    {"ISOTROPIC_TV_TL_DPHI", 3,
     [](const Vector& l, const Vector& v) {
       return std::vector{polar(v), polar(l), -between(l, v)};
     },
     isotropic},
    {"ISOTROPIC_TL_TV_PROJ_DPHI", 3,
     [](const Vector& l, const Vector& v) {
       return std::vector{polar(l), polar(v) * std::cos(between(l, v)), polar(v) * std::sin(between(l, v))};
     },
     isotropic},
    {"RUSIN_TH_PH_TD_PD", 4, half, oriented},
    {"RUSIN_TH_TD_PD", 3,
     [](const Vector& l, const Vector& v) {
       std::vector<double> all = half(l, v);
       all.erase(all.begin() + 1);
       return all;
     },
     isotropic},
    {"CARTESIAN", 6, [](const Vector& l, const Vector& v) { return std::vector{v[0], v[1], v[2], l[0], l[1], l[2]}; },
     oriented},
};

/// acos near 1 gives half of the digits of 17; no angle here is nearer to the normal than 5 degrees.
constexpr double digits = 1e-12;

TEST(Alta, GivesTheBrdfInEachParametrization) {
  const Folder folder;
  for (const Case& one : cases) {
    SCOPED_TRACE(one.name);
    put(folder / "x", head(one.name, one.coordinates) + rows(one.of, one.f));
    const ForeignRead read = read_foreign_file(folder / "x", {0.633});
    EXPECT_EQ(read.samples.size(), 54U);
    expect_values(read.samples, one.f, digits);
    EXPECT_TRUE(
        says(read.understood, {"an ALTA text file: ", one.name, "f11 in sr^-1 = INV_STERADIAN at 633 nm as told"}));
  }
}

TEST(Alta, DividesByACosineThatIsInTheValues) {
  const Folder folder;
  put(folder / "x", head(cases[0].name, 4, "INV_STERADIAN_COSINE_FACTOR") + rows(cases[0].of, oriented, true));
  const ForeignRead read = read_foreign_file(folder / "x", {0.633});
  expect_values(read.samples, oriented, digits);
  EXPECT_TRUE(says(read.understood, {"INV_STERADIAN_COSINE_FACTOR / cos(theta_r)"}));
}

TEST(Alta, HasSeveralValuesAndSegmentsInARow) {
  const Folder folder;
  put(folder / "x",
      "#DIM 4 3\n#PARAM_IN SPHERICAL_TL_PL_TV_PV\n#PARAM_OUT RGB_COLOR\n#VS 1 0 2\n"
      "0.1 0 0.2 0  0.3 0.4 0.5  0.01 0.4 0.6\n0.1 0 1.5707963 0  0 0 0  0 0 0\n");
  const ForeignRead read = read_foreign_file(folder / "x", {0.6, 0.5, 0.4});
  ASSERT_EQ(read.samples.size(), 3U);
  EXPECT_EQ(read.samples[2].f11, 0.5);
  EXPECT_TRUE(says(read.understood, {"vertical segments not read", "3 of 6 values at or below the horizon"}));
}

TEST(Alta, IsRefusedInOneLineIfItIsCutOffOrWrong) {
  const Folder folder;
  const std::string path = folder / "x";
  const auto refusal = [&](const std::string& text) {
    put(path, text);
    return foreign_refusal(path, {0.633});
  };
  const std::string good = head("SPHERICAL_TL_PL_TV_PV", 4);
  EXPECT_TRUE(says(refusal(good + "0.1 0 +-0.2 0 0.3\n"), {"x:7: coordinate 3: '+-0.2' is not a number"}));
  EXPECT_TRUE(says(refusal(good + "0.1 0 0.2 0 0.3\n0.1 0 0.2\n"), {"x:8: 3 numbers in place of 5: cut off?"}));
  EXPECT_TRUE(says(refusal(good + "45 0 0.2 0 0.3\n"), {"x:7: coordinate 1: 45 is no such angle in radians"}));
  EXPECT_TRUE(says(refusal(good + "0.1 0 0.2 0 nan\n"), {"x:7: value: 'nan'"}));
  EXPECT_TRUE(says(refusal(good), {"x: no samples"}));
  EXPECT_TRUE(says(refusal(good + "0.1 0 0.2 0 1e200\n"), {"x: no samples above the horizon that were measured"}));
  EXPECT_TRUE(says(refusal(head("COS_TH", 1)), {"x:5: #PARAM_IN COS_TH", "let ALTA write one of SPHERICAL"}));
  EXPECT_TRUE(says(refusal(head("CARTESIAN", 4)), {"#DIM says 4 coordinates, but CARTESIAN has 6"}));
  EXPECT_TRUE(says(refusal(head("CARTESIAN", 6, "ENERGY")), {"x:6: #PARAM_OUT ENERGY: is no BRDF"}));
  EXPECT_TRUE(says(refusal("#DIM 4 9999\n#PARAM_IN SPHERICAL_TL_PL_TV_PV\n"), {"#DIM says 9999 values a row"}));
  const std::string directions = "#PARAM_IN SPHERICAL_TL_PL_TV_PV\n";
  for (const std::string count : {"0", "1001"})
    EXPECT_TRUE(says(refusal("#DIM 4 1\n#DIM 4 " + count + "\n" + directions + "0.1 0 0.2 0 0.3\n"),
                     {"x:4: #DIM says " + count + " values a row, must be 1 to 1000"}));
  EXPECT_TRUE(says(refusal("#DIM 4 1\n#DIM 4 1 1\n" + directions + "0.1 0 0.2 0 0.3\n"),
                   {"x:4: the header has no line #DIM with two numbers: cut off?"}));
  EXPECT_TRUE(says(refusal("#DIM 4 1\n#PARAM_IN_\n0.1 0 0.2 0 0.3\n"), {"in no format of measurements"}));
  EXPECT_TRUE(says(refusal("#DIM 4 1\n#VS 0 3\n" + directions), {"x:2: #VS: 3 is none of 0, 1, 2"}));
  EXPECT_TRUE(says(refusal(head("CARTESIAN", 6) + "0 0 1 0 0 1.1 0.3\n"), {"x:7: coordinate 6: 1.1 of a unit vector"}));
  EXPECT_TRUE(says(refusal("#DIM 4 1\n#FORMAT binary\n#PARAM_IN CARTESIAN\n"), {"x:2: #FORMAT binary"}));
  EXPECT_TRUE(says(refusal("#DIM 4 1\n0.1\n#PARAM_IN CARTESIAN\n"), {"in no format of measurements"}));
  put(path, good + "0.1 0 0.2 0 0.3\n");
  EXPECT_TRUE(says(foreign_refusal(path), {"x: does not say the wavelength of its 1 value a row"}));
}

TEST(Alta, AsksWhetherItIsCompleteIfItsLastLineHasNoEnd) {
  const Folder folder;
  const std::string text = head("SPHERICAL_TL_PL_TV_PV", 4) + "0.1 0 0.2 0 0.3\n0.1 0 0.3 0 0.35";
  put(folder / "x", text);
  EXPECT_TRUE(says(read_foreign_file(folder / "x", {0.5}).understood, {"; its last line has no end: is it complete?"}));
  put(folder / "x", text + "\n");
  EXPECT_EQ(read_foreign_file(folder / "x", {0.5}).understood.find("no end"), std::string::npos);
}

TEST(Alta, IsNoTableOfSamplesWithACommentThatReadsLikeIts) {
  for (const std::string comment : {"#ALTA of last year", "#DIM of the lamp: 3", "#DIM 3 1", "#PARAM_IN words"}) {
    const std::string table = comment + "\nwavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,f11\n";
    EXPECT_EQ(foreign_format(table, table.size()), "") << comment;
  }
  const std::string late = "#DIM 4 1\nwavelength_nm,f11\n#PARAM_IN CARTESIAN\n";
  EXPECT_EQ(foreign_format(late, late.size()), "");
  EXPECT_EQ(foreign_format(",#DIM", 5), "");  // a line whose first word is empty
}

}  // namespace
}  // namespace mmbrdf
