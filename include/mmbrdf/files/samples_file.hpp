// SPDX-License-Identifier: BSD-3-Clause
/// Files of samples: the published measurements, and the project's own columns (docs/formats.md).
///
/// Reading throws std::runtime_error with "file:line: …" and the value that is wrong.
/// Writing replaces a file as a whole: write_file.hpp.
#pragma once

#include <array>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/files/csv.hpp"
#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf {

/// Samples of a file one at a time, in constant memory: see read_samples.
class SampleReader {
 public:
  /// Reads the header.
  SampleReader(std::istream& in, const std::string& name);
  /// The next sample; false at the end.
  bool next(Sample& sample);

 private:
  std::string name_;
  CsvReader reader_;
  GeometryColumns geometry_;
  int m11_ = -1, rotation_;
  std::array<int, 16> elements_, uncertainties_;  // columns; −1: none
  long rows_ = 0;
};

/// Whether a file begins as one of samples does, and none of a model: its first line, but for empty ones and comments,
/// with a letter. Throws std::runtime_error for a file that cannot be opened.
bool holds_samples(const std::string& path);

/// Samples in the layout of the published data, or with the project's own column names (docs/formats.md). Throws
/// std::runtime_error, as the classes above do, for a file without rows or with elements that are not normalised, and
/// for uncertainties that are negative or not there for all elements. Without their columns they are 0, not known.
std::vector<Sample> read_samples(const std::string& path);
std::vector<Sample> read_samples(std::istream& in, const std::string& name);

/// The project's own columns: wavelength_nm, angles in degrees, f11, m12 … m44, with as many digits as it takes:
/// matrices read back are the same bits, wavelengths and angles equal to 1 in the last place. Behind them u_f11, u_m12
/// … u_m44, if the samples have uncertainties. Throws std::invalid_argument for invalid samples, or if only some have.
void write_samples(const std::string& path, std::span<const Sample> samples);
void write_samples(std::ostream& out, std::span<const Sample> samples);

}  // namespace mmbrdf
