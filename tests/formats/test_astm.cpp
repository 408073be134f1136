// SPDX-License-Identifier: BSD-3-Clause
// ASTM E1392 and E2387 text as goniometers' programs write it: keywords, VARS with the names of columns, rows in radians.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <sstream>
#include <string>

#include "given/foreign.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/files/samples_file.hpp"
#include "mmbrdf/formats/export.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/quantities/quantities.hpp"

namespace mmbrdf {
namespace {

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.9g", value);
  return buffer;
}

/// Angles in nine digits: 1e-9 of an angle, and less than that of f.
constexpr double nine_digits = 2e-9;

std::string rows(int* count = nullptr) {
  std::string result;
  for (const double theta_i : {0.0, 20.0, 50.0})
    for (const double phi_i : {0.0, 75.0})
      for (const double theta_s : {0.0, 35.0, 70.0, 90.0})
        for (const double phi_s : {0.0, 130.0, 250.0}) {
          const double f = oriented(at(theta_i * degree, phi_i * degree), at(theta_s * degree, phi_s * degree));
          for (const double angle : {theta_i, phi_i, theta_s, phi_s}) result += text(angle * degree) + ",";
          result += text(f) + "\n";
          if (count != nullptr) ++*count;
        }
  return result;
}

std::string file() {
  int count = 0;
  const std::string all = rows(&count);
  return "SAMPLE_NAME ground glass\nNUM_POINTS " + std::to_string(count) + "\nVARS theta_i,phi_i,theta_s,phi_s,BRDF\n" +
         all;
}

TEST(Astm, GivesTheBrdfAtItsDirections) {
  const Folder folder;
  put(folder / "x.txt", file());
  const ForeignRead read = read_foreign_file(folder / "x.txt", {0.633});
  ASSERT_EQ(read.samples.size(), 54U);
  expect_values(read.samples, oriented, nine_digits);
  EXPECT_EQ(read.samples[0].wavelength, 0.633);
  EXPECT_EQ(read.understood,
            "an ASTM E1392 or E2387 file: angles in radians, f11 in sr^-1 = BRDF at 633 nm as told, phi_i of the "
            "source, phi_s of the detector; 18 of 72 rows at or below the horizon passed over");
  EXPECT_EQ(not_measured(read.samples[0]).count(), 15U);
}

TEST(Astm, KeepsTheSignOfNoise) {
  const Folder folder;
  put(folder / "x", "NUM_POINTS 2\r\nVARS theta_i,phi_i,theta_s,phi_s,BRDF\r\n0,0,0.5,0,-1e-4\r\n0,0,-0.5,0,2e-4\r\n");
  const ForeignRead read = read_foreign_file(folder / "x", {0.5});
  EXPECT_EQ(read.samples.at(0).f11, -1e-4);
  EXPECT_NEAR(std::cos(read.samples.at(1).geometry.reflected.phi), -1, 1e-15);  // −theta is the other side
}

TEST(Astm, MayBeginWithAByteOrderMark) {
  const Folder folder;
  put(folder / "x", "\xef\xbb\xbfVARS theta_i,theta_s,phi_s,BRDF\n0,0.5,0,0.1\n");
  EXPECT_EQ(read_foreign_file(folder / "x", {0.5}).samples.size(), 1U);
}

TEST(Astm, CountsNoCommentAsARow) {
  const Folder folder;
  put(folder / "x", "NUM_POINTS 2\nVARS theta_i,theta_s,phi_s,BRDF\n# one\n0,0.5,0,0.1\n# two\n0,0.6,0,0.2\n");
  EXPECT_EQ(read_foreign_file(folder / "x", {0.5}).samples.size(), 2U);
  put(folder / "x", "NUM_POINTS 3\nVARS theta_i,theta_s,phi_s,BRDF\n# one\n0,0.5,0,0.1\n0,0.6,0,0.2\n");
  EXPECT_TRUE(says(foreign_refusal(folder / "x", {0.5}), {"NUM_POINTS is 3, but there are 2 rows"}));
}

TEST(Astm, AsksWhetherItIsCompleteIfItsLastLineHasNoEnd) {
  const Folder folder;
  const std::string text = "VARS theta_i,theta_s,phi_s,BRDF\n0,0.5,0,0.1\n0,0.6,0,0.25";
  put(folder / "x", text);
  EXPECT_TRUE(says(read_foreign_file(folder / "x", {0.5}).understood, {"; its last line has no end: is it complete?"}));
  put(folder / "x", text + "\n");
  EXPECT_EQ(read_foreign_file(folder / "x", {0.5}).understood.find("no end"), std::string::npos);
}

TEST(Astm, HasWavelengthsInTheNamesOfColumnsOrIsTold) {
  const Folder folder;
  const std::string two = "VARS theta_i,phi_i,theta_s,phi_s,450nm,550 nm\n0.1,0,0.2,0,0.3,0.4\n";
  put(folder / "two", two);
  const ForeignRead read = read_foreign_file(folder / "two");
  EXPECT_EQ(read.samples.at(1).wavelength, 0.55);
  EXPECT_EQ(read.samples.at(1).f11, 0.4);
  EXPECT_TRUE(says(foreign_refusal(folder / "two", {0.5}), {"says its wavelengths itself", "500 nm"}));
  put(folder / "rgb", "VARS theta_i,phi_i,theta_s,phi_s,R,G,B\n0.1,0,0.2,0,0.3,0.4,0.5\n");
  EXPECT_TRUE(says(foreign_refusal(folder / "rgb"), {"rgb: does not say the wavelength", "R, G, B", "one for each"}));
  EXPECT_TRUE(says(foreign_refusal(folder / "rgb", {0.5}), {"one for each, not 500 nm"}));
  EXPECT_EQ(read_foreign_file(folder / "rgb", {0.61, 0.55, 0.47}).samples.at(2).wavelength, 0.47);
  EXPECT_TRUE(says(foreign_refusal(folder / "rgb", {0.61, 0.55, 4.7e-4}), {"0.47 nm is no wavelength"}));
}

TEST(Astm, IsRefusedInOneLineIfItIsCutOffOrWrong) {
  const Folder folder;
  const std::string path = folder / "x";
  put(path, file());
  expect_refused_where_cut(path, {0.633});
  EXPECT_TRUE(
      says(foreign_refusal(path), {"x: does not say the wavelength of its column BRDF: tell it, --wavelength NM"}));
  const std::string head = "VARS theta_i,phi_i,theta_s,phi_s,BRDF\n";
  const auto refusal = [&](const std::string& rows) {
    put(path, head + rows);
    return foreign_refusal(path, {0.633});
  };
  EXPECT_TRUE(says(refusal("0,0,45,0,1\n"), {"x:2: theta_s: 45 is no angle in radians"}));
  EXPECT_TRUE(says(refusal("0,0,0.5,0,1\n0,0,0.5,0,nan\n"), {"x:3: BRDF", "nan"}));
  EXPECT_TRUE(says(refusal("0,0,0.5,0\n"), {"x:2: 4 values, but VARS has 5 columns"}));
  EXPECT_TRUE(says(refusal(""), {"x: no samples"}));
  put(path, "NUM_POINTS 99999999999999\n" + head + "0,0,0.5,0,1\n");
  EXPECT_TRUE(says(foreign_refusal(path, {0.633}), {"NUM_POINTS is 99999999999999, but there are 1 rows"}));
  put(path, "NUM_POINTS 1\nVARS theta_i,phi_i,phi_s,BRDF\n0,0,0,1\n");
  EXPECT_TRUE(says(foreign_refusal(path, {0.633}), {"x:2: VARS has no column theta_s"}));
  for (const auto& [names, message] : {std::pair{"theta_s,phi_s,BRDF", "x:2: VARS has no column theta_i"},
                                       {"theta_i,theta_s,BRDF", "x:2: VARS has no column phi_s"},
                                       {"theta_i,theta_s,phi_s", "x:2: VARS has no column of values behind the angles"},
                                       {"theta_i,theta_s,phi_s,450nm,red",
                                        "x:2: only some of the columns 450nm, red have a wavelength, as in 532nm"}}) {
    put(path, "NUM_POINTS 1\nVARS " + std::string(names) + "\n0,0,0,1\n");
    EXPECT_TRUE(says(foreign_refusal(path, {0.633}), {message}));
  }
  put(path, "NUM_POINTS 1\nVARS theta_i,theta_s,phi_s,5nm\n0,0,0,1\n");
  EXPECT_TRUE(says(foreign_refusal(path), {"x: column 5nm: 5 nm is no wavelength"}));
  put(path, "NUM_POINTS 1\n0,0,0,1\n");
  EXPECT_TRUE(says(foreign_refusal(path, {0.633}), {"the header ends without VARS: cut off?"}));
}

TEST(Astm, IsNoTableOfSamplesAndSaysHowToMakeOne) {
  const Folder folder;
  put(folder / "x.astm", file());
  const std::string message = complaint([&] { read_samples(folder / "x.astm"); });
  EXPECT_TRUE(says(message, {"x.astm: is an ASTM E1392 or E2387 file, no table of samples", "mmbrdf convert"}));
  EXPECT_TRUE(holds_samples(folder / "x.astm"));
}

std::vector<Sample> exported(const Folder& folder, const Model& model, const ExportOptions& options) {
  std::ostringstream out;
  Export(model, export_format_of("x.astm"), options).write(out);
  put(folder / "x", out.str());
  return read_foreign_file(folder / "x").samples;
}

TEST(Astm, IsWrittenWithTheModelAtItsNodesUpToNinetyDegrees) {
  const Folder folder;
  const Model model = material("ptfe");
  const std::vector<double> wavelengths{0.45, 0.532};
  const std::vector<Sample> samples = exported(folder, model, {.wavelengths = wavelengths, .error = 1});
  ASSERT_EQ(samples.size(), 9U * 9 * 36 * 2);  // steps of 10 degrees; those at the horizon are not samples
  const std::array prepared{prepare(model, 0.45), prepare(model, 0.532)};
  for (const Sample& s : samples)
    ASSERT_NEAR(s.f11, prepared[s.wavelength > 0.5].f11(s.geometry), 1e-7 * s.f11);  // eight digits
  EXPECT_EQ(std::ranges::count(contents(folder / "x"), '\n'), 2 + 10 * 10 * 36);
  for (const Sample& s : exported(folder, model, {.wavelengths = {0.532}, .channel = "f_ss", .error = 1}))
    ASSERT_NEAR(s.f11, quantity("f_ss").value(prepared[1].evaluate(s.geometry, Frame::sp), {}), 1e-7 * s.f11);
}

TEST(Astm, IsWrittenWithTheErrorThatItSays) {
  const Folder folder;
  const Model model = material("ptfe-532");
  const Export table(model, export_format("astm"), {.error = 2e-3});
  std::ostringstream out;
  table.write(out);
  put(folder / "x", out.str());
  // In the middle of the cells of its nodes, where what is linear errs most, along one axis at a time.
  const std::vector<Sample> samples = read_foreign_file(folder / "x").samples;
  const PreparedModel prepared = prepare(model, 0.532);
  const double step = samples[1].geometry.reflected.phi - samples[0].geometry.reflected.phi;
  double squares = 0;
  long count = 0;
  for (const Sample& s : samples) {
    const double theta_i = s.geometry.incident.theta, theta_r = s.geometry.reflected.theta,
                 phi = s.geometry.reflected.phi;
    if (std::max(theta_i, theta_r) + step > table.error().theta_max) continue;
    const auto f = [&](double i, double r, double p) {
      return prepared.f11({{theta_i + i, 0}, {theta_r + r, phi + p}});
    };
    double mean = 0;
    for (const double i : {0.0, step})
      for (const double r : {0.0, step})
        for (const double p : {0.0, step}) mean += f(i, r, p) / 8;
    const double middle = f(step / 2, step / 2, step / 2);
    squares += (mean / middle - 1) * (mean / middle - 1);
    ++count;
  }
  const double worst = std::sqrt(squares / static_cast<double>(count));
  EXPECT_LE(table.error().rms, 2e-3);
  EXPECT_LT(table.error().rms, 1.2 * worst);
  EXPECT_GT(table.error().rms, 0.3 * worst);  // a parabola has half of it on average along an axis
}

TEST(Astm, IsNotWrittenOfWhatIsNoBrdf) {
  const Model model = material("ptfe");
  EXPECT_TRUE(says(export_refusal(model, "astm", {.channel = "depolarization"}),
                   {"channel depolarization: must be f11, or a quantity in sr^-1"}));
  EXPECT_TRUE(says(export_refusal(model, "astm", {.channel = "f_xx"}), {"f_xx"}));
  EXPECT_TRUE(says(export_refusal(model, "astm", {.error = 1e-9}), {"the finest table, of steps of 2.5 degrees"}));
}

}  // namespace
}  // namespace mmbrdf
