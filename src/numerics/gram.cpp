// SPDX-License-Identifier: BSD-3-Clause
#include "numerics/gram.hpp"

#include "numerics/best_kernel.hpp"

namespace mmbrdf {

#ifdef MMBRDF_X86
namespace avx2 {
extern const GramKernel gram;
}
#endif
namespace baseline {
extern const GramKernel gram;
}

const GramKernel& gram_kernel() {
  static constexpr const GramKernel* list[] = {
#ifdef MMBRDF_X86
      &avx2::gram,
#endif
      &baseline::gram};
  static const GramKernel& best = first_that_runs<GramKernel>(list);
  return best;
}

}  // namespace mmbrdf
