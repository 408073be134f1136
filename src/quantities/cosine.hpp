// SPDX-License-Identifier: BSD-3-Clause
/// Whether f11 has a cosine of the receiver too many or too few.
#pragma once

#include <span>

#include "mmbrdf/quantities/fit_warnings.hpp"

namespace mmbrdf {

/// The finding `cosine` of inspect(), or one without a fault. Throws std::invalid_argument as fit() does.
Finding cosine_finding(std::span<const Sample> samples);

}  // namespace mmbrdf
