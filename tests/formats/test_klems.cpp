// SPDX-License-Identifier: BSD-3-Clause
// XML with the 145 directions of Klems' full basis, as Radiance 6.1 reads it.
#include <gtest/gtest.h>

#include <array>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "given/foreign.hpp"
#include "given/random_model.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/quantities/quantities.hpp"

namespace mmbrdf {
namespace {

constexpr double pi = std::numbers::pi;
constexpr std::array<double, 10> edges{0, 5, 15, 25, 35, 45, 55, 65, 75, 90};  // degrees
constexpr std::array<int, 9> around{1, 8, 16, 20, 24, 24, 24, 16, 12};

/// Which line is that of light from a direction, and which place in it that of a viewer: in the renderer the light has
/// its own azimuth, the viewer one that is turned by 180 degrees.
std::size_t patch(const Vector& v) {
  const double polar = std::acos(v[2]) / degree;
  double azimuth = std::atan2(v[1], v[0]) / degree;
  if (azimuth < 0) azimuth += 360;
  std::size_t row = 0, before = 0;
  while (row + 1 < around.size() && edges[row + 1] <= polar) before += std::size_t(around[row++]);
  return before + std::size_t(azimuth / 360 * around[row] + 0.5) % std::size_t(around[row]);
}
std::size_t line_of(const Vector& light) { return patch(light); }
std::size_t place_of(const Vector& viewer) { return patch({-viewer[0], -viewer[1], viewer[2]}); }

std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) return "";
  return text.substr(at + from.size(), text.find(to, at) - at - from.size());
}

std::string exported(const Export& table) {
  std::ostringstream out;
  table.write(out);
  return out.str();
}

std::vector<double> scattering_data(const std::string& xml) {
  std::istringstream numbers(between(xml, "<ScatteringData>", "</ScatteringData>"));
  std::vector<double> values;
  for (double value = 0; numbers >> value;) values.push_back(value);
  EXPECT_EQ(values.size(), 145U * 145);
  return values;
}

using Value = std::function<double(const Vector& light, const Vector& viewer)>;

Value channel(const Model& model, const std::string& name) {
  return [prepared = prepare(model, 0.532), name](const Vector& light, const Vector& viewer) {
    const auto angles = [](const Vector& v) { return Direction{std::acos(v[2]), std::atan2(v[1], v[0])}; };
    const Mueller m = prepared.evaluate({angles(light), angles(viewer)}, Frame::sp);
    return name == "f11" ? m(0, 0) : quantity(name).value(m, {});
  };
}

/// Directions within the patch of one, each of which stands for the same projected solid angle.
std::vector<Vector> within(const Vector& v, int parts) {
  const double polar = std::acos(v[2]) / degree;
  std::size_t row = 0;
  while (row + 1 < around.size() && edges[row + 1] <= polar) ++row;
  const double width = 360.0 / around[row], centre = std::round(std::atan2(v[1], v[0]) / degree / width) * width;
  const double low = std::pow(std::sin(edges[row] * degree), 2), high = std::pow(std::sin(edges[row + 1] * degree), 2);
  std::vector<Vector> result;
  for (int t = 0; t < parts; ++t)
    for (int p = 0; p < parts; ++p)
      result.push_back(at(std::asin(std::sqrt(low + (t + 0.5) / parts * (high - low))),
                          (centre + ((p + 0.5) / parts - 0.5) * width) * degree));
  return result;
}

TEST(Klems, IsWrittenAsMeansOverThePatchesOfLightAndViewer) {
  const Model model = material("ptfe-532");
  // A channel that changes if light and viewer change places tells lines from places.
  const Value f = channel(model, "f_sp");
  const std::vector<double> values =
      scattering_data(exported(Export(model, export_format_of("x.xml"), {.channel = "f_sp"})));
  double exchanged = 0;
  for (const auto& [light, viewer] :
       {std::pair{at(70 * degree, 0.1), at(20 * degree, 2)}, std::pair{at(2 * degree, 1), at(60 * degree, -2)},
        std::pair{at(80 * degree, -1), at(40 * degree, 2.5)}, std::pair{at(50 * degree, 3), at(0, 0)}}) {
    double mean = 0;
    constexpr int parts = 12;
    for (const Vector& i : within(light, parts))
      for (const Vector& o : within(viewer, parts)) mean += f(i, o);
    mean /= std::pow(parts, 4);
    // The midpoint rule with 12 parts is off by some 1e-4 where the outermost patch bends it.
    EXPECT_NEAR(values[line_of(light) * 145 + place_of(viewer)], mean, 2e-4 * mean);
    exchanged = std::max(exchanged, std::abs(values[line_of(viewer) * 145 + place_of(light)] / mean - 1));
  }
  EXPECT_GT(exchanged, 3e-3);
}

