// SPDX-License-Identifier: BSD-3-Clause
/// Measurements in the formats of other programs: functions to fill such files with, and what reading them gives. The
/// files themselves are written by each test from the format's description, with vectors of its own.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "given/files.hpp"
#include "mmbrdf/formats/export.hpp"
#include "mmbrdf/formats/foreign.hpp"

namespace mmbrdf {

using Vector = std::array<double, 3>;

inline constexpr double degree = std::numbers::pi / 180;

inline Vector at(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}
inline double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Vector sum(double x, const Vector& a, double y, const Vector& b) {
  return {x * a[0] + y * b[0], x * a[1] + y * b[1], x * a[2] + y * b[2]};
}
inline Vector unit(const Vector& a) { return sum(1 / std::sqrt(dot(a, a)), a, 0, a); }

/// Of the directions to source and detector, in sr⁻¹: not reciprocal, and another number in each mirror image.
using Brdf = std::function<double(const Vector& i, const Vector& o)>;
inline double oriented(const Vector& i, const Vector& o) {
  return 0.3 + 0.05 * i[0] + 0.07 * o[1] + 0.03 * i[1] * o[2] - 0.02 * o[0] * i[2] + 0.01 * i[2];
}
/// The same if the sample is turned, but neither reciprocal nor mirror-symmetric.
inline double isotropic(const Vector& i, const Vector& o) {
  const double out_of_plane = i[0] * o[1] - i[1] * o[0], in_plane = i[0] * o[0] + i[1] * o[1];
  return 0.3 + 0.1 * i[2] + 0.06 * out_of_plane + 0.04 * in_plane - 0.05 * o[2] * o[2];
}

struct ForeignRead {
  std::vector<Sample> samples;
  std::string understood;
};

inline ForeignRead read_foreign_file(const std::string& path, const std::vector<double>& wavelengths = {}) {
  ForeignFile file(path, {wavelengths});
  ForeignRead result;
  file.read(
      [&](std::span<const Sample> some) { result.samples.insert(result.samples.end(), some.begin(), some.end()); });
  for (const Sample& sample : result.samples) EXPECT_TRUE((~not_measured(sample) & ~file.measured()).none());
  require_valid(result.samples);
  result.understood = file.understood();
  return result;
}

inline std::string foreign_refusal(const std::string& path, const std::vector<double>& wavelengths = {}) {
  return complaint([&] { read_foreign_file(path, wavelengths); });
}

inline Vector to_source(const Sample& s) { return at(s.geometry.incident.theta, s.geometry.incident.phi); }
inline Vector to_detector(const Sample& s) { return at(s.geometry.reflected.theta, s.geometry.reflected.phi); }

/// Each sample has f11 of the function at its own directions.
inline void expect_values(const std::vector<Sample>& samples, const Brdf& f, double tolerance) {
  for (const Sample& s : samples)
    ASSERT_NEAR(s.f11, f(to_source(s), to_detector(s)), tolerance)
        << s.geometry.incident.theta / degree << ',' << s.geometry.incident.phi / degree << ' '
        << s.geometry.reflected.theta / degree << ',' << s.geometry.reflected.phi / degree;
}

/// A file that ends after each sixteenth of what it should be is refused in one line that names it.
inline void expect_refused_where_cut(const std::string& path, const std::vector<double>& wavelengths = {}) {
  const std::string whole = contents(path);
  for (std::size_t part = 1; part < 16; ++part) {
    put(path, whole.substr(0, whole.size() * part / 16));
    const std::string message = foreign_refusal(path, wavelengths);
    EXPECT_TRUE(says(message, {path})) << part << " of 16";
  }
  put(path, whole);
}

/// What an export is refused for; empty if it is not.
inline std::string export_refusal(const Model& model, const std::string& format, const ExportOptions& options = {}) {
  try {
    Export(model, export_format(format), options);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

/// The bytes of numbers as files of little-endian machines have them.
template <class Number>
void append(std::string& bytes, Number value) {
  std::array<char, sizeof(Number)> raw{};
  std::memcpy(raw.data(), &value, sizeof(Number));
  bytes.append(raw.data(), raw.size());
}

}  // namespace mmbrdf
