// SPDX-License-Identifier: BSD-3-Clause
/// Products and inverses of matrices of some hundred columns, for each instruction set. Their last digits depend on it.
#pragma once

#include <Eigen/Core>

namespace mmbrdf {

/// Pointers alone: this is what is compiled several times, and nothing of a library may be in more than one of them.
struct GramKernel {
  bool (*runs_here)();
  /// Lower triangle of g (n × n) += XᵀX, X of `rows` × n, both column by column; X has `stride` numbers in a column.
  void (*add)(double* g, const double* x, long n, long rows, long stride);
  /// The inverse of a symmetric positive definite matrix, of which the lower triangle counts, in its place, both
  /// triangles; returns ln det, NaN for a matrix that is not positive definite.
  double (*invert)(double* a, long n);
  /// y = x a, x and y of `rows` × n, a of n × n, all column by column.
  void (*multiply)(double* y, const double* x, const double* a, long rows, long n);
};

/// The best that runs here.
const GramKernel& gram_kernel();

/// Lower triangle of g += XᵀX over the first rows of x.
inline void add_gram(Eigen::MatrixXd& g, const Eigen::MatrixXd& x, Eigen::Index rows) {
  gram_kernel().add(g.data(), x.data(), g.cols(), rows, x.rows());
}
/// a becomes its inverse; returns ln det a, NaN if a is not positive definite.
inline double invert(Eigen::MatrixXd& a) { return gram_kernel().invert(a.data(), a.rows()); }
/// x a, a square.
inline Eigen::MatrixXd product(const Eigen::MatrixXd& x, const Eigen::MatrixXd& a) {
  Eigen::MatrixXd y(x.rows(), a.cols());
  gram_kernel().multiply(y.data(), x.data(), a.data(), x.rows(), a.cols());
  return y;
}

}  // namespace mmbrdf
