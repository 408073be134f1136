// SPDX-License-Identifier: BSD-3-Clause
/// Errors of a budget's terms, drawn along with a model.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mmbrdf/uncertainty/budget.hpp"

namespace mmbrdf {

/// In units of effects(): of each draw, one number for each effect of each term in turn. The same at all geometries.
std::vector<double> drawn_errors(std::span<const TypeBTerm> terms, std::size_t draws, unsigned long seed);

}  // namespace mmbrdf
