// SPDX-License-Identifier: BSD-3-Clause
/// One constant matrix times the values of many sets of samples. influence_kernel.cpp is compiled once for each instruction
/// set; influence_kernels.cpp chooses. This header is what both sides see: plain data, nothing inline.
#pragma once

#include <stddef.h>

namespace mmbrdf {

/// Sets stand side by side, `influence_sets` of them: in lanes. What a set gives does not depend on its neighbours.
inline constexpr size_t influence_sets = 48;
/// Rows of the constant matrix stand in tiles of this height.
inline constexpr size_t influence_tile = 4;
/// So many geometries are taken and multiplied at once: sixteen elements of them stay in the second-level cache.
inline constexpr size_t influence_geometries = 32;

struct InfluenceKernel {
  const char* name;
  bool (*runs_here)();
  /// f of `count` geometries of each set, `from[s]`, `each` (16 or 1) numbers for each, as f11 and f_ij / f11: of element e
  /// at to[e][g × influence_sets + s], unless that is null, and times itself and weights[g × 16 + e] added to
  /// squares[e][s]. What has a weight of 0 becomes 0.
  void (*take_float)(const float* const* from, size_t each, size_t count, const double* weights, double* const* to,
                     double* const* squares);
  void (*take_double)(const double* const* from, size_t each, size_t count, const double* weights, double* const* to,
                      double* const* squares);
  /// out (rows × influence_sets) += p · values (count × influence_sets). `p` has its rows in tiles, the last filled up with
  /// zeros: number r of column g of tile t is at p[(t × count + g) × influence_tile + r]. `rows` is a multiple of
  /// influence_tile.
  void (*multiply)(const double* p, size_t rows, size_t count, const double* values, double* out);
};

}  // namespace mmbrdf
