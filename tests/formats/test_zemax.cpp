// SPDX-License-Identifier: BSD-3-Clause
// Zemax tabular BSDF: scatter angles about the specular ray, azimuth 180 pointing away from the normal.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "given/foreign.hpp"
#include "given/random_model.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/quantities/quantities.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"

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

TEST(Zemax, PassesOverRepeatsThatSayTheSameAlone) {
  const Folder folder;
  std::string text = file("PlaneSymmetrical", {0}, {0, 60, 120, 180}, isotropic);
  put(folder / "x", text);
  const std::size_t count = read_foreign_file(folder / "x", {0.633}).samples.size();
  const std::size_t second_azimuth =
      text.find('\n', text.find("TIS 0.9\n") + 8) + 1;  // of the first incidence, radial 0
  put(folder / "x", text.replace(second_azimuth, text.find(' ', second_azimuth + 1) - second_azimuth, " 0.75"));
  const ForeignRead read = read_foreign_file(folder / "x", {0.633});
  EXPECT_EQ(read.samples.size(), count + 1);
  EXPECT_TRUE(std::ranges::any_of(read.samples, [](const Sample& s) { return s.f11 == 0.75; }));
  EXPECT_TRUE(says(read.understood, {"repeats of a direction passed over: 8"}));
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
  EXPECT_TRUE(says(refusal("AngleOfIncidence\t3", "AngleOfIncidence\t2.5"),
                   {"x:8: AngleOfIncidence: 2.5 is no number of angles that the file can hold"}));
  EXPECT_TRUE(says(refusal("Monochrome\nDataBegin", "Colours\nDataBegin"), {"keyword 'Colours' is not known"}));
  EXPECT_TRUE(says(refusal("TIS 0.9\n", "TIS nan\n"), {"x:17: TIS: 'nan'"}));
  EXPECT_TRUE(says(refusal("DataEnd", "TIS"), {"'TIS' in place of DataEnd behind the data of 3 incidences: cut off?"}));
  EXPECT_TRUE(says(refusal("ScatterAzimuth\t4\n 0.000000 90.000000 180.000000 270.000000", "# none"),
                   {"no angles of ScatterAzimuth before the data: cut off?"}));
}

std::string exported(const Export& table) {
  std::ostringstream out;
  table.write(out);
  return out.str();
}

/// As optical design reads such a file: lists of angles by keyword, then a line TIS and a line for each azimuth; linear
/// between the nodes, the other half as the mirror image where the file says so.
class Design {
 public:
  explicit Design(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line) && line != "DataBegin";) {
      std::istringstream words(line);
      std::string key, value;
      if (line.empty() || line[0] == '#' || !(words >> key >> value)) continue;
      said[key] = value;
      if (key != "SampleRotation" && key != "AngleOfIncidence" && !key.starts_with("Scatter")) continue;
      if (key == "ScatterType") continue;
      std::getline(lines, line);
      std::istringstream list(line);
      for (double angle = 0; list >> angle;) angles[key].push_back(angle);
      EXPECT_EQ(angles[key].size(), std::stoul(value)) << key;
    }
    std::string word;
    for (std::size_t i = 0; i < angles["AngleOfIncidence"].size(); ++i) {
      EXPECT_TRUE(lines >> word && word == "TIS" && lines >> tis.emplace_back());
      for (std::size_t n = angles["ScatterAzimuth"].size() * angles["ScatterRadial"].size(); n > 0; --n)
        EXPECT_TRUE(lines >> values.emplace_back());
    }
    EXPECT_TRUE(lines >> word && word == "DataEnd");
  }

  double operator()(double theta_i, const Vector& o) const {
    const Vector specular = at(-theta_i, 0), up = at(std::numbers::pi / 2 - theta_i, 0), side{0, 1, 0};
    double azimuth = std::atan2(dot(o, side), dot(o, up)) / degree;
    if (azimuth < 0) azimuth = said.at("Symmetry") == "PlaneSymmetrical" ? -azimuth : azimuth + 360;
    const auto i = place("AngleOfIncidence", theta_i / degree), a = place("ScatterAzimuth", azimuth),
               r = place("ScatterRadial", std::acos(std::min(1.0, dot(o, specular))) / degree);
    double result = 0;
    for (const std::size_t x : {0U, 1U})
      for (const std::size_t y : {0U, 1U})
        for (const std::size_t z : {0U, 1U})
          result += (x ? i.second : 1 - i.second) * (y ? a.second : 1 - a.second) * (z ? r.second : 1 - r.second) *
                    values[((i.first + x) * angles.at("ScatterAzimuth").size() + a.first + y) *
                               angles.at("ScatterRadial").size() +
                           r.first + z];
    return result;
  }

  std::map<std::string, std::string> said;
  std::map<std::string, std::vector<double>> angles;
  std::vector<double> tis, values;

 private:
  std::pair<std::size_t, double> place(const char* name, double angle) const {
    const std::vector<double>& list = angles.at(name);
    std::size_t below = 0;
    while (below + 2 < list.size() && list[below + 1] < angle) ++below;
    return {below, (angle - list[below]) / (list[below + 1] - list[below])};
  }
};

