// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf {

/// Throws std::invalid_argument, with the sample's number, for values that with these weights (empty: 1) leave no finite
/// sum of squares.
void require_moderate(std::span<const Sample> samples, std::span<const Mueller> weights);

}  // namespace mmbrdf
