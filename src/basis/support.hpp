// SPDX-License-Identifier: BSD-3-Clause
/// What samples support, by leverage.
#pragma once

#include "mmbrdf/basis/modes.hpp"
#include "mmbrdf/geometry/direction_pairs.hpp"

namespace mmbrdf {

/// Pairs of directions at which f11 of an order is no less determined than where was measured: the leverage
/// h = xᵀ (Σ x xᵀ)⁻¹ x of their row x, the sum over the pairs that were measured, is at most the largest of those
/// (theory 4.7). Those that were measured are among them. Reciprocity and the symmetry of the grid count. On the grid of
/// anisotropic samples both are asked for: isotropic modes of that order, and any of a low one.
DirectionPairs supported(const DirectionPairs& measured, int order, DiscMapping mapping);

/// The least order that is asked: structure any finer than it needs samples next to it, whatever is fitted.
inline constexpr int support_order = 7;

}  // namespace mmbrdf
