// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "mmbrdf/geometry/geometry.hpp"

namespace mmbrdf {

/// Pairs of directions over which means are taken: uniform in projected cosine up to 70 degrees on both sides, from
/// Halton's sequences of 2, 3, 5 and 7.
std::vector<Geometry> spread_directions(std::size_t count);

}  // namespace mmbrdf
