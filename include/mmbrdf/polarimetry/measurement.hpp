// SPDX-License-Identifier: BSD-3-Clause
/// From the readings of a sample to its matrix.
#pragma once

#include <vector>

#include "mmbrdf/polarimetry/reduction.hpp"
#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf {

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

}  // namespace mmbrdf
