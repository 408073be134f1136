// SPDX-License-Identifier: BSD-3-Clause
// Mitsuba's .pbsdf: Mueller matrices over half and difference angles. The writer here makes the directions of each node
// by its own vectors, asks a model for the matrix there, and lets the library's frames bring it to the scattering plane.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "given/foreign.hpp"
#include "given/random_model.hpp"
#include "given/tensor_file.hpp"
#include "mmbrdf/files/materials.hpp"
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
  std::string huge = tensor_file(good);
  huge[14] = huge[15] = huge[16] = huge[17] = '\xff';
  put(path, huge);
  EXPECT_TRUE(says(foreign_refusal(path), {"the header says 4294967295 fields"}));
}

}  // namespace
}  // namespace mmbrdf
