// SPDX-License-Identifier: BSD-3-Clause
/// The linear start of a calibration.
#pragma once

#include "polarimetry/calibration_parts.hpp"

namespace mmbrdf::calibration {

/// The eigenvalue method. Throws std::invalid_argument for what it cannot solve.
Unknowns solve_linear(std::span<const Reference> references, const CalibrationOptions& options);

}  // namespace mmbrdf::calibration
