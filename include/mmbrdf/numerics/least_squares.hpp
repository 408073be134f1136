// SPDX-License-Identifier: BSD-3-Clause
/// Linear least squares over rows that arrive in any order, in any number of blocks, in any number of places.
#pragma once

#include <cstddef>
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

class RowColumns;  // these two are of the library's own
class SvdCache;

/// Holds only the triangle of A = QR, Qᵀb and the norm of the rest: (n + 1)² numbers, however many rows are added.
/// Rows are folded in by Householder reflections, never by normal equations. Several columns b may share their rows:
/// rows cost the square of their length, values only the length.
///
/// Laws: the order of rows and how they are split among accumulators change a well-conditioned solution only in the
/// last digits; merge() gives what adding all rows to one accumulator gives.
class LeastSquares {
 public:
  /// `values` are columns b. Throws std::invalid_argument unless 1 ≤ unknowns ≤ max_unknowns and values ≥ 1.
  explicit LeastSquares(int unknowns, int values = 1);

  /// Adds rows of A (rows × unknowns, row-major) and of b (rows × values), each multiplied by the square root of its
  /// weight. Empty weights mean 1. Throws std::invalid_argument, and changes nothing, if the sizes do not fit, a number
  /// is not finite, or a weight is negative.
  void add(std::span<const double> rows, std::span<const double> values, std::span<const double> weights = {});

  /// Rows of [A b], already weighted, of which `count` have a weight other than 0. They are used up.
  void add(RowColumns& rows, long count);

  /// As if all of other's rows had been added here. Throws std::invalid_argument if the unknowns or the columns of
  /// values differ in number.
  void merge(const LeastSquares& other);

  /// The problem of one column of values alone, from 0.
  LeastSquares of(int value) const;

  /// Whether both have the same triangle of the unknowns, to the last bit: that of the same rows, added alike.
  bool has_rows_of(const LeastSquares& other) const;

  /// Problems with one column of values, of the same rows, as one: each column is divided by its divisor.
  static LeastSquares beside(std::span<const LeastSquares* const> problems, std::span<const double> divisors);

  /// The problem whose unknowns are this one's, once for each factor: each row a, with value b, becomes
  /// [factors[0] a, factors[1] a, …] with value value_factor × b. For coefficients that are polynomials of something
  /// that all rows share. Throws std::invalid_argument without factors or if one is not finite.
  LeastSquares repeated(std::span<const double> factors, double value_factor = 1) const;
  /// As if other.repeated(factors, value_factor) had been merged, in one step.
  void merge_repeated(const LeastSquares& other, std::span<const double> factors, double value_factor = 1);

  /// The problem that has some of the unknowns only, in this order; the others are 0. Positions count from 0. Throws
  /// std::invalid_argument for none of them, or one that there is not or that comes twice.
  LeastSquares restricted(std::span<const std::size_t> unknowns) const;
  /// Each of several problems with one column of values so, and each merged with the one at the same place of `others`:
  /// to the last bit what the functions of one problem do, but rows that problems share are worked on once.
  /// Throws std::invalid_argument as those do, for more columns of values, and for another number of others.
  static std::vector<LeastSquares> restricted(std::span<const LeastSquares* const> problems,
                                              std::span<const std::size_t> unknowns);
  static void merge(std::span<LeastSquares* const> problems, std::span<const LeastSquares* const> others);

  /// ‖A x − b‖ for any x of the right size, of the first column of values.
  double residual_norm(std::span<const double> x) const;

  /// Aᵀ A, n × n, and Aᵀ b of the first column of values. For covariances: to solve with them would square the
  /// condition number.
  std::vector<double> normal_matrix() const;
  std::vector<double> normal_vector() const;

  int unknowns() const { return unknowns_; }
  int values() const { return values_; }
  long rows() const { return rows_; }

  /// Everything there is of one column of values, for sending or saving: unknowns + 1 columns of the triangle of
  /// [A b], row by row from the diagonal on, then the number of rows: state_size(n) numbers. The pivots may have either
  /// sign.
  std::vector<double> state() const;
  /// Throws std::invalid_argument unless the numbers are a state of this many unknowns.
  static LeastSquares from_state(int unknowns, std::span<const double> state);
  static constexpr std::size_t state_size(int n) {
    return static_cast<std::size_t>(n + 1) * static_cast<std::size_t>(n + 2) / 2 + 1;
  }

  /// Of the only column of values. Rank is counted with singular values above `tolerance` × the largest. Throws
  /// std::invalid_argument unless 0 ≤ tolerance < 1. Triangles in the cache are not decomposed again.
  Solution solve(double tolerance = default_rank_tolerance, SvdCache* known = nullptr) const;

  /// The solution over all columns of values b_v together, if row a with value b_v stands for the row
  /// [f_v0 a, f_v1 a, …] with value b_v: of coefficients that are Σ_p f_vp x_p. `factors` has a row for each column of
  /// values, row-major, and not more columns. The problem is F ⊗ A, which has the singular values and vectors of F ⊗ R,
  /// products of those of F and of R; it counts `rows` rows. Throws as solve does.
  Solution solve_over(std::span<const double> factors, long rows, double tolerance, SvdCache* known = nullptr) const;

  static constexpr double default_rank_tolerance = 1e-10;  ///< fits have their own: FitOptions::rank_tolerance
  static constexpr int max_unknowns = 2048;

 private:
  std::size_t height() const { return static_cast<std::size_t>(unknowns_) + 1; }
  std::size_t width() const { return static_cast<std::size_t>(unknowns_ + values_); }

  template <class Work>
  static void for_alike(std::span<const LeastSquares* const> problems, std::span<const LeastSquares* const> others,
                        Work work);
  static LeastSquares joined(std::span<const LeastSquares* const> problems, std::span<const std::size_t> which);

  /// Column j of the triangle, multiplied by a factor, as column `to`.
  void copy_column(std::size_t j, double factor, RowColumns& rows, std::size_t to) const;

  int unknowns_, values_;
  long rows_ = 0;
  std::vector<double> triangle_;  // height × width, column-major: R, Qᵀb and, in the last row, ± the residual norms
};

}  // namespace mmbrdf
