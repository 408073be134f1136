// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "mmbrdf/fitting/fit.hpp"

namespace mmbrdf {

/// What the data leave free of a block, or nothing. Few modes are named.
std::string undetermined(const Block& block, const Solution& solution);

/// Whether what the data leave free of a block leaves an element of it alone.
bool determines(const Solution& solution, const Block& block, const Basis& basis, std::size_t element);

}  // namespace mmbrdf
