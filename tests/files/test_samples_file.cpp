// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/files/coefficients_file.hpp"
#include "mmbrdf/files/csv.hpp"
#include "mmbrdf/files/model_file.hpp"
#include "mmbrdf/files/readings_file.hpp"
#include "mmbrdf/files/samples_file.hpp"
#include "mmbrdf/polarimetry/measurement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <sstream>

#include "given/cases.hpp"
#include "given/checkout.hpp"
#include "given/files.hpp"
#include "given/published.hpp"

namespace mmbrdf {
namespace {

std::vector<Sample> samples_in(const std::string& text) {
  std::istringstream in(text);
  return read_samples(in, "d.csv");
}

bool same(const std::vector<Sample>& a, const std::vector<Sample>& b) {
  return std::ranges::equal(a, b, [](const Sample& x, const Sample& y) {
    return x.wavelength == y.wavelength && x.geometry == y.geometry && x.f11 == y.f11 && x.normalized == y.normalized;
  });
}

Model coefficients_in(const std::string& text) {
  std::istringstream in(text);
  return read_coefficients(in, "c.csv");
}

constexpr const char* published_header =
    "lambda,thetai,phi,thetar,phir,f_r11,f_r12/f_r11,f_r13/f_r11,f_r14/f_r11,f_r21/f_r11,f_r22/f_r11,f_r23/f_r11,"
    "f_r24/f_r11,f_r31/f_r11,f_r32/f_r11,f_r33/f_r11,f_r34/f_r11,f_r41/f_r11,f_r42/f_r11,f_r43/f_r11,f_r44/f_r11\r\n";
constexpr const char* own_header =
    "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,f11,m12,m13,m14,m21,m22,m23,m24,m31,m32,m33,m34,m41,m42,"
    "m43,m44\n";
constexpr const char* elements = ",.12,.13,.14,.21,.22,.23,.24,.31,.32,.33,.34,.41,.42,.43,.44\n";

std::string own(const std::string& row) { return own_header + row + elements; }

// ---- samples --------------------------------------------------------------------------------------------------------

// The light comes from 180 degrees of the laboratory, which is 150 on a sample that was turned by 30.
TEST(SamplesFile, TurnsBackWhatWasMeasuredOfATurnedSample) {
  std::string header = own_header;
  header.insert(header.size() - 1, ",sample_rotation_deg");
  const std::string row = std::string("532,45,180,30,0,0.3") + elements;
  std::string turned_row = row;
  turned_row.insert(turned_row.size() - 1, ",30");
  const Sample plain = samples_in(own_header + row).front(), back = samples_in(header + turned_row).front();
  EXPECT_NEAR(degrees(back.geometry.incident.phi), 150, 1e-12);
  EXPECT_NEAR(degrees(back.geometry.reflected.phi), -30, 1e-12);
  EXPECT_EQ(back.normalized, turned(plain.normalized, -radians(30)));
  EXPECT_EQ(back.f11, plain.f11);
}

TEST(Samples, OfThePublishedLayoutHaveTheSourceWhereANegativePolarAngleSays) {
  const auto samples = samples_in(std::string(published_header) + "0.532,-15,0,80.0258,-156.038,2.62E-01" + elements);
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_EQ(samples[0].wavelength, 0.532);
  EXPECT_EQ(samples[0].geometry.incident, (Direction{radians(15), std::numbers::pi}));
  EXPECT_EQ(samples[0].geometry.reflected, (Direction{radians(80.0258), radians(-156.038)}));
  EXPECT_EQ(samples[0].f11, 0.262);
  const Mueller expected{{1, .12, .13, .14, .21, .22, .23, .24, .31, .32, .33, .34, .41, .42, .43, .44}};
  EXPECT_EQ(samples[0].normalized, expected);
}

TEST(Samples, InNanometresAreThoseInMicrometres) {
  EXPECT_EQ(samples_in(own("532,1,2,3,4,.3"))[0].wavelength, 0.532);
  EXPECT_EQ(samples_in(own("1064,1,2,3,4,.3"))[0].wavelength, 1.064);
}

TEST(Samples, MayHaveCommentsBlanksPlusSignsEmptyLinesAndAByteOrderMark) {
  const std::string text = "\xef\xbb\xbf# measured on Monday, twice\n\n" + own(" +532 ,\t10, -20,+30 , 40, 3e-1");
  const auto samples = samples_in(text);
  EXPECT_TRUE(same(samples, samples_in(own("532,10,-20,30,40,0.3"))));
}

TEST(Samples, MayHaveTheirColumnsInAnyOrderAndOthersAmongThem) {
  std::string header = own_header;
  header.insert(0, "operator,");
  EXPECT_TRUE(
      same(samples_in(header + "somebody,532,10,20,30,40,0.3" + elements), samples_in(own("532,10,20,30,40,0.3"))));
  const std::string turned = std::string("phi_r_deg,theta_r_deg") + ",phi_i_deg,theta_i_deg,wavelength_nm" +
                             std::string(own_header).substr(std::string(own_header).find(",f11"));
  EXPECT_TRUE(same(samples_in(turned + "40,30,20,10,532,0.3" + elements), samples_in(own("532,10,20,30,40,0.3"))));
}

TEST(Samples, MayHaveANegativeBrdfSinceNoiseHasBothSigns) {
  EXPECT_EQ(samples_in(own("532,1,2,3,4,-0.01"))[0].f11, -0.01);
}

TEST(Samples, AreToldFromModelsByTheFirstLetter) {
  const Folder folder;
  const auto holds = [&](const std::string& text) {
    std::ofstream(folder / "f") << text;
    std::istringstream in(text);
    EXPECT_EQ(holds_samples(in), holds_samples(folder / "f")) << text;
    return holds_samples(folder / "f");
  };
  EXPECT_TRUE(holds("wavelength_nm,theta_i_deg"));
  EXPECT_TRUE(holds("\xef\xbb\xbf# measured\r\n#\n\n lambda, thetai"));
  for (const char* other : {"", "# only", "1, 1, 0, 0, 0, 0, 0, 2.5\n", " {\"format\": 1}"}) EXPECT_FALSE(holds(other));
  EXPECT_THROW(holds_samples(folder / "none"), std::runtime_error);
}

TEST(Samples, WrittenAndReadAreTheSame) {
  const Folder folder;
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Sample> samples(200);
  for (Sample& sample : samples) {
    sample.wavelength = 1 + uniform(engine) / 2;
    sample.geometry = {{radians(45 + 45 * uniform(engine)), 4 * uniform(engine)},
                       {radians(45 + 45 * uniform(engine)), 4 * uniform(engine)}};
    sample.f11 = uniform(engine);
    for (double& element : sample.normalized.elements) element = uniform(engine);
    sample.normalized.elements[0] = 1;
  }
  write_samples(folder / "s.csv", samples);
  const auto read = read_samples(folder / "s.csv");
  ASSERT_EQ(read.size(), samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(read[i].f11, samples[i].f11);
    EXPECT_EQ(read[i].normalized, samples[i].normalized);
    EXPECT_DOUBLE_EQ(read[i].wavelength, samples[i].wavelength);
    EXPECT_DOUBLE_EQ(read[i].geometry.incident.theta, samples[i].geometry.incident.theta);
    EXPECT_DOUBLE_EQ(read[i].geometry.incident.phi, samples[i].geometry.incident.phi);
    EXPECT_DOUBLE_EQ(read[i].geometry.reflected.theta, samples[i].geometry.reflected.theta);
    EXPECT_DOUBLE_EQ(read[i].geometry.reflected.phi, samples[i].geometry.reflected.phi);
  }
}

TEST(Samples, ThatLoseElementsOnTheWayToXyAreWrittenAndReadAsTheyWereMeasured) {
  const Folder folder;
  const std::string names =
      "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,frame,f11,m12,m22,m33,u_f11,u_m12,u_m22,u_m33\n";
  const auto samples = samples_in(names +
                                  "532,15,10,30,70,sp,0.3,0.1,0.25,0.2,0.01,0.02,0.03,0.04\n"
                                  "532,15,0,30,0,sp,0.3,0.1,0.25,0.2,0.01,0.02,0.03,0.04\n"
                                  "532,15,0,30,50,xy,0.3,0.1,0.25,,0.01,0.02,0.03,\n"
                                  "532,15,0,30,20,scattering_plane,0.3,0.1,0.25,0.2,0.01,0.02,0.03,0.04\n");
  ASSERT_TRUE(samples[0].as_measured && !samples[1].as_measured && !samples[2].as_measured && samples[3].as_measured);
  ASSERT_TRUE(std::isnan(samples[0].normalized(1, 1)));
  write_samples(folder / "s.csv", samples);
  const auto read = read_samples(folder / "s.csv");
  ASSERT_EQ(read.size(), samples.size());
  const auto same_bits = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  for (std::size_t s = 0; s < samples.size(); ++s) {
    EXPECT_EQ(own_frame(read[s]), own_frame(samples[s])) << s;
    const Sample back = in_own_frame(read[s]), was = in_own_frame(samples[s]);
    for (std::size_t e = 0; e < 16; ++e) {
      EXPECT_TRUE(same_bits(back.normalized.elements[e], was.normalized.elements[e])) << s << ' ' << e;
      EXPECT_TRUE(same_bits(read[s].normalized.elements[e], samples[s].normalized.elements[e])) << s << ' ' << e;
      EXPECT_EQ(back.uncertainty.elements[e], not_measured(was)[e] ? 0 : was.uncertainty.elements[e]) << s << ' ' << e;
    }
  }
}

TEST(Samples, WithAColumnOfFramesTakeNoOtherNamesUnlessTheFrameIsSaid) {
  const std::string text = "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,frame,f11,m12\n532,15,10,30,70,";
  const std::string remedy = "; if it is of something else, say the frame of all rows (--frame)";
  EXPECT_EQ(complaint([&] { samples_in(text + "17,0.3,0.1\n"); }),
            "d.csv:2: column frame: frame '17' is not one of xy, sp, scattering_plane" + remedy);
  EXPECT_EQ(complaint([&] { samples_in(text + ",0.3,0.1\n"); }),
            "d.csv:2: column frame: frame '' is not one of xy, sp, scattering_plane" + remedy);
  std::istringstream in(text + "17,0.3,0.1\n");
  SampleReader reader(in, "d.csv", {.frame = Frame::sp});
  Sample sample;
  ASSERT_TRUE(reader.next(sample));
  EXPECT_EQ(own_frame(sample), Frame::sp);
  EXPECT_TRUE(reader.understood().find("not read: frame") != std::string::npos) << reader.understood();
}

TEST(Samples, OfSAndPMayBeInTheFrameThatAColumnSays) {
  const auto samples = samples_in(
      "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,frame,f_ss,f_sp,f_ps,f_pp\n"
      "532,15,10,30,70,scattering_plane,0.2,0.1,0.12,0.18\n532,15,10,30,70,sp,0.2,0.1,0.12,0.18\n");
  EXPECT_EQ(own_frame(samples[0]), Frame::scattering_plane);
  EXPECT_EQ(own_frame(samples[1]), Frame::sp);
  EXPECT_EQ(in_own_frame(samples[0]).normalized(0, 1), in_own_frame(samples[1]).normalized(0, 1));
}

TEST(SampleWriter, WritesNoElementsOfAnotherFrameAsThoseOfXy) {
  const auto samples = samples_in(
      "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,frame,f11,m12\n532,15,10,30,70,sp,0.3,0.1\n");
  std::ostringstream out;
  EXPECT_THROW(SampleWriter(out, measured_elements(samples), false, false).write(samples), std::invalid_argument);
}

TEST(Samples, OfRoundAnglesAreWrittenRound) {
  const Folder folder;
  const std::string text = own("532,15,180,30,-120,0.3");
  write_samples(folder / "s.csv", samples_in(text));
  EXPECT_TRUE(contents(folder / "s.csv").starts_with(std::string(own_header) + "532,15,180,30,-120,0.3,0.12,"));
}

/// A file of one sample with these columns behind its elements.
std::string with_columns(const std::string& names, const std::string& values) {
  std::string header = own_header, row = elements;
  header.insert(header.size() - 1, names);
  row.insert(row.size() - 1, values);
  return header + "532,10,20,30,40,0.3" + row;
}

constexpr const char* uncertainty_names =
    ",u_f11,u_m12,u_m13,u_m14,u_m21,u_m22,u_m23,u_m24,u_m31,u_m32,u_m33,u_m34,u_m41,u_m42,u_m43,u_m44";
constexpr const char* uncertainty_values =
    ",1e-3,.012,.013,.014,.021,.022,.023,0,.031,.032,.033,.034,.041,.042,.043,.044";

TEST(Samples, HaveTheUncertaintiesOfTheirColumnsOrNone) {
  const auto samples = samples_in(with_columns(uncertainty_names, uncertainty_values));
  const Mueller expected{{.001, .012, .013, .014, .021, .022, .023, 0, .031, .032, .033, .034, .041, .042, .043, .044}};
  EXPECT_EQ(samples[0].uncertainty, expected);
  EXPECT_TRUE(same(samples, samples_in(own("532,10,20,30,40,0.3"))));
  EXPECT_FALSE(has_uncertainty(samples_in(own("532,10,20,30,40,0.3"))[0]));
}

TEST(Samples, WithUncertaintiesAreWrittenAndReadTheSame) {
  const std::vector<Sample> samples = samples_in(with_columns(uncertainty_names, uncertainty_values));
  std::ostringstream out;
  write_samples(out, samples);
  EXPECT_NE(out.str().find(std::string("m44") + uncertainty_names + "\n"), std::string::npos);
  EXPECT_EQ(samples_in(out.str())[0].uncertainty, samples[0].uncertainty);
}

TEST(Samples, WithUncertaintiesOfManyDigitsAreReadBackToTheSameBits) {
  Sample sample{0.532, {{0.1, 0.2}, {0.3, 0.4}}, 0.3, diagonal(1, 0, 0, 0)};
  for (std::size_t e = 0; e < 16; ++e) sample.uncertainty.elements[e] = 1.0 / static_cast<double>(300 + 7 * e);
  std::ostringstream out;
  write_samples(out, {{sample}});
  EXPECT_EQ(samples_in(out.str())[0].uncertainty, sample.uncertainty);
}

TEST(Samples, OfWhichOnlySomeHaveUncertaintiesAreNotWritten) {
  const Folder folder;
  const std::vector<Sample> samples{samples_in(with_columns(uncertainty_names, uncertainty_values))[0],
                                    samples_in(own("532,10,20,30,40,0.3"))[0]};
  EXPECT_EQ(message_of([&] { write_samples(folder / "s.csv", samples); }),
            "sample 2 has no uncertainties, but others have");
  EXPECT_EQ(folder.files(), 0);
}

TEST(Samples, WithUncertaintiesThatAreWrongAreRefusedWithFileLineAndValue) {
  const auto refusal = [](const std::string& names, const std::string& values) {
    return complaint([&] { samples_in(with_columns(names, values)); });
  };
  const std::string names = uncertainty_names, values = uncertainty_values;
  EXPECT_TRUE(
      says(refusal(",u_f11", ",0.1"), {"d.csv:1: column u_f11, but no u_m12: ", "all elements that are there"}));
  EXPECT_TRUE(says(refusal(names.substr(6), values.substr(5)), {"d.csv:1: column u_m12, but no u_f11: "}));
  EXPECT_TRUE(
      says(refusal(names, values.substr(0, values.rfind(',')) + ",-0.1"), {"d.csv:2: u_m44: -0.1: ", "negative"}));
  EXPECT_TRUE(says(refusal(names, values.substr(0, values.rfind(',')) + ",inf"), {"d.csv:2: u_m44: 'inf'"}));
}

TEST(Samples, ArePublishedAtFourWavelengthsWithSixIncidentAngles) {
  const std::string file = published("PTFE.data.csv"), random = published("PTFE.data.random.csv");
  if (file.empty() || random.empty()) GTEST_SKIP() << absent("PTFE.data.csv, PTFE.data.random.csv");
  const auto samples = read_samples(file);
  EXPECT_EQ(samples.size(), 7296U);
  EXPECT_EQ(read_samples(random).size(), 1760U);
  EXPECT_EQ(wavelengths(samples), (std::vector<double>{0.351, 0.532, 0.633, 1.064}));
  const auto at_15 = std::ranges::count_if(samples, [](const Sample& s) {
    return s.geometry.incident == Direction{radians(15), std::numbers::pi};
  });
  EXPECT_EQ(at_15, 1212);  // 4 × 303, theory 3.1
}

TEST(Samples, ThatAreWrongAreRefusedWithFileLineAndValue) {
  const std::string row = "532,1,2,3,4,0.3";
  const std::pair<std::string, std::vector<std::string>> cases[] = {
      {own("532,95,2,3,4,0.3"), {"d.csv:2: theta_i_deg: 95 "}},
      {own("532,1,2,-90.5,4,0.3"), {"d.csv:2: theta_r_deg: -90.5 "}},
      {own("-532,1,2,3,4,0.3"), {"d.csv:2: wavelength_nm: -532", "positive"}},
      {own("0,1,2,3,4,0.3"), {"d.csv:2: wavelength_nm: 0", "positive"}},
      {own("532,1,2,3,4,abc"), {"d.csv:2: f11: 'abc' is not a number"}},
      {own("532,1,2,3,4,0.3x"), {"d.csv:2: f11: '0.3x' is not a number"}},
      {own("532,1,2,3,,0.3"), {"d.csv:2: phi_r_deg: '': no value"}},
      {own("532,1,2,3,4,nan"), {"d.csv:2: f11: 'nan': no value", "skip incomplete rows"}},
      {own("532,1,-inf,3,4,0.3"), {"d.csv:2: phi_i_deg: '-inf' is not a finite number"}},
      {own("532,1,2,3,4,1e999"), {"d.csv:2: f11: '1e999' is beyond the range"}},
      {own(row) + "# comment\n532,1,2,3\n", {"d.csv:4: 21 fields", "there are 4: '532,1,2,3'"}},
      {own("532,1,2,3,4,0.3,0.4"), {"d.csv:2: 21 fields", "there are 22"}},
      {own_header, {"d.csv: no samples"}},
      {"", {"d.csv: empty file"}},
      {"# nothing\n\n", {"d.csv: empty file"}},
      {row + elements, {"d.csv:1: no header line", "532"}},
      {std::string("wavelength_nm,f11\0\n", 19), {"d.csv:1:", "'\\x00'", "binary"}},
      {std::string("\x7f"
                   "ELF\x02\x01\n"),
       {"d.csv:1:", "'\\x7f'", "binary"}},
      {std::string(70000, 'x'), {"d.csv:1: more than 65535 characters"}},
      {"a,f11,f11\n", {"d.csv:1: two columns", "'f11'"}},
      {"lambda," + own(row), {"d.csv:1: the wavelength is given twice"}},
      {"thetai," + own(row), {"d.csv:1: columns thetai and theta_i_deg"}},
      {"lambda,thetai,thetar,phir,f11\n", {"d.csv:1: no column phi_i_deg"}},
      {"thetai,phi,thetar,phir,f11\n", {"d.csv:1: no column wavelength_nm"}},
      {"lambda,thetai,phi,thetar,phir\n", {"d.csv:1: no column f11"}},
      {"lambda,thetai,phi,thetar,phir,f11,M12\n", {"d.csv:1: column M12: is it m12"}},
      {"lambda,thetai,phi,thetar,phir,f11,f_r12\n", {"d.csv:1: column f_r12: is it m12"}},
      {"lambda,thetai,phi,thetar,phir,f11,m51\n", {"d.csv:1: column m51: elements are called m12 ... m44"}},
      {"lambda,thetai,phi,thetar,phir,f11,u_m12\n", {"d.csv:1: column u_m12, but no m12"}},
      {"lambda,thetai,phi,thetar,phir,m11,m12\n", {"d.csv:1: column m11, but no f11"}},
  };
  for (const auto& [text, parts] : cases) EXPECT_TRUE(says(complaint([&, &file = text] { samples_in(file); }), parts));
}

TEST(Samples, HaveAnElement11OfOneIfAny) {
  std::string header = own_header;
  header.insert(header.find("m12"), "m11,");
  EXPECT_TRUE(same(samples_in(header + "532,10,20,30,40,0.3,1" + elements), samples_in(own("532,10,20,30,40,0.3"))));
  EXPECT_TRUE(
      says(complaint([&] { samples_in(header + "532,10,20,30,40,0.3,0.3" + elements); }), {"d.csv:2: m11: 0.3: "}));
}

TEST(Samples, AreNotInATableOfElementsThatAreNotDivided) {
  const std::string file = reference("scatmech/made.xyxy.csv");
  EXPECT_TRUE(says(complaint([&] { read_samples(file); }), {"made.xyxy.csv:1: column m11, but no f11"}));
}

TEST(GeometryColumns, AreUnderstoodInReferenceFiles) {
  const std::string file = reference("scatmech/made.xyxy.csv");
  std::ifstream in(file);
  CsvReader reader(in, file);
  const GeometryColumns columns(reader);
  ASSERT_TRUE(reader.next());
  EXPECT_EQ(columns.wavelength(reader), 0.351);
  EXPECT_EQ(columns.geometry(reader), (Geometry{{0, radians(20)}, {radians(30), radians(75)}}));
  int rows = 1;
  while (reader.next()) ++rows;
  EXPECT_EQ(rows, 40);
}

TEST(GeometryColumns, TakeTheWavelengthThatIsGivenWhereThereIsNoColumn) {
  std::istringstream in("thetai,phii,thetar,phir\n1,2,3,4\n");
  CsvReader reader(in, "g.csv");
  const GeometryColumns columns(reader, 0.633);
  ASSERT_TRUE(reader.next());
  EXPECT_EQ(columns.wavelength(reader), 0.633);
  EXPECT_EQ(reader.text(), "1,2,3,4");
}

// ---- coefficients ---------------------------------------------------------------------------------------------------

TEST(Coefficients, HaveNInColumn3AndMInColumn4) {
  const Model model = coefficients_in("1, 1, 0, 0, 0, 0, 0, 2.5\n1, 2, 0, 4, 0, 2, 0, -1e-3\r\n");
  ASSERT_EQ(model.blocks.size(), 2U);
  EXPECT_EQ(model.blocks[1].block.modes[0], (Mode{Function::m12, 0, 4, 0, 2}));
  EXPECT_EQ(model.blocks[1].coefficients, std::vector<double>{-1e-3});
  EXPECT_EQ(model.family, Family::germer2017);
  EXPECT_EQ(model.powers, 0);
  EXPECT_EQ(model.name, "c");
  EXPECT_TRUE(model.validity.wavelengths.empty());
  EXPECT_TRUE(model.reflectance.wavelengths.empty());
}

TEST(Coefficients, MayComeInAnyOrderAndLackPowers) {
  const Model model = coefficients_in("1,1,2,0,0,0,3,7\n4,4,0,0,0,0,0,1\n1,1,0,0,0,0,0,5\n1,1,0,0,0,0,1,6\n");
  EXPECT_EQ(model.powers, 3);
  ASSERT_EQ(model.blocks.size(), 2U);
  EXPECT_EQ(model.blocks[0].coefficients, (std::vector<double>{5, 0, 6, 0, 0, 0, 0, 7}));
  EXPECT_EQ(model.blocks[1].coefficients, (std::vector<double>{1, 0, 0, 0}));
  EXPECT_EQ(to_coefficients_csv(model).substr(0, 46), "1, 1, 0, 0, 0, 0, 0, 5\n1, 1, 2, 0, 0, 0, 0, 0\n");
}

// SCATMECH 6c5c179 passes over what is behind a semicolon, anywhere; "#" it refuses, and mmbrdf has always taken it.
TEST(Coefficients, MayHaveRemarks) {
  const Model model =
      coefficients_in("; a remark\n1, 1, 0, 0, 0, 0, 0, 5 ; another\n;\n# one of ours\n1, 1, 2, 0, 0, 0, 0, 7;\n");
  EXPECT_EQ(model.blocks.at(0).coefficients, (std::vector<double>{5, 7}));
}

TEST(Coefficients, OfEachPublishedFileAreWrittenAsTheSameBytes) {
  for (const char* name :
       {"PTFE.351.coeff.csv", "PTFE.532.coeff.csv", "PTFE.633.coeff.csv", "PTFE.1064.coeff.csv", "PTFE.coeff.csv"}) {
    const std::string file = published(name);
    if (file.empty()) GTEST_SKIP() << absent(name);
    std::string bytes = contents(file);
    std::erase(bytes, '\r');
    const Model model = load_model(file);
    EXPECT_EQ(to_coefficients_csv(model), bytes) << name;
    EXPECT_EQ(coefficient_count(model), std::string(name) == "PTFE.coeff.csv" ? 660 : 330);
    EXPECT_EQ(orders(model), (Orders{7, 4}));
  }
}

TEST(Coefficients, ReadBackAreTheSameBits) {
  Model model;
  model.family = Family::germer2017;
  std::mt19937_64 engine(2);
  std::lognormal_distribution<double> size(0, 20);
  for (Block& block : blocks(Family::germer2017, Orders{7, 4})) {
    FittedBlock fitted;
    for (std::size_t i = 0; i < block.modes.size(); ++i)
      fitted.coefficients.push_back(i % 2 ? -size(engine) : size(engine));
    fitted.block = std::move(block);
    model.blocks.push_back(std::move(fitted));
  }
  const Model read = coefficients_in(to_coefficients_csv(model));
  ASSERT_EQ(read.blocks.size(), model.blocks.size());
  for (std::size_t b = 0; b < read.blocks.size(); ++b)
    EXPECT_EQ(read.blocks[b].coefficients, model.blocks[b].coefficients);
}

TEST(Coefficients, ThatAreWrongAreRefusedWithFileLineAndValue) {
  const std::string good = "1, 1, 0, 0, 0, 0, 0, 2.5\n";
  const std::pair<std::string, std::vector<std::string>> cases[] = {
      {"1, 2, 1, 1, 3, 1, 0, 1", {"c.csv:2: ", "(1, 1, 3, 1)", "|k| must not exceed n"}},
      {"1, 2, 3, 1, 2, 1, 0, 1", {"c.csv:2: ", "(3, 1, 2, 1)", "n - k must be even"}},
      {"1, 2, 1, 3, 1, 2, 0, 1", {"c.csv:2: ", "(1, 3, 1, 2)", "m - l must be even"}},
      {"1, 1, 1, 3, 1, 1, 0, 1", {"c.csv:2: ", "(1, 3, 1, 1)", "n must not be less than m"}},
      {"1, 2, 2, 0, 0, 2, 0, 1", {"c.csv:2: ", "(2, 0, 0, 2)", "columns 3 and 4 look exchanged"}},
      {"2, 1, 0, 0, 0, 0, 0, 1", {"c.csv:2: element 21 is below the diagonal", "12"}},
      {"1, 5, 0, 0, 0, 0, 0, 1", {"c.csv:2: j = 5 is not in 1...4"}},
      {"1, 1, 0, 0, 0, 0, 10, 1", {"c.csv:2: p = 10 is not in 0...9"}},
      {"1, 1, 0, 0, 0, 0, -1, 1", {"c.csv:2: p = -1 is not in 0...9"}},
      {"1, 1, 42, 0, 0, 0, 0, 1", {"c.csv:2: n = 42 is not in 0...40"}},
      {"1, 1, 99999999999, 0, 0, 0, 0, 1", {"c.csv:2: n: '99999999999' is out of range"}},
      {"1, 1, 0.5, 0, 0, 0, 0, 1", {"c.csv:2: n: '0.5' is not an integer"}},
      {"1, 1, 2, 0, 0, 0, 0, x", {"c.csv:2: a: 'x' is not a number"}},
      {"1, 1, 2, 0, 0, 0, 0, inf", {"c.csv:2: a: 'inf' is not a finite number"}},
      {"1, 1, 2, 0, 0, 0, 0", {"c.csv:2: 8 fields (i ... a) are needed, there are 7"}},
      {good, {"c.csv:2: mode 11 (n, m, k, l) = (0, 0, 0, 0) with p = 0 is given a second time"}},
  };
  for (const auto& [row, parts] : cases)
    EXPECT_TRUE(says(complaint([&, &line = row] { coefficients_in(good + line); }), parts));
  EXPECT_TRUE(says(complaint([&] { coefficients_in(""); }), {"c.csv: empty file"}));
  EXPECT_TRUE(says(complaint([&] { coefficients_in(own_header); }), {"c.csv:1: 8 fields", "there are 21"}));
  EXPECT_TRUE(says(complaint([&] { coefficients_in("2, 2, 0, 0, 0, 0, 0, 1"); }), {"c.csv: ", "element 11"}));
}

TEST(Coefficients, WithTheirRadialOrdersExchangedAreRecognised) {
  const std::string file = published("PTFE.532.coeff.csv");
  if (file.empty()) GTEST_SKIP() << absent("PTFE.532.coeff.csv");
  std::istringstream rows(contents(file));
  std::string exchanged, row;
  while (std::getline(rows, row)) {
    std::swap(row[6], row[9]);  // one digit each
    exchanged += row + "\n";
  }
  EXPECT_TRUE(says(complaint([&] { coefficients_in(exchanged); }), {"c.csv:3: ", "columns 3 and 4 look exchanged"}));
}

TEST(Coefficients, HaveNoPlaceForOtherMappingsOrAnisotropy) {
  Model model = coefficients_in("1, 1, 0, 0, 0, 0, 0, 2.5\n");
  model.mapping = DiscMapping::projected;
  EXPECT_THROW(to_coefficients_csv(model), std::invalid_argument);
  model.mapping = DiscMapping::lambert;
  model.family = Family::anisotropic;
  EXPECT_THROW(to_coefficients_csv(model), std::invalid_argument);
}

// ---- docs/formats.md ------------------------------------------------------------------------------------------------

TEST(Formats, AreAsTheirExamplesInTheDocumentationShow) {
  std::istringstream page(contents(in_checkout("docs/formats.md")));
  std::vector<std::string> examples;
  bool inside_example = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("```")) {
      inside_example = line == "```csv" || line == "```json";
      if (inside_example) examples.emplace_back();
    } else if (inside_example) {
      examples.back() += line + "\n";
    }
  }
  ASSERT_EQ(examples.size(), 5U);
  const auto samples = samples_in(examples[0]);
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_TRUE(same({samples[0]}, {samples[1]}));
  EXPECT_EQ(to_coefficients_csv(coefficients_in(examples[1])), examples[1]);
  EXPECT_EQ(to_json(model_from_json(examples[2], "m.json")), examples[2]);
  std::istringstream references(examples[3]), readings(examples[4]);
  const ReferenceFile file = read_references(references, "r.csv");
  ASSERT_EQ(file.references.size(), 2U);
  EXPECT_DOUBLE_EQ(file.references[0].readings[0], 0.51 / 1.01);
  RawReader reader(readings, "d.csv", {2, 1});
  RawMeasurement measurement;
  ASSERT_TRUE(reader.next(measurement));
  EXPECT_EQ(measurement.readings, (std::vector<double>{3.1e-05, 2.9e-05}));
  EXPECT_FALSE(reader.next(measurement));
}

}  // namespace
}  // namespace mmbrdf
