// SPDX-License-Identifier: BSD-3-Clause
#include "model/kernel/kernels.hpp"

#include "numerics/best_kernel.hpp"

namespace mmbrdf {

#ifdef MMBRDF_X86
namespace avx512 {
extern const Kernel kernel;
}
namespace avx2 {
extern const Kernel kernel;
}
#endif
namespace baseline {
extern const Kernel kernel;
}

std::span<const Kernel* const> kernels() {
  static constexpr const Kernel* list[] = {
#ifdef MMBRDF_X86
      &avx512::kernel, &avx2::kernel,
#endif
      &baseline::kernel};
  return list;
}

const Kernel& best_kernel() {
  static const Kernel& best = first_that_runs(kernels());
  return best;
}

}  // namespace mmbrdf