TEST(Zemax, IsWrittenWithTheErrorThatItSays) {
  const Model model = material("ptfe-532");
  const PreparedModel prepared = prepare(model, 0.532);
  for (const auto& [wanted, radials] : {std::pair{2e-3, 37U}, std::pair{5e-4, 73U}}) {
    const Export table(model, export_format("zemax"), {.error = wanted});
    const Design design(exported(table));
    EXPECT_EQ(design.said.at("Symmetry"), "PlaneSymmetrical");
    EXPECT_EQ(design.said.at("ScatterType"), "BRDF");
    EXPECT_EQ(design.angles.at("ScatterRadial").size(), radials);  // steps of at most 5 degrees, whatever the error
    std::mt19937_64 engine(5);
    std::uniform_real_distribution<double> part(0, 1);
    const double reach = std::sin(table.error().theta_max);
    double squares = 0, largest = 0;
    constexpr int count = 4000;
    for (int n = 0; n < count; ++n) {
      const double ti = std::asin(reach * std::sqrt(part(engine))), tr = std::asin(reach * std::sqrt(part(engine))),
                   phi = 2 * std::numbers::pi * part(engine);
      const double error = std::abs(design(ti, at(tr, phi)) / prepared.f11({{ti, 0}, {tr, phi}}) - 1);
      squares += error * error;
      largest = std::max(largest, error);
    }
    // Other directions of the same distribution; a few, of forward scattering at grazing angles, have much of it.
    EXPECT_NEAR(std::sqrt(squares / count), table.error().rms, 0.25 * table.error().rms);
    EXPECT_LT(largest, 2 * table.error().largest);
    EXPECT_LE(table.error().rms, wanted);
  }
}

TEST(Zemax, IsWrittenOfOneChannel) {
  const Folder folder;
  const Model model = material("ptfe-532");
  put(folder / "x", exported(Export(model, export_format("zemax"), {.channel = "f_sp", .error = 1})));
  const PreparedModel prepared = prepare(model, 0.532);
  for (const Sample& s : read_foreign_file(folder / "x", {0.532}).samples) {
    // Along the normal, which is no node of the radial angles but of few, it turns with the azimuth.
    if (std::min(s.geometry.incident.theta, s.geometry.reflected.theta) < 1e-6) continue;
    ASSERT_NEAR(s.f11, quantity("f_sp").value(prepared.evaluate(s.geometry, Frame::sp), {}), 1e-7 * s.f11);
  }
}

TEST(Zemax, ThatIsWrittenHasTheReflectanceOfEachIncidence) {
  const Model model = material("ptfe-532");
  const Design design(exported(Export(model, export_format("zemax"), {})));
  for (std::size_t i = 0; i < design.tis.size(); ++i) {
    const double theta = design.angles.at("AngleOfIncidence")[i] * degree;
    EXPECT_NEAR(design.tis[i], directional_hemispherical_reflectance(model, 0.532, {theta, 0}), 1e-8);  // eight digits
    // A reader that scales the table to it by its own sum over nodes, linear between them, changes it by less than 1 %.
    double sum = 0;
    constexpr int parts = 90;
    for (int t = 0; t < parts; ++t)
      for (int p = 0; p < 2 * parts; ++p) {
        const double tr = (t + 0.5) * 90 / parts * degree, phi = (p + 0.5) * 180 / parts * degree;
        sum += design(theta, at(tr, phi)) * std::sin(tr) * std::cos(tr) * std::pow(90.0 / parts * degree, 2) * 2;
      }
    EXPECT_NEAR(sum, design.tis[i], 0.01 * design.tis[i]);
  }
}

