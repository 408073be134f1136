// SPDX-License-Identifier: BSD-3-Clause
/// Householder reflections that fold rows into a triangle, four columns at a time.
#pragma once

#include <cstddef>
#include <vector>

namespace mmbrdf {

/// Rows of numbers, kept column by column. Each column ends with zeros that fill it up to a multiple of 4.
class RowColumns {
 public:
  RowColumns(std::size_t columns, std::size_t rows)
      : columns_(columns), rows_(rows), stride_((rows + 3) / 4 * 4), numbers_(columns * stride_) {}

  std::size_t columns() const { return columns_; }
  std::size_t rows() const { return rows_; }
  std::size_t stride() const { return stride_; }
  double* column(std::size_t j) { return &numbers_[j * stride_]; }

 private:
  std::size_t columns_, rows_, stride_;
  std::vector<double> numbers_;
};

enum class Shape {
  full,
  triangle,  ///< number i of column j is 0 for j < i, j an unknown
};

/// `triangle` is [R q; 0 ρ], unknowns + 1 rows and as many columns as `rows`, column by column: R is the triangle of
/// the unknowns, q = Qᵀb has a column for each column b of values, and the row ρ the norms of what is left of those.
/// Afterwards it is that of the rows it had and of the new ones. `rows` is used up.
void fold(double* triangle, std::size_t unknowns, RowColumns& rows, Shape shape = Shape::full);

}  // namespace mmbrdf
