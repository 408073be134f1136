// SPDX-License-Identifier: BSD-3-Clause
/// The analysis kernel: what analysis.cpp, decompositions.cpp and batch.cpp ask of it. Its sources (analysis_kernel.cpp
/// and the headers *_pack.hpp) are compiled once for each instruction set; analysis_kernels.cpp chooses. This header is
/// what both sides see: plain data, nothing inline.
#pragma once

#include <stddef.h>

namespace mmbrdf {

/// What is asked of each matrix, with what comes out of it.
enum class Analysis {
  realizable,  ///< 1 or 0
  depolarization,
  diattenuation,
  polarizance,
  purity,
  realizability_margin,
  entropy,
  coherency_eigenvalues,    ///< rising
  nearest_realizable,       ///< the matrix; how far it is
  cloude_decomposition,     ///< weights, falling; components
  lu_chipman,               ///< depolarizer; retarder; diattenuator
  symmetric_decomposition,  ///< diattenuator 2, retarder 2; depolarizer; retarder 1, diattenuator 1
  ratios,                   ///< depolarization … entropy, in the order above
};

/// How many numbers come out of each.
inline constexpr size_t numbers_of[] = {1, 1, 1, 1, 1, 1, 1, 4, 17, 68, 48, 80, 6};
inline constexpr size_t most_numbers = 80;

/// The same functions for one instruction set. What they compute for a matrix does not depend on its neighbours.
struct AnalysisKernel {
  const char* name;
  bool (*runs_here)();
  /// Matrices of 16 numbers, one after the other, to numbers_of it each. Where `left` becomes 1 the kernel has no answer,
  /// and what it wrote means nothing: elements that are not finite, the largest below 2⁻⁴⁰⁰ or above 2⁴⁰⁰, M11 below
  /// 2⁻¹⁰⁰⁰ of it where that matters, a singular case, and what the analysis refuses. Returns whether some did.
  bool (*run)(Analysis, const double* matrices, size_t count, double* out, unsigned char* left);
};

}  // namespace mmbrdf
