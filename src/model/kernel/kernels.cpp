// SPDX-License-Identifier: BSD-3-Clause
#include "model/kernel/kernels.hpp"

#include <algorithm>

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
  static const Kernel& best =
      **std::find_if(kernels().begin(), kernels().end(), [](const Kernel* kernel) { return kernel->runs_here(); });
  return best;
}

}  // namespace mmbrdf
