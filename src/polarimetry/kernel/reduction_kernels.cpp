// SPDX-License-Identifier: BSD-3-Clause
#include "polarimetry/kernel/reduction_kernels.hpp"

#include "numerics/best_kernel.hpp"

namespace mmbrdf {

#ifdef MMBRDF_X86
namespace avx512 {
extern const ReductionKernel reduction_kernel;
}
namespace avx2 {
extern const ReductionKernel reduction_kernel;
}
#endif
namespace baseline {
extern const ReductionKernel reduction_kernel;
}

std::span<const ReductionKernel* const> reduction_kernels() {
  static constexpr const ReductionKernel* list[] = {
#ifdef MMBRDF_X86
      &avx512::reduction_kernel, &avx2::reduction_kernel,
#endif
      &baseline::reduction_kernel};
  return list;
}

const ReductionKernel& best_reduction_kernel() {
  static const ReductionKernel& best = first_that_runs(reduction_kernels());
  return best;
}

}  // namespace mmbrdf
