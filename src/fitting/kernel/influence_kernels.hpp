// SPDX-License-Identifier: BSD-3-Clause
/// The kernels of influences that were compiled in.
#pragma once

#include <span>

#include "fitting/kernel/influence_kernel.hpp"

namespace mmbrdf {

/// Every one of this build, the fastest first; not all of them need run here. For tests and benchmarks.
std::span<const InfluenceKernel* const> influence_kernels();

/// The first that runs here.
const InfluenceKernel& best_influence_kernel();

}  // namespace mmbrdf
