// SPDX-License-Identifier: BSD-3-Clause
/// A model as a table in the format of another program: which there are, what each holds and what its readers make of it
/// is in docs/formats.md, "Formats of the field".
///
///   const Export table(model, export_format("plaque.pbsdf"), {.wavelengths = {0.532}});
///   write_file("plaque.pbsdf", [&](std::ostream& out) { table.write(out); });
///
/// A program that reads such a table interpolates in it. What that costs is measured, not estimated: at random
/// directions up to compared_theta, or to the smaller angle of the fit (30 degrees of a fit below 1 degree), as the
/// format's own reader would.
#pragma once

#include <functional>
#include <iosfwd>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mmbrdf/model/model.hpp"

namespace mmbrdf {

/// What codes of radiative transfer ask a surface for. Polar angles and azimuths phi_r − phi_i are in radians, π is forward.
struct TransferAngles {
  int streams = 0;  ///< cosines in a hemisphere, Gauss–Legendre on (0, 1)
  int moments = 0;  ///< how many m, 0 … moments − 1: at most 2 × streams, which 0 stands for
  std::vector<double> suns = {}, views = {}, azimuths = {};
  friend bool operator==(const TransferAngles&, const TransferAngles&) = default;
};

struct ExportOptions {
  /// Micrometres; empty: known_wavelengths(model).
  std::vector<double> wavelengths = {};
  /// Of a format without polarization: f11, or a quantity of the table in sr⁻¹ (quantities.hpp), as f_ss.
  std::string channel = "f11";
  /// Wanted: the rms of what interpolation adds, as a part of f11. The coarsest table that has it is written.
  double error = 5e-4;
  /// Of the formats that take it; empty for others.
  TransferAngles transfer = {};
};

/// What interpolation adds, as parts of f11, over all elements that the table has. Nothing, and theta_max 0, in a format
/// of moments and values at given angles.
struct ExportError {
  double rms = 0, largest = 0;
  double theta_max = 0;  ///< radians: up to where directions were compared; 0 where nothing is interpolated
};

/// A format that is written.
struct ExportFormat {
  std::string_view name;        ///< "pbsdf"
  std::string_view ending;      ///< ".pbsdf"
  std::string_view meaning;     ///< "Mitsuba's measured_polarized: Mueller matrices of isotropic samples"
  bool takes_channel;           ///< it holds one number at a geometry, not a matrix
  bool takes_transfer = false;  ///< it holds what TransferAngles asks for
  bool takes_error = true;      ///< its table is as fine as ExportOptions::error wants; that of others is what it is
};

std::span<const ExportFormat> export_formats();

/// By its name. Throws std::invalid_argument for a name that is not in the table.
const ExportFormat& export_format(std::string_view name);

/// The one whose ending a path has. Throws std::invalid_argument if there is none, or several, with their names.
const ExportFormat& export_format_of(std::string_view path);

class Export {
 public:
  /// Makes the table. Throws std::invalid_argument for what the format cannot hold, with the reason: elements that are
  /// not known, a sample that is not isotropic, wavelengths; and for an error that no table of it has.
  Export(const Model& model, const ExportFormat& format, const ExportOptions& options = {});

  /// Throws nothing of its own: a stream that fails says so.
  void write(std::ostream& out) const { write_(out); }

  const ExportError& error() const { return error_; }

  /// What was written, in words: grid, units, frame and signs, where the model is extrapolated (beyond the fitted angles, at
  /// which wavelengths, and unsupported_line() of quantities/trust.hpp), and which wavelengths lie between fitted ones.
  const std::string& understood() const { return understood_; }

  /// Implemented by each format.
  struct Made {
    std::function<void(std::ostream&)> write;
    ExportError error;
    std::string understood;
    std::string cause = "interpolation";  ///< of the error
    bool extrapolates = true;             ///< it has directions beyond the fitted ones
  };

 private:
  explicit Export(Made made);
  std::function<void(std::ostream&)> write_;
  ExportError error_;
  std::string understood_;
  bool extrapolates_;
};

/// The largest polar angle (80 degrees) at which tables are compared with a model that was fitted to no smaller one: towards the
/// horizon what readers make of tables is decided by what they do with the last node.
inline constexpr double compared_theta = 1.3962634015954636;

}  // namespace mmbrdf
