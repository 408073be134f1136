// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "mmbrdf/fitting/fit.hpp"

namespace mmbrdf {

/// What the data leave free of a block, or nothing. In one plane it is half of the modes, and their names say nothing.
std::string undetermined(const Block& block, const Solution& solution, Sides sides);

/// Whether what the data leave free of a block leaves an element of it alone.
bool determines(const Solution& solution, const Block& block, const Basis& basis, std::size_t element);

}  // namespace mmbrdf
