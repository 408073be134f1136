// SPDX-License-Identifier: BSD-3-Clause
/// What a calibration says of its references and of itself, whatever kind of instrument it is.
#pragma once

#include "polarimetry/calibration_parts.hpp"

namespace mmbrdf::calibration {

/// A reference as it was expected, and its measured matrix.
FittedReference fitted(const Unknowns& unknowns, std::span<const Reference> references, std::size_t i,
                       const Mueller& measured, const CalibrationOptions& options);

/// Over the elements that are known. `correction` is √(readings / degrees of freedom).
FigureOfMerit figure_of_merit(std::span<const FittedReference> references, double correction);

/// Of the mean gain of the empty references, from their scatter.
double scale_uncertainty(const Unknowns& unknowns, std::span<const Reference> references);

/// Offset, extinction and phase of the reference polarizer.
void set_polarizer(Calibration& calibration, const Unknowns& unknowns);

}  // namespace mmbrdf::calibration
