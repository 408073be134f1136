// SPDX-License-Identifier: BSD-3-Clause
/// Calibration of two turning retarders: maximum likelihood of the few numbers that describe them.
#pragma once

#include "polarimetry/calibration_parts.hpp"

namespace mmbrdf::calibration {

/// As calibrate(), for options with retarders.
Calibration calibrate_retarders(std::span<const Reference> references, const CalibrationOptions& options);

}  // namespace mmbrdf::calibration
