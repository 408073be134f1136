// SPDX-License-Identifier: BSD-3-Clause
/// Files of a polarimeter: its readings of references and of samples, a reading in each row, and the instrument that a
/// calibration gives. The layouts are described in docs/formats.md.
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
#include <string_view>
#include <vector>

#include "mmbrdf/files/io.hpp"
#include "mmbrdf/polarimetry/calibration.hpp"

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

/// What an instrument with these readings measured of a sample.
struct RawMeasurement {
  double wavelength = 0;  ///< micrometres
  Geometry geometry;
  std::vector<double> readings;  ///< in the order of polarimeter.hpp
};

/// The sample that a measurement stands for, in Frame::xy as all samples: sample() of its matrix, with the standard
/// uncertainties that independent noise of the readings, of this law, gives f11 (sr⁻¹) and the normalised elements.
/// What the instrument is uncertain by is not among them: it is the same error in all samples (instrument_errors()).
/// Throws std::invalid_argument as Reduction::mueller() and sample() do; for a noise that is negative or not finite;
/// and where it is so large that an uncertainty is not finite.
Sample reduced(const Reduction& reduction, const RawMeasurement& measurement, double solid_angle,
               const ReadingNoise& noise);

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

/// Instruments in JSON, read back to the same bits but for angles. What the references turned out to be is not kept.
/// Reading throws std::runtime_error with "name: field: …"; writing std::invalid_argument for what cannot be read back.
Calibration calibration_from_json(std::string_view text, const std::string& name);
std::string to_json(const Calibration& calibration);
Calibration load_instrument(const std::string& path);
void save_instrument(const std::string& path, const Calibration& calibration);

}  // namespace mmbrdf