TEST(Zemax, ThatIsWrittenIsReadBackAsTheModelUpToTheHorizon) {
  const Folder folder;
  for (const Model& model : {material("ptfe-532"), random_model(Family::isotropic, {4, 3}, 0, 3)}) {
    put(folder / "x", exported(Export(model, export_format("zemax"), {.wavelengths = {0.532}, .error = 10})));
    const ForeignRead read = read_foreign_file(folder / "x", {0.532});
    const PreparedModel prepared = prepare(model, 0.532);
    EXPECT_GE(read.samples.size(), 10000U);
    for (const Sample& s : read.samples) ASSERT_NEAR(s.f11, prepared.f11(s.geometry), 1e-7 * std::abs(s.f11) + 1e-9);
  }
}

TEST(Zemax, LeavesOutNoHalfThatIsOther) {
  for (const Family family : {Family::isotropic, Family::germer2017}) {
    const PreparedModel prepared = prepare(random_model(family, {5, 4}, 0, 3), 0.532);
    for (const auto& [ti, tr, phi] :
         {std::array{0.3, 1.1, 0.7}, std::array{1.4, 0.2, 2.1}, std::array{0.9, 0.9, 3.0}}) {
      const Mueller one = prepared.evaluate({{ti, 0}, {tr, phi}}, Frame::sp),
                    other = prepared.evaluate({{ti, 0}, {tr, -phi}}, Frame::sp);
      for (const char* channel : {"f_ss", "f_sp", "f_ps", "f_pp"})
        EXPECT_NEAR(quantity(channel).value(one, {}), quantity(channel).value(other, {}), 1e-12);  // rounding
      EXPECT_NEAR(one(0, 0), other(0, 0), 1e-12);
    }
  }
}

TEST(Zemax, IsAsymmetricalOfAChannelThatHasTwoSides) {
  const PreparedModel prepared = prepare(handed(), 0.5);
  const Export table(handed(), export_format("zemax"), {.wavelengths = {0.5}, .channel = "f_ss", .error = 1});
  EXPECT_TRUE(says(table.understood(), {"Asymmetrical, f_ss"}));
  const Design design(exported(table));
  EXPECT_EQ(design.said.at("Symmetry"), "Asymmetrical");
  EXPECT_EQ(design.angles.at("ScatterAzimuth").back(), 360);
  double sides = 0;
  for (const double phi : {0.7, 2.0, 2.9}) {
    double found[2];
    for (const int side : {0, 1}) {
      const double signed_phi = side == 0 ? phi : -phi;
      const Mueller m = prepared.evaluate({{0.6, 0}, {0.9, signed_phi}}, Frame::sp);
      found[side] = design(0.6, at(0.9, signed_phi));
      EXPECT_NEAR(found[side], quantity("f_ss").value(m, {}), 3e-3 * m(0, 0));  // steps of 5 degrees
    }
    sides = std::max(sides, std::abs(found[0] / found[1] - 1));
  }
  EXPECT_GT(sides, 0.03);
  const Export f11(handed(), export_format("zemax"), {.wavelengths = {0.5}, .error = 1});
  EXPECT_EQ(Design(exported(f11)).said.at("Symmetry"), "PlaneSymmetrical");  // f11 has no sides
}

TEST(Zemax, IsNotWrittenOfWhatItCannotHold) {
  EXPECT_TRUE(says(export_refusal(material("ptfe"), "zemax", {.wavelengths = {0.45, 0.55}}),
                   {"450 and 550 nm: a Monochrome Zemax file has one wavelength"}));
  EXPECT_TRUE(says(export_refusal(material("ptfe-532"), "zemax", {.channel = "entropy"}), {"channel entropy"}));
  EXPECT_TRUE(says(export_refusal(material("ptfe-532"), "zemax", {.error = 1e-9}), {"steps of 1.25 degrees"}));
  EXPECT_TRUE(says(export_refusal(random_model(Family::anisotropic, {2, 1}, 0, 1), "zemax", {.wavelengths = {0.5}}),
                   {"isotropic sample"}));
}

}  // namespace
}  // namespace mmbrdf
