// SPDX-License-Identifier: BSD-3-Clause
/// Rows of modes at many geometries side by side, and their variances: what variances.cpp asks of its kernel. Compiled
/// once for each instruction set; this header is what both sides see: plain data, nothing inline.
///
/// Number j of geometry g is at [j × stride + g]. What a geometry gives does not depend on its neighbours.
#pragma once

namespace mmbrdf {

/// weight × K(incident) K(reflected), K without its norm.
struct RowTerm {
  double weight;
  int incident, reflected;
};

/// Columns of an element, sorted by their numbers of terms: with[t] columns that have t of them, t ≤ most. Each has its
/// number in the row and its coefficient.
struct TermColumns {
  const RowTerm* terms;
  const int* column;
  const double* coefficients;
  const int* with;
  int most;
};

/// Columns of a matrix are taken four at a time; a last, shorter group is filled with zeros, and so are rows. Entry
/// (k, 4p + j) is at [(p × rows + k) × 4 + j].
inline constexpr long columns_together = 4;
struct PackedColumns {
  const double* values;
  long rows, columns;  ///< multiples of columns_together
};

struct VariancesKernel {
  bool (*runs_here)();
  long width;  ///< numbers in a register

  // For counts that are multiples of `width`:

  /// K_f at directions, without the norm, at zernike_index. |phi| ≤ max_azimuth.
  void (*functions)(double* k, int order, bool projected, const double* theta, const double* phi, long count,
                    long stride);
  /// The row of an element, from tables of K of stride `of_k`, and Σ coefficient × column.
  void (*rows)(double* row, long stride, double* value, const TermColumns& columns, const double* k_incident,
               const double* k_reflected, long of_k, long count);
  /// hᵀ V h, of V that is symmetric.
  void (*variances)(double* out, const double* h, const PackedColumns& v, long count, long stride);
  /// Vᵀ h, of another stride.
  void (*products)(double* out, long out_stride, const double* h, const PackedColumns& v, long count, long stride);
  /// cos 2a and sin 2a. |a| ≤ max_azimuth / 2.
  void (*double_angles)(double* cosine, double* sine, const double* angle, long count);
  /// √(m² v11 + f11² v), of sixteen elements m and variances v of the normalised ones, and √v11; 0 of what is negative.
  /// Element e of geometry g goes to out[16 g + e].
  void (*deviations)(double* out, const double* m, const double* v, long count, long stride);

  // For any count:

  /// Σ x y over columns
  void (*dots)(double* out, const double* x, const double* y, long columns, long count, long stride);
  /// x becomes c x + s y, and y c y − s x, in each of the columns.
  void (*turn)(double* x, double* y, const double* c, const double* s, long columns, long count, long stride);
};

}  // namespace mmbrdf
