// SPDX-License-Identifier: BSD-3-Clause
// Mitsuba's .pbsdf: Mueller matrices over half and difference angles. The writer here makes the directions of each node
// by its own vectors, asks a model for the matrix there, and lets the library's frames bring it to the scattering plane.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "given/foreign.hpp"
#include "given/random_model.hpp"
#include "given/tensor_file.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/formats/export.hpp"
#include "mmbrdf/model/prepared.hpp"

namespace mmbrdf {
namespace {

/// Source and detector; the angles are rounded to single precision, as the file has them.
struct Beams {
  Vector i, o, perpendicular;
};

Beams beams(double phi_d, double theta_d, double theta_h) {
  const Vector h = at(theta_h, 0), b = {0, 1, 0}, t = cross(b, h);
  const Vector r = sum(std::cos(phi_d), t, std::sin(phi_d), b);
  return {sum(std::sin(theta_d), r, std::cos(theta_d), h), sum(-std::sin(theta_d), r, std::cos(theta_d), h),
          unit(cross(r, h))};
}

/// M about the scattering plane with S4 = right − left. Where i = o the plane is that of r and h.
Mueller stored(const PreparedModel& model, const Beams& beams) {
  const Geometry g{direction(beams.i), direction(beams.o)};
  Mueller m = model.evaluate(g);
  if (std::abs(1 - dot(beams.i, beams.o)) > 1e-9) {
    m = change_frame(m, g, Frame::xy, Frame::scattering_plane);
  } else {
    m = change_frame(m, g, Frame::xy, Frame::sp);
    const auto turn = [&](const Vector& k, double phi) {  // from s to the axis of the file
      const Vector s = unit(
          cross({0, 0, 1}, {k[2] > 0 ? std::cos(phi) : -std::cos(phi), k[2] > 0 ? std::sin(phi) : -std::sin(phi), 0}));
      return std::atan2(dot(beams.perpendicular, cross(k, s)), dot(beams.perpendicular, s));
    };
    m = rotated(m, turn(beams.o, g.reflected.phi), turn(sum(-1, beams.i, 0, beams.i), g.incident.phi));
  }
  for (int k = 0; k < 3; ++k) m(3, k) = -m(3, k), m(k, 3) = -m(k, 3);
  return m;
}

struct Axes {
  std::vector<double> phi_d, theta_d, theta_h;
};

Axes some_axes() {
  Axes axes;
  for (int p = -4; p <= 4; ++p) axes.phi_d.push_back(static_cast<float>(p * 45 * degree));
  for (const double d : {0.0, 8.0, 33.0, 61.0, 90.0}) axes.theta_d.push_back(static_cast<float>(d * degree));
  for (const double h : {0.0, 5.0, 30.0, 52.0, 90.0}) axes.theta_h.push_back(static_cast<float>(h * degree));
  return axes;
}

std::vector<TensorArray> fields(const Model& model, const Axes& axes, const std::vector<std::uint16_t>& nm) {
  std::vector<double> values;
  for (const double p : axes.phi_d)
    for (const double d : axes.theta_d)
      for (const double h : axes.theta_h)
        for (const std::uint16_t wavelength : nm) {
          const Beams b = beams(p, d, h);
          Mueller m{};
          if (b.i[2] > 1e-5 && b.o[2] > 1e-5) m = stored(prepare(model, wavelength * 1e-3), b);
          values.insert(values.end(), m.elements.begin(), m.elements.end());
        }
  std::string wavelengths;
  for (const std::uint16_t one : nm) append(wavelengths, one);
  const auto axis = [](const std::string& name, const std::vector<double>& angles) {
    return TensorArray{name, 10, {1, angles.size()}, singles(angles)};
  };
  return {
      axis("phi_d", axes.phi_d), axis("theta_d", axes.theta_d), axis("theta_h", axes.theta_h),
      TensorArray{"wvls", 3, {nm.size()}, wavelengths},
      TensorArray{
          "M", 10, {axes.phi_d.size(), axes.theta_d.size(), axes.theta_h.size(), nm.size(), 4, 4}, singles(values)}};
}

/// Elements are stored in single precision, 6e-8 of the largest.
constexpr double single = 5e-7;

void expect_matrices(const std::vector<Sample>& samples, const Model& model) {
  for (const Sample& s : samples) {
    const Mueller expected = prepare(model, s.wavelength).evaluate(s.geometry);
    for (std::size_t e = 0; e < 16; ++e)
      ASSERT_NEAR(s.f11 * s.normalized.elements[e], expected.elements[e], single)
          << element_name(e) << " at " << s.geometry.incident.theta / degree << "; "
          << s.geometry.reflected.theta / degree << ',' << s.geometry.reflected.phi / degree;
  }
}

TEST(Pbsdf, GivesTheMatricesOfTheModelInTheFrameXy) {
  const Folder folder;
  for (const Model& model : {material("ptfe"), random_model(Family::isotropic, {7, 4}, 0, 3)}) {
    put(folder / "x.bin", tensor_file(fields(model, some_axes(), {450, 633})));
    const ForeignRead read = read_foreign_file(folder / "x.bin");
    EXPECT_GE(read.samples.size(), 100U);
    expect_matrices(read.samples, model);
    EXPECT_TRUE(says(read.understood, {"a Mitsuba .pbsdf file: 9 phi_d, 5 theta_d, 5 theta_h at 450 and 633 nm",
                                       "S4 > 0 right-handed", "of 400 matrices at or below the horizon passed over"}));
  }
}

TEST(Pbsdf, CountsNodesThatWereNotMeasured) {
  const Folder folder;
  std::vector<TensorArray> all = fields(material("ptfe-532"), some_axes(), {532});
  const float nan = std::nanf("");
  std::memcpy(all[4].data.data() + 64 * 6 + 4, &nan, 4);  // theta_d 8, theta_h 5
  all[4].data.replace(64, 64, std::string(64, '\0'));     // theta_d 0, theta_h 5: zeros
  put(folder / "x", tensor_file(all));
  EXPECT_TRUE(says(read_foreign_file(folder / "x").understood, {"2 of 200 matrices not measured, passed over"}));
}

TEST(Pbsdf, IsRefusedInOneLineIfItIsCutOffOrWrong) {
  const Folder folder;
  const std::string path = folder / "x";
  const std::vector<TensorArray> good = fields(material("ptfe-532"), some_axes(), {532});
  put(path, tensor_file(good));
  expect_refused_where_cut(path);
  EXPECT_TRUE(says(foreign_refusal(path, {0.532}), {"x: says its wavelengths itself: leave out --wavelength 532 nm"}));
  const auto refusal = [&](const std::function<void(std::vector<TensorArray>&)>& change) {
    std::vector<TensorArray> changed = good;
    change(changed);
    put(path, tensor_file(changed));
    return foreign_refusal(path);
  };
  EXPECT_TRUE(
      says(refusal([](auto& f) { f[4].shape[0] = std::uint64_t(1) << 62; }), {"field M: shape [46", "cut off?"}));
  EXPECT_TRUE(says(refusal([](auto& f) { f[4].shape = {9, 5, 5, 4, 4}; }), {"field M: shape", "the axes ask for"}));
  EXPECT_TRUE(says(refusal([](auto& f) { f[0].shape = {3, 3}; }), {"field phi_d", "not that of one axis"}));
  EXPECT_TRUE(says(refusal([](auto& f) { f[0].shape = {0}; }), {"field phi_d", "is empty"}));
  EXPECT_TRUE(says(refusal([](auto& f) {
                     f[2].data = singles({0, 30, 45, 60, 90});
                   }),
                   {"theta_h: 30 is not in [0, 1.5708]"}));
  EXPECT_TRUE(says(refusal([](auto& f) { f[2].data = singles({0, 1, NAN, 1.2, 1.3}); }), {"theta_h: value 3, nan"}));
  EXPECT_TRUE(says(refusal([](auto& f) { f[3].type = 12; }), {"field wvls: type 12 cannot be read"}));
  EXPECT_TRUE(says(refusal([](auto& f) { f[3].name = "waves"; }), {"x: no field wvls"}));
  EXPECT_TRUE(says(refusal([](auto& f) {
                     f = {f[3]};
                     f[0].name = "other";
                   }),
                   {"a tensor file of other: neither"}));
  EXPECT_TRUE(says(refusal([](auto& f) { f[3].type = 0; }), {"field wvls: type 0 cannot be read"}));
  EXPECT_TRUE(says(refusal([](auto& f) { f[3].type = 9; }), {"field wvls: type 9 cannot be read"}));
  EXPECT_TRUE(says(refusal([](auto& f) { f[4].type = 5; }), {"field M: type 5, must be 10 or 11, floating point"}));
  EXPECT_TRUE(says(refusal([](auto& f) {
                     f[3].data.clear();
                     append(f[3].data, std::uint16_t{9});
                   }),
                   {"field wvls: 9 nm is no wavelength"}));
  EXPECT_TRUE(says(refusal([](auto& f) {
                     f[1].data = singles({0, 0.1, 0.1, 0.2, 0.3});
                   }),
                   {"field theta_d: value 3, 0.1", "does not rise"}));
  EXPECT_TRUE(says(refusal([](auto& f) {
                     f = {f[3]};
                     f[0].name = "";
                   }),
                   {"a tensor file of ", ": neither"}));
  std::string huge = tensor_file(good);
  huge[14] = huge[15] = huge[16] = huge[17] = '\xff';
  put(path, huge);
  EXPECT_TRUE(says(foreign_refusal(path), {"the header says 4294967295 fields"}));
}

/// As a renderer reads such a file: shapes and singles by name, and M linear between the nodes of each axis.
class Renderer {
 public:
  explicit Renderer(const std::string& bytes) {
    EXPECT_EQ(bytes.substr(0, 14), std::string("tensor_file\0\1\0", 14));
    std::size_t at = 14;
    const auto take = [&]<class Number>(Number value) {
      std::memcpy(&value, bytes.data() + at, sizeof value);
      at += sizeof value;
      return value;
    };
    for (std::uint32_t f = take(std::uint32_t{}); f > 0; --f) {
      const std::uint16_t length = take(std::uint16_t{});
      const std::string name = bytes.substr(at, length);
      at += length;
      const std::uint16_t dimensions = take(std::uint16_t{});
      const int type = take(std::uint8_t{});
      const std::uint64_t offset = take(std::uint64_t{});
      EXPECT_EQ(offset % 8, 0U);
      std::size_t count = 1;
      for (int d = 0; d < dimensions; ++d) count *= shapes[name].emplace_back(take(std::uint64_t{}));
      if (type == 10) {
        values[name].resize(count);
        std::memcpy(values[name].data(), bytes.data() + offset, 4 * count);
      } else {
        EXPECT_EQ(type, 3);
        whole.resize(count);
        std::memcpy(whole.data(), bytes.data() + offset, 2 * count);
      }
      end = std::max(end, offset + (type == 10 ? 4 : 2) * count);
    }
    EXPECT_EQ(end, bytes.size());
  }