TEST(Klems, IsWrittenWithTheErrorThatItSays) {
  const Model model = material("ptfe-532");
  const Export table(model, export_format("klems"), {});
  const Value f = channel(model, "f11");
  const std::vector<double> values = scattering_data(exported(table));
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> part(0, 1);
  const double reach = std::sin(table.error().theta_max);
  const auto random = [&] {
    const double r = reach * std::sqrt(part(engine)), phi = 2 * pi * part(engine);
    return Vector{r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - r * r)};
  };
  double squares = 0;
  constexpr int count = 4000;
  for (int n = 0; n < count; ++n) {
    const Vector light = random(), viewer = random();
    squares += std::pow(values[line_of(light) * 145 + place_of(viewer)] / f(light, viewer) - 1, 2);
  }
  // Other directions of the same distribution.
  EXPECT_NEAR(std::sqrt(squares / count), table.error().rms, 0.1 * table.error().rms);
  EXPECT_TRUE(says(table.understood(), {"the width of the patches adds", "means over pairs of the 145 patches"}));
}

TEST(Klems, ThatIsWrittenSaysWhatItsReaderLooksFor) {
  Model model = material("ptfe-532");
  model.name = "a < b & c";
  const std::string xml = exported(Export(model, export_format("klems"), {}));
  for (const char* part :
       {"<Wavelength unit=\"Integral\">Visible</Wavelength>", "<FileType>BSDF</FileType>",
        "<WavelengthDataDirection>Reflection Back</WavelengthDataDirection>",
        "<IncidentDataStructure>Columns</IncidentDataStructure>",
        "<ColumnAngleBasis>LBNL/Klems Full</ColumnAngleBasis>", "<RowAngleBasis>LBNL/Klems Full</RowAngleBasis>",
        "<Name>a &lt; b &amp; c, f11 at 532 nm</Name>"})
    EXPECT_NE(xml.find(part), std::string::npos) << part;
  EXPECT_EQ(xml.find("nm\""), std::string::npos);  // no unit but Integral
}

TEST(Klems, ThatIsWrittenHasTheMirrorDirectionOfALineOnTheDiagonal) {
  const Model model = material("ptfe-532");
  const Value f = channel(model, "f11");
  const std::vector<double> values = scattering_data(exported(Export(model, export_format("klems"), {})));
  for (const double theta : {50.0, 60.0, 70.0}) {
    const Vector light = at(theta * degree, 0), mirrored = at(theta * degree, pi);
    const double diagonal = values[line_of(light) * 146];
    // A value in the middle of both patches is nearly the mean over them; that of the way back is another.
    EXPECT_NEAR(diagonal, f(light, mirrored), 0.03 * diagonal) << theta;
    EXPECT_GT(std::abs(f(light, light) / f(light, mirrored) - 1), 0.1) << theta;
  }
}

TEST(Klems, IsWrittenOfADiffuserAsAConstant) {
  for (const double value :
       scattering_data(exported(Export(diffuser({0.3}), export_format("klems"), {.wavelengths = {0.5}}))))
    ASSERT_NEAR(value, 0.3, 1e-8);
}

TEST(Klems, IsNotWrittenOfWhatItCannotHold) {
  EXPECT_TRUE(says(export_refusal(material("ptfe"), "klems", {.wavelengths = {0.45, 0.55}}),
                   {"450 and 550 nm: a Klems XML file has one wavelength"}));
  EXPECT_TRUE(says(export_refusal(material("ptfe-532"), "klems", {.channel = "purity"}), {"channel purity"}));
}

}  // namespace
}  // namespace mmbrdf
