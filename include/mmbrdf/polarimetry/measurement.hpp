// SPDX-License-Identifier: BSD-3-Clause
/// From the readings of a sample to its matrix.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "mmbrdf/polarimetry/reduction.hpp"
#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf {

/// What an instrument measured of a sample.
struct RawMeasurement {
  double wavelength = 0;  ///< micrometres
  Geometry geometry;
  std::vector<double> readings;  ///< in the order of polarimeter.hpp
  /// Of the readings, where they are not those of the instrument; empty: they are.
  std::vector<StatePair> pairs = {};
};

/// Reductions for all pairs of states that measurements of one instrument have read: each is made once.
class Reducer {
 public:
  /// Throws as Reduction does.
  explicit Reducer(const Polarimeter& polarimeter);
  ~Reducer();
  /// For these pairs: empty is what the instrument reads. Throws std::invalid_argument for a pair that the instrument does
  /// not read, or that is there twice, and as Reduction does.
  const Reduction& operator()(std::span<const StatePair> pairs);
  /// For how many different sets of pairs it was asked.
  std::size_t sets() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The sample that a measurement stands for, in Frame::xy as all samples: sample() of its matrix, with the standard
/// uncertainties that independent noise of the readings, of this law, gives f11 (sr⁻¹) and the normalised elements.
/// Elements that the readings do not determine are unknown, and so are those of the xy frame that they are mixed with.
/// What the instrument is uncertain by is not among them: it is the same error in all samples (instrument_errors()).
/// The reduction is that of the measurement's pairs. Throws std::invalid_argument as Reduction::mueller() and sample()
/// do; where M11 is not determined; for a noise that is negative or not finite; and where it is so large that an
/// uncertainty is not finite.
Sample reduced(const Reduction& reduction, const RawMeasurement& measurement, double solid_angle,
               const ReadingNoise& noise);

}  // namespace mmbrdf
