// SPDX-License-Identifier: BSD-3-Clause
/// Files of calibrated instruments (docs/formats.md).
#pragma once

#include <string>
#include <string_view>

#include "mmbrdf/polarimetry/calibration.hpp"

namespace mmbrdf {

/// Instruments in JSON, read back to the same bits but for angles. What the references turned out to be is not kept.
/// Reading throws std::runtime_error with "name: field: …"; writing std::invalid_argument for what cannot be read back.
Calibration calibration_from_json(std::string_view text, const std::string& name);
std::string to_json(const Calibration& calibration);
Calibration load_instrument(const std::string& path);
void save_instrument(const std::string& path, const Calibration& calibration);

}  // namespace mmbrdf
