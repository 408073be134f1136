// SPDX-License-Identifier: BSD-3-Clause
// Compiled once for each instruction set, with MMBRDF_ISA as its name. Eigen has another name in each, lest the linker
// take for all what was compiled for one.
#define MMBRDF_JOINED(a, b) a##b
#define MMBRDF_NAMED(a, b) MMBRDF_JOINED(a, b)
#define Eigen MMBRDF_NAMED(Eigen_, MMBRDF_ISA)
#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "numerics/gram.hpp"

namespace mmbrdf::MMBRDF_ISA {
namespace {

using Eigen::Index;
using Matrix = Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

constexpr Index smallest = 48;  // below, a matrix is worked on whole

Matrix block(Matrix& m, Index row, Index column, Index rows, Index columns) {
  return Matrix(&m(row, column), rows, columns, m.outerStride());
}

/// C⁻¹ of a lower triangle in its place, by halves: of [A 0; B C] it is [A⁻¹ 0; −C⁻¹ B A⁻¹, C⁻¹].
void invert_triangle(Matrix m) {
  const Index n = m.rows(), half = n / 2;
  if (n <= smallest) {
    m = Eigen::MatrixXd(m.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(n, n)));
    return;
  }
  Matrix a = block(m, 0, 0, half, half), b = block(m, half, 0, n - half, half),
         c = block(m, half, half, n - half, n - half);
  c.triangularView<Eigen::Lower>().solveInPlace(b);
  b = -b;
  a.triangularView<Eigen::Lower>().solveInPlace<Eigen::OnTheRight>(b);
  invert_triangle(a);
  invert_triangle(c);
}

/// LᵀL of a lower triangle in its place, its lower triangle: [AᵀA + BᵀB, ·; CᵀB, CᵀC].
void square_triangle(Matrix m) {
  const Index n = m.rows(), half = n / 2;
  if (n <= smallest) {
    const Eigen::MatrixXd l = m.triangularView<Eigen::Lower>();
    m.triangularView<Eigen::Lower>() = l.transpose() * l;
    return;
  }
  Matrix a = block(m, 0, 0, half, half), b = block(m, half, 0, n - half, half),
         c = block(m, half, half, n - half, n - half);
  square_triangle(a);
  a.selfadjointView<Eigen::Lower>().rankUpdate(b.transpose());
  b = c.triangularView<Eigen::Lower>().transpose() * Eigen::MatrixXd(b);
  square_triangle(c);
}

void add(double* g, const double* x, long n, long rows, long stride) {
  const Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>> columns(x, rows, n, Eigen::OuterStride<>(stride));
  Eigen::Map<Eigen::MatrixXd>(g, n, n).selfadjointView<Eigen::Lower>().rankUpdate(columns.transpose());
}

double invert(double* a, long n) {
  Matrix m(a, n, n, Eigen::OuterStride<>(n));
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>>> factor(m);
  if (factor.info() != Eigen::Success) return __builtin_nan("");
  double log_determinant = 0;
  for (Index i = 0; i < n; ++i) log_determinant += 2 * __builtin_log(m(i, i));
  invert_triangle(m);
  square_triangle(m);
  m.triangularView<Eigen::StrictlyUpper>() = m.transpose();
  return log_determinant;
}

void multiply(double* y, const double* x, const double* a, long rows, long n) {
  using Columns = Eigen::Map<const Eigen::MatrixXd>;
  // What a few numbers are, whether with fused multiply-adds or without, depends on where they are in memory.
  const Eigen::MatrixXd in_its_place = Columns(x, rows, n) * Columns(a, n, n);
  Eigen::Map<Eigen::MatrixXd>(y, rows, n) = in_its_place;
}

bool runs_here() {
#ifdef __AVX2__
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return true;
#endif
}

}  // namespace

extern const GramKernel gram;
const GramKernel gram{runs_here, add, invert, multiply};

}  // namespace mmbrdf::MMBRDF_ISA
