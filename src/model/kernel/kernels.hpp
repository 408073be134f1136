// SPDX-License-Identifier: BSD-3-Clause
/// The kernels that were compiled in.
#pragma once

#include <span>

#include "model/kernel/kernel.hpp"

namespace mmbrdf {

/// Every kernel of this build, the fastest first; not all of them need run here. For tests and benchmarks.
std::span<const Kernel* const> kernels();

/// The first that runs here.
const Kernel& best_kernel();

}  // namespace mmbrdf
