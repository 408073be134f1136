// SPDX-License-Identifier: BSD-3-Clause
#include "fitting/kernel/influence_kernels.hpp"

#include "numerics/best_kernel.hpp"

namespace mmbrdf {

#ifdef MMBRDF_X86
namespace avx512 {
extern const InfluenceKernel influence_kernel;
}
namespace avx2 {
extern const InfluenceKernel influence_kernel;
}
#endif
namespace baseline {
extern const InfluenceKernel influence_kernel;
}

std::span<const InfluenceKernel* const> influence_kernels() {
  static constexpr const InfluenceKernel* list[] = {
#ifdef MMBRDF_X86
      &avx512::influence_kernel, &avx2::influence_kernel,
#endif
      &baseline::influence_kernel};
  return list;
}

const InfluenceKernel& best_influence_kernel() {
  static const InfluenceKernel& best = first_that_runs(influence_kernels());
  return best;
}

}  // namespace mmbrdf
