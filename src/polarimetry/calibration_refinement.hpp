// SPDX-License-Identifier: BSD-3-Clause
/// The end of a calibration: maximum likelihood.
#pragma once

#include "polarimetry/calibration_parts.hpp"

namespace mmbrdf::calibration {

struct Refinement {
  std::vector<double> covariance;  ///< of W and A
  double chi_squared = 0;
};

/// Maximum likelihood, from a start near to it.
Refinement refine(Unknowns& unknowns, std::span<const Reference> references, const CalibrationOptions& options);

/// Readings less unknowns; the scale that A and W share does not count.
long degrees_of_freedom(std::span<const Reference> references, const CalibrationOptions& options);

}  // namespace mmbrdf::calibration
