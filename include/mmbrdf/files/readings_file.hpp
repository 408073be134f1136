// SPDX-License-Identifier: BSD-3-Clause
/// Files of a polarimeter's readings of references and of samples, a reading in each row (docs/formats.md).
///
/// A reading is (intensity − dark) / (monitor · gain). Reading a file throws std::runtime_error with "file:line: …" and
/// the value that is wrong: also for an intensity at or above `saturation` or below its dark signal, for a state that
/// is missing, and for one that is there twice.
#pragma once

#include <iosfwd>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/files/csv.hpp"
#include "mmbrdf/polarimetry/calibration.hpp"
#include "mmbrdf/polarimetry/measurement.hpp"

namespace mmbrdf {

inline constexpr double never_saturated = std::numeric_limits<double>::infinity();

/// How many states each arm of an instrument has.
struct StateCounts {
  std::size_t generator = 4;
  std::size_t analyzer = 4;
  friend bool operator==(const StateCounts&, const StateCounts&) = default;
};

/// References measured at one wavelength (micrometres).
struct ReferenceFile {
  double wavelength = 0;
  StateCounts states;
  std::vector<Reference> references;
};

/// The rows of a reference may stand anywhere; references come in the order of their first rows. The states are counted
/// by the largest number of each. Throws also for references at several wavelengths.
ReferenceFile read_references(const std::string& path, double saturation = never_saturated);
ReferenceFile read_references(std::istream& in, const std::string& name, double saturation = never_saturated);

/// Throws std::invalid_argument for a wavelength that is not positive, or a reference with another number of readings
/// than there are states.
void write_references(const std::string& path, const ReferenceFile& file);
void write_references(std::ostream& out, const ReferenceFile& file);

/// Measurements of a file one at a time, in constant memory: the rows of one measurement must be adjacent.
class RawReader {
 public:
  /// Reads the header.
  RawReader(std::istream& in, const std::string& name, const StateCounts& states, double saturation = never_saturated);
  ~RawReader();
  /// The next measurement; false at the end. Throws also for rows of a measurement that differ in wavelength or
  /// direction, and for a file without rows.
  bool next(RawMeasurement& measurement);

  /// "file:line: " + text, at the last row that was read of the last measurement.
  [[nodiscard]] std::runtime_error error(const std::string& text) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Throws std::invalid_argument for a measurement with another number of readings than there are states.
void write_raw(const std::string& path, const StateCounts& states, std::span<const RawMeasurement> measurements);
void write_raw(std::ostream& out, const StateCounts& states, std::span<const RawMeasurement> measurements);

}  // namespace mmbrdf
