// SPDX-License-Identifier: BSD-3-Clause
/// The plan of Form::germer2017.
#pragma once

#include <optional>

#include "model/kernel/plan_parts.hpp"

namespace mmbrdf {

/// What a mode gives to the coefficients of Form::germer2017; nothing if that form does not have the mode. Its orders
/// must be within 7, 4.
std::optional<Shares> germer2017_shares(const Mode& mode);

}  // namespace mmbrdf
