// SPDX-License-Identifier: BSD-3-Clause
/// Linear least squares over rows that arrive in any order, in any number of blocks, in any number of places.
#pragma once

#include <span>
#include <vector>

namespace mmbrdf {

/// The minimiser of ‖A x − b‖ that has the smallest ‖x‖, from the singular value decomposition A = U S Vᵀ.
struct Solution {
  std::vector<double> x;                ///< n unknowns
  std::vector<double> singular_values;  ///< n, falling
  int rank = 0;                         ///< singular values above tolerance × the largest
  double residual_norm = 0;             ///< ‖A x − b‖
  long rows = 0;                        ///< rows added with a weight other than 0
  std::vector<double> inverse;          ///< (AᵀA)⁺, n × n row-major; the covariance of x for rows of unit variance
  std::vector<double> null_space;       ///< orthonormal combinations that the rows do not determine, (n − rank) × n

  /// Largest singular value over the smallest that was kept; 0 for rank 0.
  double condition() const;
  long degrees_of_freedom() const { return rows - rank; }
  /// ‖A x − b‖² / (rows − rank): the estimated variance of a row of unit weight. 0 without degrees of freedom.
  double variance() const;
  /// Whether the rows determine gᵀx: ‖g − V_r V_rᵀ g‖ ≤ 1e−8 ‖g‖ (theory 4.7).
  bool estimable(std::span<const double> g) const;
};

/// Holds only the triangle of A = QR, Qᵀb and the norm of the rest: (n + 1)² numbers, however many rows are added.
/// Rows are folded in by Householder reflections, never by normal equations.
///
/// Laws: the order of rows and how they are split among accumulators change a well-conditioned solution only in the
/// last digits; merge() gives what adding all rows to one accumulator gives.
class LeastSquares {
 public:
  /// Throws std::invalid_argument unless 1 ≤ unknowns ≤ max_unknowns.
  explicit LeastSquares(int unknowns);

  /// Adds rows of A (rows × unknowns, row-major) and as many values of b, each multiplied by the square root of its
  /// weight. Empty weights mean 1. Throws std::invalid_argument, and changes nothing, if the sizes do not fit, a number
  /// is not finite, or a weight is negative.
  void add(std::span<const double> rows, std::span<const double> values, std::span<const double> weights = {});

  /// As if all of other's rows had been added here. Throws std::invalid_argument if the unknowns differ in number.
  void merge(const LeastSquares& other);

  /// The problem whose unknowns are this one's, once for each factor: each row a, with value b, becomes
  /// [factors[0] a, factors[1] a, …] with value value_factor × b. For coefficients that are polynomials of something
  /// that all rows share. Throws std::invalid_argument without factors or if one is not finite.
  LeastSquares repeated(std::span<const double> factors, double value_factor = 1) const;

  /// The problem that has some of the unknowns only, in this order; the others are 0. Positions count from 0. Throws
  /// std::invalid_argument for none of them, or one that there is not or that comes twice.
  LeastSquares restricted(std::span<const std::size_t> unknowns) const;

  /// ‖A x − b‖ for any x of the right size.
  double residual_norm(std::span<const double> x) const;

  /// Aᵀ A, n × n, and Aᵀ b. For covariances: to solve with them would square the condition number.
  std::vector<double> normal_matrix() const;
  std::vector<double> normal_vector() const;

  int unknowns() const { return unknowns_; }
  long rows() const { return rows_; }

  /// Everything there is, for sending or saving: unknowns + 1 columns of the triangle of [A b], row by row from the
  /// diagonal on, then the number of rows: n(n+1)/2 + n + 2 numbers. The pivots may have either sign.
  std::vector<double> state() const;
  /// Throws std::invalid_argument unless the numbers are a state of this many unknowns.
  static LeastSquares from_state(int unknowns, std::span<const double> state);

  /// Rank is counted with singular values above `tolerance` × the largest. Throws std::invalid_argument unless
  /// 0 ≤ tolerance < 1.
  Solution solve(double tolerance = default_rank_tolerance) const;

  static constexpr double default_rank_tolerance = 1e-10;
  static constexpr int max_unknowns = 2048;

 private:
  std::size_t width() const { return static_cast<std::size_t>(unknowns_) + 1; }

  int unknowns_;
  long rows_ = 0;
  std::vector<double> triangle_;  // width² numbers, column-major: R, Qᵀb and, in the corner, ± the residual norm
};

}  // namespace mmbrdf
