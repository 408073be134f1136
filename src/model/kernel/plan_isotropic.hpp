// SPDX-License-Identifier: BSD-3-Clause
/// The plan of Form::isotropic.
#pragma once

#include "model/kernel/plan_parts.hpp"

namespace mmbrdf {

/// What a mode gives to the coefficients of Form::isotropic. Its orders must be within 7, 4.
Shares isotropic_shares(const Mode& mode);

}  // namespace mmbrdf
