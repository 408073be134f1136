// SPDX-License-Identifier: BSD-3-Clause
#include "numerics/gram.hpp"

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
#ifdef MMBRDF_X86
  static const GramKernel& best = avx2::gram.runs_here() ? avx2::gram : baseline::gram;
  return best;
#else
  return baseline::gram;
#endif
}

}  // namespace mmbrdf
