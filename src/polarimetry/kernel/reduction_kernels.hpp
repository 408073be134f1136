// SPDX-License-Identifier: BSD-3-Clause
/// The reduction kernels that were compiled in.
#pragma once

#include <span>

#include "polarimetry/kernel/reduction_kernel.hpp"

namespace mmbrdf {

/// Every one of this build, the fastest first; not all of them need run here. For tests and benchmarks.
std::span<const ReductionKernel* const> reduction_kernels();

/// The first that runs here.
const ReductionKernel& best_reduction_kernel();

}  // namespace mmbrdf
