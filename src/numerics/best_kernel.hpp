// SPDX-License-Identifier: BSD-3-Clause
/// Which of the kernels that were compiled in is used.
#pragma once

#include <algorithm>
#include <span>

namespace mmbrdf {

/// The first that runs here, of a list that has the fastest first and ends in one that runs everywhere.
template <class Kernel>
const Kernel& first_that_runs(std::span<const Kernel* const> kernels) {
  return **std::ranges::find_if(kernels, [](const Kernel* kernel) { return kernel->runs_here(); });
}

}  // namespace mmbrdf
