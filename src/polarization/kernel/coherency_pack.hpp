// SPDX-License-Identifier: BSD-3-Clause
/// Coherency matrices, one in each lane: their definiteness, eigenvalues and eigenvectors.
#pragma once

#include "polarization/kernel/matrix_pack.hpp"

namespace mmbrdf::MMBRDF_ISA {
namespace {

/// Hermitian, 4 × 4: the diagonal, and what is above it.
struct HermitianPack {
  R diagonal[4];
  C above[6];  // 01 02 03 12 13 23

  /// The place of row < column.
  static constexpr int place(int row, int column) { return row == 0 ? column - 1 : row + column; }
  template <int row, int column>
  MMBRDF_INLINE C get() const {
    if constexpr (row < column)
      return above[place(row, column)];
    else
      return conj(above[place(column, row)]);
  }
  template <int row, int column>
  MMBRDF_INLINE void set(C value) {
    if constexpr (row < column)
      above[place(row, column)] = value;
    else
      above[place(column, row)] = conj(value);
  }
};

/// 4 T of T = ¼ Σ M_ij σ_i ⊗ conj σ_j (theory 6.1), element by element.
MMBRDF_INLINE HermitianPack four_times_coherency(const R (&m)[16]) {
  const R s = m[0] + m[4], d = m[0] - m[4], along = m[1] + m[5], across = m[1] - m[5];
  HermitianPack t;
  t.diagonal[0] = s + along, t.diagonal[1] = s - along;
  t.diagonal[2] = d + across, t.diagonal[3] = d - across;
  t.set<0, 1>({m[2] + m[6], m[3] + m[7]});
  t.set<2, 3>({m[2] - m[6], m[3] - m[7]});
  t.set<0, 2>({m[8] + m[9], -(m[12] + m[13])});
  t.set<1, 3>({m[8] - m[9], m[13] - m[12]});
  t.set<0, 3>({m[10] + m[15], m[11] - m[14]});
  t.set<1, 2>({m[10] - m[15], -(m[11] + m[14])});
  return t;
}

/// The inverse, of 4 T: M_ij = ¼ tr[4 T (σ_i ⊗ conj σ_j)].
MMBRDF_INLINE void matrix_of(const HermitianPack& t, R (&m)[16]) {
  const R quarter(0.25), half(0.5), *d = t.diagonal;
  const R s01 = d[0] + d[1], d01 = d[0] - d[1], s23 = d[2] + d[3], d23 = d[2] - d[3];
  m[0] = quarter * (s01 + s23), m[1] = quarter * (d01 + d23);
  m[4] = quarter * (s01 - s23), m[5] = quarter * (d01 - d23);
  const C a = t.get<0, 1>(), b = t.get<2, 3>(), c = t.get<0, 2>(), e = t.get<1, 3>(), f = t.get<0, 3>(),
          g = t.get<1, 2>();
  m[2] = half * (a.re + b.re), m[6] = half * (a.re - b.re);
  m[3] = half * (a.im + b.im), m[7] = half * (a.im - b.im);
  m[8] = half * (c.re + e.re), m[9] = half * (c.re - e.re);
  m[12] = -(half * (c.im + e.im)), m[13] = half * (e.im - c.im);
  m[10] = half * (f.re + g.re), m[15] = half * (f.re - g.re);
  m[11] = half * (f.im - g.im), m[14] = -(half * (f.im + g.im));
}

/// Whether T + shift is positive definite: the pivots of its Cholesky decomposition, without square roots, are
/// positive. Rounding counts as a shift of some ε tr T (Demmel 1989), far less than realizability_tolerance.
MMBRDF_INLINE Mask is_positive_definite(const HermitianPack& t, R shift) {
  const R p0 = t.diagonal[0] + shift, i0 = R(1.0) / p0;
  const C l1 = i0 * t.get<0, 1>(), l2 = i0 * t.get<0, 2>();
  // What is left without the first row: T_jk − conj(T_0j) T_0k / p0.
  const auto rest = [](C x, C y, C z) {  // z − conj(x) y
    return C{fnma(x.im, y.im, fnma(x.re, y.re, z.re)), fma(x.im, y.re, fnma(x.re, y.im, z.im))};
  };
  const R p1 = fnma(i0, norm(t.get<0, 1>()), t.diagonal[1] + shift), i1 = R(1.0) / p1;
  R p2 = fnma(i0, norm(t.get<0, 2>()), t.diagonal[2] + shift);
  R p3 = fnma(i0, norm(t.get<0, 3>()), t.diagonal[3] + shift);
  const C s12 = rest(l1, t.get<0, 2>(), t.get<1, 2>()), s13 = rest(l1, t.get<0, 3>(), t.get<1, 3>());
  C s23 = rest(l2, t.get<0, 3>(), t.get<2, 3>());
  p2 = fnma(i1, norm(s12), p2);
  p3 = fnma(i1, norm(s13), p3);
  s23 = rest(i1 * s12, s13, s23);
  const R last = fma(p2, p3, -norm(s23));
  return (p0.v > 0.0) & (p1.v > 0.0) & (p2.v > 0.0) & (last.v > 0.0);
}

/// A turn of the axes p and q that makes T_pq 0: the columns become c e_p − conj(s) e_q and s e_p + c e_q.
struct TurnPack {
  R c;
  C s;
  R change;  // of the diagonal: −, +
};

/// The smaller of the two turns (Jacobi). Elements below 1e-17 count as 0: they are far below the rounding of those on
/// the diagonal, of which the largest is above ⅛.
MMBRDF_INLINE TurnPack turn_of(R a, R b, C z) {
  const R square = norm(z), h = R(0.5) * (b - a);
  const auto counts = square.v > 1e-34;
  const R r = sqrt(fma(h, h, square)), d = absolute(h) + r;
  const R q = R(0.5) / select(counts, r * d, R(1.0)), inverse = sqrt(q);
  const R signed_inverse = copy_sign(inverse, h), zero(0.0);
  return {select(counts, d * inverse, R(1.0)),
          {select(counts, z.re * signed_inverse, zero), select(counts, z.im * signed_inverse, zero)},
          select(counts, copy_sign((square * (r + r)) * q, h), zero)};
}

/// x and y of a row become c x − conj(s) y and s x + c y.
MMBRDF_INLINE void turn_columns(const TurnPack& t, C& x, C& y) {
  const C old = x;
  x = {fnma(t.s.re, y.re, fnma(t.s.im, y.im, t.c * x.re)), fnma(t.s.re, y.im, fma(t.s.im, y.re, t.c * x.im))};
  y = {fma(t.s.re, old.re, fnma(t.s.im, old.im, t.c * y.re)), fma(t.s.re, old.im, fma(t.s.im, old.re, t.c * y.im))};
}

template <int k, int p, int q>
MMBRDF_INLINE void turn_row(const TurnPack& turn, HermitianPack& t) {
  C x = t.get<k, p>(), y = t.get<k, q>();
  turn_columns(turn, x, y);
  t.set<k, p>(x);
  t.set<k, q>(y);
}

/// Eigenvectors while they are found: element of row k of column p is v[4 k + p].
struct VectorsPack {
  C v[16];
  MMBRDF_INLINE VectorsPack() {
    for (int i = 0; i < 16; ++i) v[i] = {R(i % 5 == 0 ? 1.0 : 0.0), R(0.0)};
  }
  template <int p, int q>
  MMBRDF_INLINE void turn(const TurnPack& t) {
    for (int k = 0; k < 16; k += 4) turn_columns(t, v[k + p], v[k + q]);
  }
};
/// Where nobody asks for them.
struct NoVectors {
  template <int p, int q>
  MMBRDF_INLINE void turn(const TurnPack&) {}
};

/// Two turns that do not touch each other.
template <int p, int q, int k, int l, class Vectors>
MMBRDF_INLINE void turn_both(HermitianPack& t, Vectors& vectors) {
  const TurnPack first = turn_of(t.diagonal[p], t.diagonal[q], t.get<p, q>());
  const TurnPack second = turn_of(t.diagonal[k], t.diagonal[l], t.get<k, l>());
  t.diagonal[p] = t.diagonal[p] - first.change, t.diagonal[q] = t.diagonal[q] + first.change;
  t.diagonal[k] = t.diagonal[k] - second.change, t.diagonal[l] = t.diagonal[l] + second.change;
  t.set<p, q>({R(0.0), R(0.0)});
  t.set<k, l>({R(0.0), R(0.0)});
  turn_row<k, p, q>(first, t);
  turn_row<l, p, q>(first, t);
  turn_row<p, k, l>(second, t);
  turn_row<q, k, l>(second, t);
  vectors.template turn<p, q>(first);
  vectors.template turn<k, l>(second);
}

/// Makes T diagonal: its eigenvalues are then the diagonal, in no order. Lanes that are done turn by nothing, so that
/// what a lane gives does not depend on how long its neighbours take. Four sweeps are usual.
template <class Vectors>
MMBRDF_INLINE void diagonalize(HermitianPack& t, Vectors& vectors) {
  constexpr int most_sweeps = 20;
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    Mask left = R(0.0).v > 0.0;
    for (const C& z : t.above) left |= norm(z).v > 1e-34;
    if (!any(left)) return;
    turn_both<0, 1, 2, 3>(t, vectors);
    turn_both<0, 2, 1, 3>(t, vectors);
    turn_both<0, 3, 1, 2>(t, vectors);
  }
}

/// Eigenvalues, rising; with them the columns of `vectors`.
template <class Columns>
MMBRDF_INLINE void sort_rising(R (&values)[4], Columns exchange) {
  const auto order = [&](int low, int high) {
    const Mask wrong = values[low].v > values[high].v;
    const R smaller = select(wrong, values[high], values[low]);
    values[high] = select(wrong, values[low], values[high]);
    values[low] = smaller;
    exchange(wrong, low, high);
  };
  order(0, 1), order(2, 3), order(0, 2), order(1, 3), order(1, 2);
}

/// The nearest numbers ≥ 0 with the given sum ≥ 0 to rising numbers: max(λ − τ, 0) with one τ for all.
MMBRDF_INLINE void project_on_simplex(const R (&rising)[4], R sum, R (&result)[4]) {
  // λ_max − τ with one positive number, then with more, as long as the next is positive; λ − τ itself would cancel.
  R largest = sum, differences(0.0);
  Mask goes_on = sum.v == sum.v;
  constexpr double parts[] = {0.5, 1.0 / 3, 0.25};
  for (int q = 1; q < 4; ++q) {
    const R below = rising[3 - q] - rising[3];
    differences = differences + below;
    const R candidate = (sum - differences) * R(parts[q - 1]);
    goes_on &= (candidate + below).v > 0.0;
    largest = select(goes_on, candidate, largest);
  }
  for (int q = 0; q < 4; ++q) {
    const R value = largest + (rising[q] - rising[3]);
    result[q] = select(value.v > 0.0, value, R(0.0));
  }
}

}  // namespace
}  // namespace mmbrdf::MMBRDF_ISA
