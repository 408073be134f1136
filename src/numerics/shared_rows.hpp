// SPDX-License-Identifier: BSD-3-Clause
/// Least squares where several columns of values share their rows.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <deque>

#include "mmbrdf/numerics/least_squares.hpp"
#include "numerics/fold.hpp"

namespace mmbrdf {

/// Singular values of the triangles that were asked for so far, as elements and wavelengths with the same rows have the
/// same one.
class Decompositions {
 public:
  struct Svd {
    Eigen::MatrixXd triangle, u, v;
    Eigen::VectorXd s;
  };
  const Svd& of(const Eigen::MatrixXd& triangle);

 private:
  std::deque<Svd> known_;
};

/// The triangle [R q; 0 ρ] of rows with several columns of values: q and ρ have a column for each.
class SharedRows {
 public:
  SharedRows(std::size_t unknowns, std::size_t values);
  explicit SharedRows(const LeastSquares& problem);

  /// Used up.
  void add(RowColumns& rows, Shape shape = Shape::full);

  /// The problem with one of the columns of values alone, which so many rows were added for.
  LeastSquares of(std::size_t value, long rows) const;

  /// Whether the unknowns have the same triangle, to the last bit.
  bool has_unknowns_of(const SharedRows& other) const;
  const Eigen::MatrixXd& triangle() const { return triangle_; }

  /// The solution over all columns of values b_v together, if row a with value b_v stands for the row
  /// [f_v0 a, f_v1 a, …] with value b_v: coefficients of a that are Σ_p f_vp x_p. The problem is F ⊗ A, which has the
  /// singular values and vectors of F ⊗ R, products of those of F and of R; F has as many rows as there are columns of
  /// values, and at least as many as columns.
  Solution solve(const Eigen::MatrixXd& factors, long rows, double tolerance, Decompositions& known) const;

 private:
  Eigen::Index count() const { return triangle_.rows() - 1; }
  Eigen::Block<const Eigen::MatrixXd> unknowns() const { return triangle_.topLeftCorner(count(), count()); }

  Eigen::MatrixXd triangle_;
};

}  // namespace mmbrdf
