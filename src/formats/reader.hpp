// SPDX-License-Identifier: BSD-3-Clause
// What readers of foreign formats share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mmbrdf/formats/foreign.hpp"
#include "mmbrdf/geometry/geometry.hpp"

namespace mmbrdf {

/// A file that is to be read.
struct Source {
  std::string path;
  std::string_view head;  ///< its first foreign_head bytes; gone after the constructor of the reader
  std::uint64_t size = 0;
  ForeignOptions options = {};

  /// "path: what", as an error to throw.
  [[nodiscard]] std::runtime_error error(const std::string& what) const;

  /// A wavelength (micrometres) for each of `count` values at a geometry that have none in the file. Throws unless that
  /// many were told; `values` names them, as in "3 values a row".
  std::vector<double> told_wavelengths(std::size_t count, const std::string& values) const;

  /// Throws if a wavelength was told of a file that says its own.
  void require_none_told() const;
};

using UseSamples = std::function<void(std::span<const Sample>)>;

/// Passes samples on, some at a time, and counts those that are passed over.
class SampleSink {
 public:
  explicit SampleSink(const UseSamples& use) : use_(use) { waiting_.reserve(some); }

  /// Unless a direction is at or below the horizon, f11 is NaN, or a number is beyond 1e100, as after a division by nearly 0.
  void add(const Sample& sample);
  void below_horizon(std::uint64_t count = 1) { below_ += count; }
  void not_measured(std::uint64_t count = 1) { empty_ += count; }

  /// The last ones. Throws std::runtime_error, with the path, if there were none at all.
  void finish(const std::string& path);

  /// "; 3 of 20 rows at or below the horizon passed over", with `rows` for what the format has; or nothing.
  std::string passed_over(const std::string& rows) const;

 private:
  static constexpr std::size_t some = 4096;
  const UseSamples& use_;
  std::vector<Sample> waiting_;
  std::uint64_t samples_ = 0, below_ = 0, empty_ = 0;
};

class ForeignFile::Reader {
 public:
  virtual ~Reader() = default;
  virtual void read(const UseSamples& use) = 0;

  Elements measured{1};  ///< f11
  bool uncertainties = false;
  bool frames = false;        ///< whether samples may be known as_measured
  std::string understood;     ///< known from the beginning
  std::string passed_over{};  ///< after read(), with "; " in front
};

/// A sample of f11 alone.
Sample scalar_sample(double wavelength, const Geometry& geometry, double f11);

inline constexpr double half_pi = std::numbers::pi / 2;

/// Directions nearer to the horizon than this (radians) count as lying on it: single precision has π/2 to 5e-8.
inline constexpr double horizon = 1e-6;

/// Whether both directions are above it.
bool above_horizon(const Geometry& geometry);

/// "450, 500 and 550 nm"
std::string nanometre_text(std::span<const double> wavelengths);

/// Throws std::runtime_error, beginning with `where`, unless a wavelength (micrometres) can be one: 10 nm to 1 mm.
void require_wavelength(double wavelength, const std::string& where);

// Recognisers and readers, one of each format.
struct ForeignFormat {
  const char* name;
  bool (*is)(std::string_view head, std::uint64_t size);
  std::unique_ptr<ForeignFile::Reader> (*open)(const Source& source);
};

}  // namespace mmbrdf
