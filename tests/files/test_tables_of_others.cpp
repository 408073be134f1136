// SPDX-License-Identifier: BSD-3-Clause
// Tables as other programs and people write them: those of numpy (savetxt), R (write.csv, write.csv2, write.table) and
// Octave (save -ascii, dlmwrite) as their versions 1.24.2, 4.2.2 and 7.3.0 were seen to write them.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <sstream>

#include "given/cases.hpp"
#include "given/files.hpp"
#include "mmbrdf/files/samples_file.hpp"
#include "mmbrdf/samples/simulation.hpp"
#include "mmbrdf/text/units.hpp"

namespace mmbrdf {
namespace {

struct Read {
  std::vector<Sample> samples;
  std::string understood;
};

Read read(const std::string& text, const SampleTable& table = {}) {
  std::istringstream in(text);
  SampleReader reader(in, "d.csv", table);
  Read result;
  for (Sample sample; reader.next(sample);) result.samples.push_back(sample);
  result.understood = reader.understood();
  return result;
}

std::string refusal(const std::string& text, const SampleTable& table = {}) {
  return complaint([&] { read(text, table); });
}

const std::string header = "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,f11,m22\n";

/// 532 nm, 45 degrees, 30 degrees at 180, f11 = 0.31, m22 = 0.1: the same however it is written.
void expect_the_sample(const Read& read, const std::string& understood) {
  ASSERT_GE(read.samples.size(), 1U);
  const Sample& s = read.samples[0];
  EXPECT_EQ(in_nanometres(s.wavelength), 532);
  EXPECT_NEAR(in_degrees(s.geometry.incident.theta), 45, 1e-12);
  EXPECT_NEAR(in_degrees(s.geometry.incident.phi), 0, 1e-12);
  EXPECT_NEAR(in_degrees(s.geometry.reflected.theta), 30, 1e-12);
  EXPECT_NEAR(std::cos(s.geometry.reflected.phi), -1, 1e-12);
  EXPECT_NEAR(s.f11, 0.31, 1e-15);
  EXPECT_NEAR(s.normalized(1, 1), 0.1, 1e-15);
  EXPECT_EQ(read.understood, understood);
}

TEST(TablesOfOthers, AreOursWithoutAWordIfTheyAre) {
  expect_the_sample(read(header + "532,45,0,30,180,0.31,0.1\n"), "");
}

TEST(TablesOfOthers, HaveTheHeaderOfNumpyInAComment) {
  expect_the_sample(read("# " + header + "5.320e+02,4.50e+01,0.0e+00,3.0e+01,1.8e+02,3.10e-01,1.00e-01\n"),
                    "names in a comment");
  expect_the_sample(
      read("# wavelength_nm theta_i_deg phi_i_deg theta_r_deg phi_r_deg f11 m22\n532 45 0 30 180 0.31 0.1\n"),
      "separated by blanks, names in a comment");
  expect_the_sample(read("% a remark\n% wavelength_nm theta_i_deg phi_i_deg theta_r_deg phi_r_deg f11 m22\n"
                         "  5.32e+02   4.5e+01   0   3e+01  1.8e+02  3.1e-01  1e-01\n"),
                    "separated by blanks, names in a comment");
}

TEST(TablesOfOthers, HaveTheQuotesAndRowNamesOfR) {
  const std::string quoted = R"("wavelength_nm","theta_i_deg","phi_i_deg","theta_r_deg","phi_r_deg","f11","m22")";
  expect_the_sample(read(quoted + "\n532,45,0,30,180,0.31,0.1\n"), "");
  expect_the_sample(read("\"\"," + quoted + "\n\"1\",532,45,0,30,180,0.31,0.1\n"), "");
  std::string blanks = quoted;
  std::ranges::replace(blanks, ',', ' ');
  expect_the_sample(read(blanks + "\n\"1\" 532 45 0 30 180 0.31 0.1\n"), "separated by blanks, row names");
  expect_the_sample(
      read("wavelength_nm theta_i_deg phi_i_deg theta_r_deg phi_r_deg f11 m22\na 532 45 0 30 180 0.31 0.1\n"),
      "separated by blanks, row names");
  expect_the_sample(read("operator," + header + "\"one, two\",532,45,0,30,180,0.31,0.1\n"), "not read: operator");
}

TEST(TablesOfOthers, HaveSemicolonsTabsAndDecimalCommas) {
  std::string semicolons = header, tabs = header;
  std::ranges::replace(semicolons, ',', ';');
  std::ranges::replace(tabs, ',', '\t');
  expect_the_sample(read(semicolons + "532;45;0;30;180;0,31;0,1\r\n"), "separated by semicolons, decimal commas");
  expect_the_sample(read(tabs + "532\t45\t0\t30\t180\t0.31\t0.1\n"), "separated by tabs");
  EXPECT_EQ(refusal(semicolons + "532;45;0;30;180;0,31;0,1\n532;45;0;30;180;0.31;0,1\n"),
            "d.csv:3: f11: '0.31': a decimal comma in one number, and another mark in this one");
  EXPECT_EQ(refusal(semicolons + "532;45;0;30;180;1.000,31;0,1\n"),
            "d.csv:2: f11: '1.000,31': a decimal point in one number, and another mark in this one");
}

TEST(TablesOfOthers, HaveTheExponentsOfFortran) {
  expect_the_sample(read(header + "5.32D+02,4.5d1,0,3D1,1.8D2,0.31D0,1.0D-01\n"), "");
}

TEST(TablesOfOthers, HaveNamesInAnyCaseWithUnitsInBrackets) {
  std::string capitals = header;
  for (char& c : capitals) c = static_cast<char>(std::toupper(c));
  expect_the_sample(read(capitals + "532,45,0,30,180,0.31,0.1\n"), "M22 ... are divided by f11");
  expect_the_sample(read("Wavelength (nm),Theta_i [deg],phi_i (°),θ_r (degrees),phi_r [deg],f11 "
                         "[1/sr],m22\n532,45,0,30,180,0.31,0.1\n"),
                    "'Wavelength (nm)' is wavelength_nm, 'Theta_i [deg]' is theta_i_deg, 'phi_i (°)' is phi_i_deg, "
                    "'θ_r (degrees)' is theta_r_deg, 'phi_r [deg]' is phi_r_deg, 'f11 [1/sr]' is f11");
}

// A matrix that is not divided has capitals in most books.
TEST(TablesOfOthers, AskWhatACapitalElementBesideOtherNamesIs) {
  std::string mixed = header;
  mixed.replace(mixed.find("m22"), 3, "M22");
  EXPECT_EQ(refusal(mixed + "532,45,0,30,180,0.31,0.1\n"),
            "d.csv:1: column M22: is it m22, the element divided by f11? Then call it so (columns m22=M22). Columns of "
            "other names are not read");
  expect_the_sample(read(mixed + "532,45,0,30,180,0.31,0.1\n", {.columns = {{"m22", "M22"}}}),
                    "M22 ... are divided by f11");
}

TEST(TablesOfOthers, HaveOtherNamesThatAreGiven) {
  const SampleTable names{.columns = {{"theta_i_deg", "AOI"}, {"f11", "BRDF (sr)"}}};
  expect_the_sample(
      read("wavelength_nm,AOI,phi_i_deg,theta_r_deg,phi_r_deg,BRDF (sr),m22\n532,45,0,30,180,0.31,0.1\n", names),
      "AOI is theta_i_deg, 'BRDF (sr)' is f11");
  const SampleTable numbers{.columns = {{"wavelength_nm", "1"},
                                        {"theta_i_deg", "2"},
                                        {"phi_i_deg", "3"},
                                        {"theta_r_deg", "4"},
                                        {"phi_r_deg", "5"},
                                        {"f11", "6"},
                                        {"m22", "7"}}};
  EXPECT_EQ(read("532 45 0 30 180 0.31 0.1\n", numbers).samples[0].f11, 0.31);
  EXPECT_EQ(refusal("532 45 0 30 180 0.31 0.1\n"),
            "d.csv:1: no header line: instead of a column's name there is the number 532; without one, columns need "
            "their numbers: wavelength_nm=1,theta_i_deg=2,...");
  EXPECT_EQ(refusal(header + "532,45,0,30,180,0.31,0.1\n", names),
            "d.csv:1: no column 'BRDF (sr)', which is to be f11; there are wavelength_nm ... m22");
  EXPECT_EQ(refusal(header + "532,45,0,30,180,0.31,0.1\n", {.columns = {{"albedo", "m22"}}}),
            "d.csv:1: column albedo = m22: albedo is no name of a column of samples");
}

TEST(TablesOfOthers, HaveAnglesInRadiansAndRelativeAzimuths) {
  const std::string radian_row = "532,0.7853981633974483,0,0.5235987755982988,3.141592653589793,0.31,0.1\n";
  expect_the_sample(read("wavelength_nm,theta_i_rad,phi_i_rad,theta_r_rad,phi_r_rad,f11,m22\n" + radian_row), "");
  expect_the_sample(read("wavelength_nm,theta_i_deg,theta_r_deg,delta_phi_deg,f11,m22\n532,45,30,180,0.31,0.1\n"), "");
  const Read turned = read("wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,delta_phi_deg,f11\n532,45,20,30,50,0.31\n");
  EXPECT_NEAR(degrees(turned.samples[0].geometry.reflected.phi), 70, 1e-12);
  EXPECT_EQ(refusal("wavelength_nm,theta_i,phi_i_deg,theta_r_deg,phi_r_deg,f11\n532,45,0,30,180,0.31\n"),
            "d.csv:1: no column theta_i_deg (nor thetai); is theta_i in degrees or radians? Call it theta_i_deg or "
            "theta_i_rad");
  EXPECT_EQ(
      refusal("wavelength,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,f11\n532,45,0,30,180,0.31\n"),
      "d.csv:1: no column wavelength_nm (nanometres), nor lambda or wavelength_um (micrometres); is wavelength in "
      "nanometres or micrometres? Call it wavelength_nm or wavelength_um");
  EXPECT_EQ(refusal("wavelength_nm,theta_i_rad,phi_i_deg,theta_r_deg,phi_r_deg,f11\n532,45,0,30,180,0.31\n"),
            "d.csv:2: theta_i_rad: 45 radians; a polar angle is at most pi/2");
  EXPECT_EQ(
      refusal("wavelength_nm,theta_i_deg,theta_i_rad,phi_i_deg,theta_r_deg,phi_r_deg,f11\n532,45,1,0,30,180,0.31\n"),
      "d.csv:1: theta_i_deg is given twice, in degrees and in radians");
}

TEST(TablesOfOthers, HaveWavelengthsThatCanBe) {
  const std::string rest = ",theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,f11\n";
  EXPECT_EQ(refusal("lambda" + rest + "532,45,0,30,180,0.31\n"),
            "d.csv:2: lambda: 532000 nm: is lambda in nanometres? Then call it wavelength_nm");
  EXPECT_EQ(refusal("wavelength_nm" + rest + "0.532,45,0,30,180,0.31\n"),
            "d.csv:2: wavelength_nm: 0.532 nm: is wavelength_nm in micrometres? Then call it wavelength_um");
  for (const double wavelength : {118.8, 0.0135, 0.000154}) {
    const auto samples = read("wavelength_um" + rest + std::to_string(wavelength) + ",45,0,30,180,0.31\n").samples;
    std::ostringstream written;
    write_samples(written, samples);
    EXPECT_NEAR(read(written.str()).samples[0].wavelength, wavelength, 1e-9);
  }
}

TEST(TablesOfOthers, HaveReflectanceFactorsCosinesAndPercent) {
  const std::string first = "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,", row = "532,45,0,30,180,";
  const auto f = [](double value) { return std::to_string(value) + ",0.1\n"; };
  const double pi = std::numbers::pi, cosine = std::cos(radians(30));
  const auto f11 = [&](const std::string& name, const std::string& value) {
    return read(first + name + "\n" + row + value + "\n").samples[0].f11;
  };
  EXPECT_DOUBLE_EQ(f11("brf", "0.97"), 0.97 / pi);
  EXPECT_DOUBLE_EQ(f11("BRF [%]", "97"), 0.97 / pi);
  EXPECT_DOUBLE_EQ(f11("f_cos", "0.26"), 0.26 / cosine);
  EXPECT_DOUBLE_EQ(f11("f11_percent", "31"), 0.31);
  EXPECT_DOUBLE_EQ(f11("BRDF", "0.31"), 0.31);
  EXPECT_DOUBLE_EQ(read(first + "brf_percent,u_brf_percent\n" + row + "97,1\n").samples[0].uncertainty(0, 0),
                   0.01 / pi);
  const Sample percent = read(first + "f11,m12_percent,u_f11,u_m12_percent\n" + row + "0.3,10,0.01,2\n").samples[0];
  EXPECT_DOUBLE_EQ(percent.normalized(0, 1), 0.1);
  EXPECT_DOUBLE_EQ(percent.uncertainty(0, 1), 0.02);
  const Read brf = read(first + "brf,u_brf\n" + row + "0.97,0.01\n");
  EXPECT_DOUBLE_EQ(brf.samples[0].uncertainty(0, 0), 0.01 / pi);
  EXPECT_EQ(brf.understood, "f11 = brf / pi");
  const Sample f_cos = read(first + "f_cos,u_f_cos\n" + row + "0.26,0.01\n").samples[0];
  EXPECT_DOUBLE_EQ(f_cos.uncertainty(0, 0) / f_cos.f11, 0.01 / 0.26);
  EXPECT_EQ(refusal(first + "f11,brf\n" + row + f(0.3)),
            "d.csv:1: columns f11 and brf: both say what f11 is, one of them is needed");
  EXPECT_EQ(refusal(first + "f_cos\n532,45,0,90,180,0.1\n"),
            "d.csv:2: f_cos: tells nothing of f11 at theta_r = 90 degrees");
}

TEST(TablesOfOthers, HaveRowsWithoutAValueRefusedOrPassedOverAndCounted) {
  const std::string whole = "532,45,0,30,180,0.31,0.1\n";
  for (const std::string row :
       {"532,NA,0,30,180,0.31,0.1\n", "532,45,0,,180,0.31,0.1\n", "532,45,0,30,180,NaN,0.1\n", "NA,NA,NA,NA,NA,NA,NA\n",
        ",,,,,,\n", "532,45,0,30,180,0.31,n/a\n", "532,45,0,30,180,--,0.1\n", "532,45,0,30,180,1.#IND,0.1\n",
        "532,45,0,30,180,null,-\n"}) {
    EXPECT_TRUE(says(refusal(header + whole + row), {"d.csv:3: ", "no value; complete it, or skip incomplete rows"}))
        << row << refusal(header + whole + row);
    const Read kept = read(header + whole + row + whole, {.skip_incomplete = true});
    EXPECT_EQ(kept.samples.size(), 2U) << row;
    EXPECT_EQ(kept.understood, "1 incomplete row passed over");
  }
  EXPECT_EQ(read(header + "532,45,0,30,180,0.31,\n", {.skip_incomplete = true}).samples.size(), 1U);  // not measured
  EXPECT_EQ(refusal(header + "NA,NA,NA,NA,NA,NA,NA\n", {.skip_incomplete = true}), "d.csv: no complete row");
}

TEST(TablesOfOthers, SayWhatALineIsThatIsNoRow) {
  const std::string row = "532,45,0,30,180,0.31,0.1\n";
  for (const std::string title : {"PTFE, May 2024\n", "// PTFE\n", "PTFE\n\n"})
    EXPECT_TRUE(
        says(refusal(title + header + row), {"d.csv:1: ", "; is this line a title? Leave it out, or begin it with #"}))
        << refusal(title + header + row);
  EXPECT_TRUE(says(refusal("a,b,c,d,e,f,g\n" + row), {"d.csv:1: ", "; if it has another name, give that"}));
  for (const std::string r : {"\"theta_i_deg\" \"f11\"\n\"1\" 45 0.3\n", "theta_i_deg,f11\n1,45,0.3\n"})  // row names
    EXPECT_TRUE(says(refusal(r), {"d.csv:1: ", "columns wavelength_nm=NAME"})) << refusal(r);
  EXPECT_TRUE(says(refusal(header + "nm,deg,deg,deg,deg,1/sr,-\n" + row),
                   {"d.csv:2: wavelength_nm: 'nm' is not a number; is this a line of units? Leave it out"}));
  EXPECT_EQ(refusal(header + row + "n,deg,deg,deg,deg,1/sr,-\n"), "d.csv:3: wavelength_nm: 'n' is not a number");
  EXPECT_TRUE(
      says(refusal(header + row + header + row),
           {"d.csv:3: wavelength_nm: 'wavelength_nm' is not a number; is this line a header again? Leave it out"}));
}

TEST(TablesOfOthers, SayWhereCommasAreDecimalAndSeparate) {
  EXPECT_TRUE(says(refusal(header + "532,0,45,0,0,0,30,0,180,0,0,31,0,1\n"),
                   {"d.csv:2: decimal commas, and commas between the numbers? Separate them by semicolons; 7 fields"}));
}

TEST(TablesOfOthers, WithoutAzimuthsSayWhichThoseOfOnePlaneAre) {
  EXPECT_TRUE(says(
      refusal("wavelength_nm,theta_i_deg,theta_r_deg,f11\n532,45,30,0.3\n"),
      {"d.csv:1: no column phi_i_deg (nor phi), nor phi_r_deg; in the plane of incidence it is 0, or 180 on the other "
       "side"}));
}

TEST(TablesOfOthers, SayWhatAFileIsThatIsNoText) {
  const auto starts = [](const std::string& bytes) { return refusal(bytes + std::string("\x03\0\n", 3)); };
  EXPECT_TRUE(says(starts("PK\x03\x04"), {"d.csv:1: a workbook of a spreadsheet", "save the table as CSV"}));
  EXPECT_TRUE(says(starts("\xd0\xcf\x11\xe0"), {"d.csv:1: a workbook of a spreadsheet"}));
  EXPECT_TRUE(says(starts("\x1f\x8b"), {"d.csv:1: a file compressed by gzip"}));
  EXPECT_TRUE(says(starts("\x93NUMPY"), {"d.csv:1: an array of numpy"}));
}

TEST(TablesOfOthers, OfElementsThatAreNotDividedAreRefusedAsThat) {
  const std::string first = "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,",
                    row = "532,45,0,30,180,0.3,0.1\n";
  for (const std::string name : {"m", "M", "S"})
    EXPECT_TRUE(
        says(refusal(first + name + "11," + name + "22\n" + row), {"column " + name + "11, but no f11", "not divided"}))
        << refusal(first + name + "11," + name + "22\n" + row);
  EXPECT_TRUE(says(refusal(first + "F11,T\n" + row), {"no column f11", "columns f11=NAME"}));
}

// Found by people who brought what they had; each was taken for something else before.
TEST(TablesOfOthers, ThatCouldBeTakenForSomethingElseAreRefusedWithTheWayOn) {
  const std::string first = "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,", row = "532,45,0,30,180,0.31";
  EXPECT_EQ(refusal("\"wavelength_um\",\"theta_i_deg\",\"delta_phi_deg\",\"theta_r_deg\",\"f11\"\n0.532,10,0,5,0.3,\n"),
            "d.csv:2: 5 fields (wavelength_um ... f11) are needed, there are 6: '0.532,10,0,5,0.3,'");
  EXPECT_EQ(refusal(first + "brf,u_f11\n" + row + ",0.01\n"),
            "d.csv:1: column u_f11 is of no column that is read; that of brf is called u_brf, in the same unit");
  EXPECT_EQ(refusal(first + "BRF [%],u_BRF\n" + row + ",0.01\n"),
            "d.csv:1: column u_BRF is of no column that is read; that of 'BRF [%]' is called u_brf_percent, in the "
            "same unit");
  EXPECT_EQ(refusal(first + "R [%]\n" + row + "\n", {.columns = {{"f11", "R [%]"}}}),
            "d.csv:1: column 'R [%]', which is to be f11: its name has another unit, percent");
  EXPECT_EQ(read(first + "R [%]\n" + row + "\n", {.columns = {{"f11_percent", "R [%]"}}}).samples[0].f11, 0.31 * 0.01);
  EXPECT_EQ(refusal(first + "f11,rotation_deg\n" + row + ",5\n"),
            "d.csv:1: column rotation_deg: if the sample was turned, call it sample_rotation_deg, in degrees; else "
            "leave it out");
  EXPECT_TRUE(says(refusal(first + "f11,m12_norm\n" + row + ",0.1\n"), {"d.csv:1: column m12_norm: is it m12"}));
  EXPECT_EQ(read(first + "f11,m12,m12_err\n" + row + ",0.1,1\n").understood, "not read: m12_err");
  EXPECT_TRUE(says(refusal(first + "f11\n#N/A,45,0,30,180,0.31\n"), {"d.csv:2: wavelength_nm: '#N/A': no value"}));
  EXPECT_EQ(read(first + "f11\n#DIV/0!,45,0,30,180,0.31\n" + row + "\n", {.skip_incomplete = true}).understood,
            "1 incomplete row passed over");
  for (const std::string value : {"\"0.31\"0", "\"0.31"})
    EXPECT_TRUE(says(refusal(first + "f11\n532,45,0,30,180," + value + "\n"), {"d.csv:2: a quote that does not end"}));
  EXPECT_TRUE(
      says(refusal("wavelength_nm,theta_i_deg,theta_r_deg,delta_phi_deg,delta_phi_rad,f11\n532,45,30,1,1,0.3\n"),
           {"d.csv:1: columns delta_phi_deg and delta_phi_rad mean the same"}));
  EXPECT_EQ(refusal(first + "f11,m12\n" + row + ",0.1\n", {.columns = {{"f11", "m12"}, {"m12", "m12"}}}),
            "d.csv:1: column m12 is to be both f11 and m12");
}

TEST(TablesOfOthers, InCapitalsSayThatElementsAreDivided) {
  EXPECT_EQ(
      read("WAVELENGTH_NM,THETA_I_DEG,PHI_I_DEG,THETA_R_DEG,PHI_R_DEG,F11,M22\n532,45,0,30,180,0.31,0.1\n").understood,
      "M22 ... are divided by f11");
}

TEST(TablesOfOthers, AreIncompleteWhereAnUncertaintyIs) {
  const std::string rows =
      "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,f11,m22,u_f11,u_m22\n"
      "532,45,0,30,180,0.31,0.1,0.01,\n532,45,0,30,180,0.31,,0.01,\n";
  EXPECT_TRUE(says(refusal(rows), {"d.csv:2: u_m22: '': no value"}));
  EXPECT_EQ(read(rows, {.skip_incomplete = true}).samples.size(), 1U);
}

/// Matrices of a model in another frame and convention, written and read in it.
RC_GTEST_PROP(TablesOfOthers, InAnotherFrameAndConventionAreTheSame, ()) {
  const Frame frame = *rc::gen::element(Frame::xy, Frame::sp, Frame::scattering_plane);
  const auto convention = *rc::gen::element(StokesConvention::germer2017, StokesConvention::s_first_right,
                                            StokesConvention::p_first_left, StokesConvention::p_first_right);
  Sample sample{.wavelength = 0.532,
                .geometry = {{between(0.05, 1.4), between(-3, 3)}, {between(0.05, 1.4), between(-3, 3)}},
                .f11 = 0.3,
                .normalized = {}};
  for (double& element : sample.normalized.elements) element = between(-1, 1);
  sample.normalized(0, 0) = 1;
  Sample other = sample;
  other.normalized = convert(change_frame(sample.normalized, sample.geometry, Frame::xy, frame),
                             StokesConvention::germer2017, convention);
  std::ostringstream written;
  write_samples(written, std::vector{other});
  const Read back = read(written.str(), {.frame = frame, .convention = convention});
  for (std::size_t e = 0; e < 16; ++e)
    RC_ASSERT(std::abs(back.samples[0].normalized.elements[e] - sample.normalized.elements[e]) < 1e-10);
  RC_ASSERT(from_frame(sample, Frame::xy).normalized == sample.normalized);
}

TEST(TablesOfOthers, AreReadWithWhatSpreadsheetsAndTypesettersAdd) {
  const std::string names = "wavelength_nm;theta_i_deg;phi_i_deg;theta_r_deg;phi_r_deg;f11;m12\n";
  const Read read_one = read("sep=;\n" + names + "532;45;0;30;180;0,3;\u22120,05\n");
  EXPECT_EQ(read_one.samples[0].f11, 0.3);
  EXPECT_EQ(read_one.samples[0].normalized(0, 1), -0.05);
  EXPECT_EQ(refusal("\xff\xfew\0a\0v\0e\0"), "d.csv:1: text in UTF-16; save it as UTF-8");
  EXPECT_EQ(refusal("wavelength_nm,theta_i_deg\r532,0\r"),
            "d.csv:1: lines that end in CR alone; save it with LF or CR LF");
}

// The four intensities of a matrix in the frame sp (theory 6.1), with an uncertainty that is that of a Monte Carlo draw.
TEST(TablesOfOthers, HaveBrdfsOfSAndP) {
  const std::string first = "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,f_ss,f_sp,f_ps,f_pp";
  const Read in_plane = read(first + "\n532,45,0,30,180,0.2,0.1,0.12,0.18\n");
  const Sample& s = in_plane.samples[0];
  EXPECT_DOUBLE_EQ(s.f11, 0.3);
  EXPECT_NEAR(s.normalized(0, 1), (0.2 + 0.1 - 0.12 - 0.18) / 0.6, 1e-15);
  EXPECT_NEAR(s.normalized(1, 0), (0.2 - 0.1 + 0.12 - 0.18) / 0.6, 1e-15);
  EXPECT_NEAR(s.normalized(1, 1), (0.2 - 0.1 - 0.12 + 0.18) / 0.6, 1e-15);
  EXPECT_TRUE(std::isnan(s.normalized(2, 2)));
  EXPECT_EQ(in_plane.understood, "f11, m12, m21, m22 of f_ss ... f_pp, frame sp");
  const Sample p_first =
      read(first + "\n532,45,0,30,180,0.2,0.1,0.12,0.18\n", {.convention = StokesConvention::p_first_left}).samples[0];
  EXPECT_EQ(p_first.normalized(0, 1), s.normalized(0, 1));  // s is s in any convention
  const Read out_of_plane = read(first + "\n532,45,0,30,120,0.2,0.1,0.12,0.18\n532,45,0,30,0,0.2,0.1,0.12,0.18\n");
  EXPECT_TRUE(std::isnan(out_of_plane.samples[0].normalized(1, 1)));
  EXPECT_EQ(out_of_plane.understood,
            "f11, m12, m21, m22 of f_ss ... f_pp, frame sp, 1 of 2 samples have elements that out of plane are unknown "
            "in xy, "
            "mixed with some that were not measured: fits in the isotropic basis take them as they were measured");
  ASSERT_TRUE(out_of_plane.samples[0].as_measured && !out_of_plane.samples[1].as_measured);
  EXPECT_NEAR(out_of_plane.samples[0].as_measured->normalized(1, 1), s.normalized(1, 1), 1e-15);
  const Sample u =
      read(first + ",u_f_ss,u_f_sp,u_f_ps,u_f_pp\n532,45,0,30,180,0.2,0.1,0.12,0.18,0.01,0,0,0\n").samples[0];
  EXPECT_DOUBLE_EQ(u.uncertainty(0, 0), 0.005);
  EXPECT_NEAR(u.uncertainty(1, 1), 0.01 * (1 - 0.16 / 0.6) / 0.6, 1e-15);
  EXPECT_EQ(refusal("wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,f_ss,f_pp\n532,45,0,30,180,0.2,0.18\n"),
            "d.csv:1: of f_ss, f_sp, f_ps and f_pp all four are needed, there are 2");
  EXPECT_EQ(refusal(first + ",m22\n532,45,0,30,180,0.2,0.1,0.12,0.18,0.1\n"),
            "d.csv:1: columns f_ss ... f_pp, and m22, which is made of them: one of the two is needed");
}

// What a receiver of all light reads of s and of p: the sums of the four over what is scattered.
TEST(TablesOfOthers, HaveBrdfsOfSAndPOfTheSourceAlone) {
  const std::string first = "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,";
  const Read both = read(first + "f_s,f_p,u_f_s,u_f_p\n532,45,0,30,120,0.3,0.2,0.01,0\n");
  const Sample& s = both.samples[0];
  EXPECT_DOUBLE_EQ(s.f11, 0.25);
  EXPECT_DOUBLE_EQ(s.normalized(0, 1), 0.2);
  EXPECT_TRUE(std::isnan(s.normalized(1, 0)) && std::isnan(s.normalized(0, 2)));
  EXPECT_DOUBLE_EQ(s.uncertainty(0, 0), 0.005);
  EXPECT_DOUBLE_EQ(s.uncertainty(0, 1), 0.01 * (1 - 0.2) / 0.5);
  EXPECT_EQ(both.understood, "f11, m12 of f_s and f_p, frame sp");
  const Read factors = read(first + "brf_s,brf_p\n532,45,0,30,120,0.9,0.6\n");
  EXPECT_DOUBLE_EQ(factors.samples[0].f11, 0.75 / std::numbers::pi);
  EXPECT_DOUBLE_EQ(factors.samples[0].normalized(0, 1), 0.2);
  EXPECT_EQ(refusal(first + "f_s\n532,45,0,30,180,0.2\n"), "d.csv:1: f_s and f_p both are needed, there is 1");
  EXPECT_EQ(refusal(first + "f_s,f_p,brf_s,brf_p\n532,45,0,30,180,1,1,1,1\n"),
            "d.csv:1: columns f_s and f_p, and brf_s and brf_p: one is needed");
  EXPECT_EQ(refusal(first + "f_s,f_p,f11\n532,45,0,30,180,1,1,1\n"),
            "d.csv:1: columns f_s and f_p, and f11, which is made of them: one of the two is needed");
}

TEST(TablesOfOthers, HaveBrdfsOfPolarizedLightInPercent) {
  const std::string first = "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,";
  const std::string values = "\n532,45,0,30,180,90,60,3,0\n";
  const Read percent = read(first + "brf_s [%],brf_p [%],u_brf_s [%],u_brf_p [%]" + values);
  EXPECT_DOUBLE_EQ(percent.samples[0].f11, 0.75 / std::numbers::pi);
  EXPECT_DOUBLE_EQ(percent.samples[0].normalized(0, 1), 0.2);
  EXPECT_DOUBLE_EQ(percent.samples[0].uncertainty(0, 0), 0.015 / std::numbers::pi);
  EXPECT_TRUE(says(percent.understood, {"f11, m12 of brf_s and brf_p / 100, frame sp"}));
  EXPECT_TRUE(says(refusal(first + "brf_s [%],brf_p [%],u_brf_s,u_brf_p" + values),
                   {"column u_brf_s is of no column that is read"}));
}

// Or they would be 0, which stands for none, next to others that are not.
TEST(TablesOfOthers, HaveUncertaintiesOfBrdfsOfPolarizedLightThatAreRead) {
  const std::string first = "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,";
  for (const std::string columns : {"brf_s,brf_p,u_f_s", "f_s,f_p,u_f_ss", "f11,m12,u_f_p", "f11,m12,u_f_sp"})
    EXPECT_TRUE(says(refusal(first + columns + "\n532,45,0,30,180,0.2,0.1,0.01\n"), {"is of no column that is read"}))
        << columns;
  EXPECT_EQ(
      refusal(first + "f_s,f_p,m33,u_m33\n532,45,0,30,180,0.2,0.1,0.5,0.01\n"),
      "d.csv:1: uncertainties of m33, but none of f_s and f_p: they are needed of all elements that are there, or "
      "of none");
  EXPECT_EQ(
      refusal(first + "f_s,f_p,u_f_s,u_f_p,m33\n532,45,0,30,180,0.2,0.1,0.01,0.01,0.5\n"),
      "d.csv:1: uncertainties of f_s and f_p, but none of m33: they are needed of all elements that are there, or "
      "of none");
}

TEST(TablesOfOthers, AreToldOfAllAnglesThatTheyLackAtOnce) {
  EXPECT_TRUE(says(refusal("wavelength_nm;AOI;det;f11\n532;45;30;0.3\n"),
                   {"no column theta_i_deg (nor thetai), nor phi_i_deg, nor theta_r_deg, nor phi_r_deg; if it has "
                    "another name, give that: columns theta_i_deg=NAME, of wavelength_nm, AOI, det, f11"}));
}

}  // namespace
}  // namespace mmbrdf