  Mueller at(double phi_d, double theta_d, double theta_h, std::size_t w) const {
    Mueller sum{};
    const std::array asked{phi_d, theta_d, theta_h};
    std::array<std::size_t, 3> below{};
    std::array<double, 3> part{};
    for (std::size_t a = 0; a < 3; ++a) {
      const std::vector<float>& axis = values.at(std::array{"phi_d", "theta_d", "theta_h"}[a]);
      while (below[a] + 2 < axis.size() && static_cast<double>(axis[below[a] + 1]) < asked[a]) ++below[a];
      const double first = static_cast<double>(axis[below[a]]), last = static_cast<double>(axis[below[a] + 1]);
      part[a] = std::clamp((asked[a] - first) / (last - first), 0.0, 1.0);
    }
    const std::vector<std::uint64_t>& shape = shapes.at("M");
    for (std::size_t p : {0U, 1U})
      for (std::size_t d : {0U, 1U})
        for (std::size_t h : {0U, 1U}) {
          const double weight = (p ? part[0] : 1 - part[0]) * (d ? part[1] : 1 - part[1]) * (h ? part[2] : 1 - part[2]);
          const std::size_t node = ((below[0] + p) * shape[1] + below[1] + d) * shape[2] + below[2] + h;
          for (std::size_t e = 0; e < 16; ++e)
            sum.elements[e] += weight * static_cast<double>(values.at("M")[16 * (node * shape[3] + w) + e]);
        }
    return sum;
  }

