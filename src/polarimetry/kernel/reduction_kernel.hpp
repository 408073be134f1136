// SPDX-License-Identifier: BSD-3-Clause
/// The reduction kernel: one constant matrix times the readings of each of many pixels. reduction_kernel.cpp is compiled
/// once for each instruction set; reduction_kernels.cpp chooses. This header is what both sides see: plain data,
/// nothing inline.
#pragma once

#include <stddef.h>

namespace mmbrdf {

/// The same functions for one instruction set. What they compute for a pixel does not depend on its neighbours.
///
/// `inverse` has 16 numbers for each reading, one reading after the other; element e of a pixel is the sum of
/// inverse[16 j + e] from[j] in the order of the readings, in double precision. Both return whether all readings are
/// finite; false also where they are, if an element overflows.
struct ReductionKernel {
  const char* name;
  bool (*runs_here)();
  bool (*run_double)(const double* inverse, size_t readings, const double* from, size_t count, double* out);
  /// From and to single precision; `room` for count × readings numbers.
  bool (*run_float)(const double* inverse, size_t readings, const float* from, size_t count, float* out, double* room);
  /// Each pixel has an inverse of its own, one behind the other.
  void (*run_each)(const float* inverses, size_t readings, const float* from, size_t count, float* out);
  /// A⁺ B W⁺ of each pixel: A⁺ is 4 × analyzers, W⁺ generators × 4, B analyzers × generators, all in rows. The sums, over
  /// generators and then over analyzers, are in double precision.
  void (*run_arms)(const float* analyzers_inverse, const float* generators_inverse, size_t analyzers, size_t generators,
                   const float* from, size_t count, float* out);
};

}  // namespace mmbrdf
