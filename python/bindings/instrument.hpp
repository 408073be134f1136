// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "bindings.hpp"
#include "mmbrdf/polarimetry/calibration.hpp"

namespace mmbrdf::python {

using CalibrationPointer = std::shared_ptr<Calibration>;

}  // namespace mmbrdf::python
