// SPDX-License-Identifier: BSD-3-Clause
#include "polarization/kernel/analysis_kernels.hpp"

#include "numerics/best_kernel.hpp"

namespace mmbrdf {

#ifdef MMBRDF_X86
namespace avx512 {
extern const AnalysisKernel analysis_kernel;
}
namespace avx2 {
extern const AnalysisKernel analysis_kernel;
}
#endif
namespace baseline {
extern const AnalysisKernel analysis_kernel;
}

std::span<const AnalysisKernel* const> analysis_kernels() {
  static constexpr const AnalysisKernel* list[] = {
#ifdef MMBRDF_X86
      &avx512::analysis_kernel, &avx2::analysis_kernel,
#endif
      &baseline::analysis_kernel};
  return list;
}

const AnalysisKernel& best_analysis_kernel() {
  static const AnalysisKernel& best = first_that_runs(analysis_kernels());
  return best;
}

}  // namespace mmbrdf
