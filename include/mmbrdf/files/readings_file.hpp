// SPDX-License-Identifier: BSD-3-Clause
/// Files of a polarimeter's readings of references and of samples, a reading in each row (docs/formats.md).
///
/// A reading is (intensity − dark) / (monitor · gain). Reading a file throws std::runtime_error with "file:line: …" and
/// the value that is wrong: also for an intensity or reading beyond ReadingLimits, for a state that is missing, and for
/// one that is there twice.
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

/// How far below zero a reading may be, in standard deviations of the dark signal: noise goes there, light does not.
inline constexpr double most_below_zero = 5;

struct ReadingLimits {
  double saturation = never_saturated;  ///< intensities from this one on are refused
  double dark_noise = 0;  ///< standard deviation of the dark signal, in units of the readings: most_below_zero of them
};

/// Which states an instrument reads: how many each arm has, and in which pairs, as Polarimeter has them.
struct ReadStates {
  std::size_t generator = 4;
  std::size_t analyzer = 4;
  std::vector<StatePair> pairs = {};
  friend bool operator==(const ReadStates&, const ReadStates&) = default;
};
ReadStates read_states(const Polarimeter& polarimeter);

/// References measured at one wavelength (micrometres).
struct ReferenceFile {
  double wavelength = 0;
  ReadStates states;
  std::vector<Reference> references;
};

/// The rows of a reference may stand anywhere; references come in the order of their first rows. The states are counted
/// by the largest number of each; the pairs are those that any of the references has, by analysis and then by generator
/// state, and all must have them. Throws also for references at several wavelengths.
ReferenceFile read_references(const std::string& path, const ReadingLimits& limits = {});
ReferenceFile read_references(std::istream& in, const std::string& name, const ReadingLimits& limits = {});

/// Throws std::invalid_argument for a wavelength that is not positive, or a reference with another number of readings
/// than its states have.
void write_references(const std::string& path, const ReferenceFile& file);
void write_references(std::ostream& out, const ReferenceFile& file);

/// Measurements of a file one at a time: the rows of one measurement must be adjacent. Memory is constant, but for the
/// numbers of measurements that have not all pairs.
class RawReader {
 public:
  /// Reads the header.
  RawReader(std::istream& in, const std::string& name, const ReadStates& states, const ReadingLimits& limits = {});
  ~RawReader();
  /// The next measurement; false at the end. It has pairs, by analysis and then by generator state, if they are not those
  /// of the states. Throws also for rows of a measurement that differ in wavelength or direction, and for a file
  /// without rows.
  bool next(RawMeasurement& measurement);

  /// "file:line: " + text, at the last row that was read of the last measurement.
  [[nodiscard]] std::runtime_error error(const std::string& text) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Throws std::invalid_argument for a measurement with another number of readings than its pairs, or those of the states.
void write_raw(const std::string& path, const ReadStates& states, std::span<const RawMeasurement> measurements);
void write_raw(std::ostream& out, const ReadStates& states, std::span<const RawMeasurement> measurements);

/// What files of samples and models keep of a reduction (write_samples()): of which readings, by which instrument, and how.
/// Names are made printable.
std::string reduction_text(const std::string& readings, const std::string& instrument, double solid_angle,
                           const ReadingNoise& noise, double saturation = never_saturated);

}  // namespace mmbrdf
