// SPDX-License-Identifier: BSD-3-Clause
/// The plan for one incident direction.
#pragma once

#include <span>
#include <vector>

#include "model/kernel/plan.hpp"

namespace mmbrdf {

/// The form for one incident direction.
Form incidence_form(const Plan& plan);

/// Its coefficients, from those of the modes.
std::vector<double> incidence_coefficients(const PreparedPattern& pattern, std::span<const double> of_modes,
                                           const Direction& incident);

}  // namespace mmbrdf