  std::map<std::string, std::vector<std::uint64_t>> shapes;
  std::map<std::string, std::vector<float>> values;
  std::vector<std::uint16_t> whole;
  std::uint64_t end = 0;
};

std::string exported(const Export& table) {
  std::ostringstream out;
  table.write(out);
  return out.str();
}

TEST(Pbsdf, IsWrittenWithTheErrorThatItSays) {
  const Model model = material("ptfe");
  // The coarsest, and the one in which an rms of 0.02 % and at most 0.5 % of f11 up to 80 degrees were found by Mitsuba's
  // own interpolation.
  for (const auto& [wanted, shape] : {std::pair{2e-3, std::vector<std::uint64_t>{37, 19, 19, 2, 4, 4}},
                                      std::pair{2.5e-4, std::vector<std::uint64_t>{73, 46, 46, 2, 4, 4}}}) {
    const Export table(model, export_format("pbsdf"), {.wavelengths = {0.45, 0.633}, .error = wanted});
    const Renderer renderer(exported(table));
    EXPECT_EQ(renderer.shapes.at("M"), shape);
    EXPECT_EQ(renderer.whole, (std::vector<std::uint16_t>{450, 633}));
    EXPECT_TRUE(std::ranges::all_of(renderer.values.at("M"), [](float value) { return std::isfinite(value); }));
    std::mt19937_64 engine(7);
    std::uniform_real_distribution<double> part(0, 1);
    double squares = 0, largest = 0;
    long count = 0;
    const double lowest = std::cos(table.error().theta_max);
    for (std::size_t w : {0U, 1U}) {
      const PreparedModel prepared = prepare(model, w == 0 ? 0.45 : 0.633);
      for (int found = 0; found < 3000;) {
        const double p = (2 * part(engine) - 1) * std::numbers::pi, d = std::acos(std::sqrt(part(engine))),
                     h = std::acos(part(engine));
        const Beams b = beams(p, d, h);
        if (b.i[2] < lowest || b.o[2] < lowest) continue;
        ++found;
        const Mueller expected = stored(prepared, b), got = renderer.at(p, d, h, w);
        for (std::size_t e = 0; e < 16; ++e, ++count) {
          const double error = std::abs(got.elements[e] - expected.elements[e]) / expected(0, 0);
          squares += error * error;
          largest = std::max(largest, error);
        }
      }
    }
    // Other directions, more of them towards the horizon: the same to a factor of two.
    const double rms = std::sqrt(squares / static_cast<double>(count));
    EXPECT_LE(table.error().rms, wanted);
    EXPECT_LT(rms, 2 * table.error().rms);
    EXPECT_GT(rms, 0.5 * table.error().rms);
    EXPECT_LE(largest, 3 * table.error().largest);
    EXPECT_LE(largest, 10 * wanted + 5e-3);
  }
}

TEST(Pbsdf, ThatIsWrittenIsReadBackAsTheModel) {
  const Folder folder;
  for (const Model& model : {material("ptfe"), random_model(Family::isotropic, {4, 3}, 0, 3)}) {
    put(folder / "x", exported(Export(model, export_format("pbsdf"), {.wavelengths = {0.532}, .error = 10})));
    const ForeignRead read = read_foreign_file(folder / "x");
    const PreparedModel prepared = prepare(model, 0.532);
    EXPECT_GE(read.samples.size(), 4000U);
    // Axes are in single precision, 6e-8 of an angle of up to 3, and near the normal azimuths turn fast.
    for (const Sample& s : read.samples) ASSERT_NEAR(s.f11, prepared.f11(s.geometry), 2e-6 * std::abs(s.f11) + 1e-6);
  }
}

TEST(Pbsdf, IsNotWrittenOfWhatItCannotHold) {
  EXPECT_TRUE(says(export_refusal(material("ptfe"), "pbsdf", {.wavelengths = {0.4, 0.45, 0.5, 0.55, 0.6, 0.65}}),
                   {"6 wavelengths: Mitsuba reads at most 5"}));
  EXPECT_TRUE(
      says(export_refusal(material("ptfe"), "pbsdf", {.wavelengths = {0.5325}}), {"532.5 nm", "whole nanometres"}));
  EXPECT_TRUE(
      says(export_refusal(material("ptfe"), "pbsdf", {.wavelengths = {0.532, 0.532}}), {"532 nm is given twice"}));
  EXPECT_TRUE(says(export_refusal(material("ptfe"), "pbsdf", {.wavelengths = {0.5319999999, 0.532}}),
                   {"532 nm is given twice, to whole nanometres"}));
  EXPECT_TRUE(says(export_refusal(material("ptfe"), "pbsdf", {.error = 1e-9}),
                   {"the finest table, of 121 phi_d", "% asked for"}));
  EXPECT_TRUE(says(export_refusal(material("ptfe"), "pbsdf", {.channel = "f_ss"}), {"holds whole matrices"}));
  EXPECT_TRUE(says(export_refusal(random_model(Family::anisotropic, {2, 1}, 0, 1), "pbsdf", {.wavelengths = {0.5}}),
                   {"isotropic sample", "azimuth of the source"}));
  EXPECT_TRUE(
      says(export_refusal(random_model(Family::isotropic, {2, 1}, 1, 1), "pbsdf"), {"does not say its wavelengths"}));
  EXPECT_THROW(export_format_of("x.abc"), std::invalid_argument);
}

}  // namespace
}  // namespace mmbrdf
