// SPDX-License-Identifier: BSD-3-Clause
/// The factors of the symmetric decomposition, one matrix in each lane.
#pragma once

#include "polarization/kernel/vector_pack.hpp"

namespace mmbrdf::MMBRDF_ISA {
namespace {

/// xᵀ G x, G = diag(1, −1, −1, −1).
MMBRDF_INLINE void gram(const R (&x)[16], R (&out)[16]) {
  for (int i = 0; i < 4; ++i)
    for (int j = i; j < 4; ++j) {
      const R below = fma(x[4 + i], x[4 + j], fma(x[8 + i], x[8 + j], x[12 + i] * x[12 + j]));
      out[4 * i + j] = out[4 * j + i] = fms(x[i], x[j], below);
    }
}

/// Divides by the first; returns what it multiplied by.
MMBRDF_INLINE R divide_by_first(R (&x)[16]) {
  const R scale = R(1.0) / x[0];
  for (R& element : x) element = scale * element;
  return scale;
}

/// Of s (1, −d) ~ (1, d), which holds where (1, −d) is an eigenvector of G s, what is missing, squared.
MMBRDF_INLINE R missing(const R (&s)[16], const R* d) {
  R z[4], sum(0.0);
  for (int i = 0; i < 4; ++i) z[i] = s[4 * i] - dot(s + 4 * i + 1, d);
  for (int k = 0; k < 3; ++k) {
    const R rest = fnma(z[0], d[k], z[k + 1]);
    sum = fma(rest, rest, sum);
  }
  return sum;
}

/// d of the eigenvector (1, −d) of N = G nᵀ G n to its largest eigenvalue, by squaring, two at a time:
/// G N² = (G N)ᵀ G (G N). Rounding doubles each time, as does what the nearest eigenvalue is away, so that the best d
/// is kept; 0 if that is one to rounding.
MMBRDF_INLINE void leading_diattenuation(const R (&n)[16], R (&d)[3]) {
  constexpr double sufficient = 2.5e-29;
  constexpr int most = 22;  // then rounding is 2⁴⁴ ε, 1 %
  R first[16], power[16], square[16];
  gram(n, first);
  const R scale = divide_by_first(first);
  for (int e = 0; e < 16; ++e) power[e] = first[e];
  for (int k = 0; k < 3; ++k) d[k] = R(0.0);
  R least = missing(first, d);
  least = select(least.v > (R(1e-30) * scale * scale).v, least, R(0.0));
  for (int i = 0; i < most && any(least.v > sufficient); ++i) {
    gram(power, square);
    gram(square, power);
    divide_by_first(power);
    const R next = missing(first, power + 1);
    const Mask better = (next.v < least.v) & (least.v > sufficient);
    for (int k = 0; k < 3; ++k) d[k] = select(better, power[k + 1], d[k]);
    least = select(better, next, least);
  }
}

/// n = A(d2) x A(d1).
struct SandwichPack {
  DiattenuatorPack behind, in_front;
  R x[16];

  MMBRDF_INLINE SandwichPack(const R (&n)[16], const R (&d2)[3], const R (&d1)[3]) : behind(d2), in_front(d1) {
    R columns[16];
    for (int i = 0; i < 4; ++i) {
      R row[4] = {n[4 * i], n[4 * i + 1], n[4 * i + 2], n[4 * i + 3]};
      in_front.take_from(row[0], row + 1);
      for (int j = 0; j < 4; ++j) columns[4 * j + i] = row[j];
    }
    for (int j = 0; j < 4; ++j) {
      behind.take_from(columns[4 * j], columns + 4 * j + 1);
      for (int i = 0; i < 4; ++i) x[4 * i + j] = columns[4 * j + i];
    }
  }
};

/// Of x = (d0, eᵀ; f, m') the small diattenuations that leave (d0, 0; 0, m'), to first order: e = d0 v1 + m'ᵀ v2,
/// f = d0 v2 + m' v1. 0 where they are not small, as where a singular value of m' is nearly d0; there 1e-9 keeps the
/// others apart from what that one makes of rounding.
MMBRDF_INLINE void small_diattenuations(const R (&x)[16], R (&v2)[3], R (&v1)[3]) {
  const R zero(0.0), *const e = x + 1, f[3] = {x[4], x[8], x[12]}, over = R(1.0) / x[0];
  R columns[9], h[9], adjugate[9], right[3];  // m' / d0; 1 less its square
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) columns[3 * j + i] = over * x[4 * i + 5 + j];
  times_transposed(columns, columns, h);
  for (int k = 0; k < 9; ++k) h[k] = (k % 4 == 0 ? R(1 + 1e-9) : zero) - h[k];
  for (int k = 0; k < 3; ++k) right[k] = over * (e[k] - dot(columns + 3 * k, f));
  cofactors(h, adjugate);
  const R inverse = R(1.0) / dot(h, adjugate);
  for (int k = 0; k < 3; ++k) v1[k] = inverse * dot(adjugate + 3 * k, right);
  for (int k = 0; k < 3; ++k)
    v2[k] = fms(over, f[k], fma(columns[k], v1[0], fma(columns[3 + k], v1[1], columns[6 + k] * v1[2])));
  const Mask small = (dot(v1, v1).v < 1e-4) & (dot(v2, v2).v < 1e-4);
  for (int k = 0; k < 3; ++k) v1[k] = select(small, v1[k], zero), v2[k] = select(small, v2[k], zero);
}

/// (1, d) ← (1, v) A(d): the diattenuation of A(v) A(d).
MMBRDF_INLINE void add_small(const R (&v)[3], const DiattenuatorPack& a, R (&d)[3]) {
  const R along = dot(d, v), over = R(1.0) / (R(1.0) + along), own = fma(along, R(1.0) / (R(1.0) + a.a), R(1.0));
  for (int k = 0; k < 3; ++k) d[k] = over * fma(own, d[k], a.a * v[k]);
}

/// With x = (d0, 0; 0, m') but for rounding: (1, d2) ~ n (1, −d1), then, in the lanes where that is not enough and d1 is
/// no choice, one step of Newton's.
MMBRDF_INLINE SandwichPack sandwich(const R (&n)[16]) {
  R d1[3], d2[3], v1[3], v2[3];
  leading_diattenuation(n, d1);
  const R over = R(1.0) / (n[0] - dot(n + 1, d1));
  for (int k = 0; k < 3; ++k) d2[k] = over * (n[4 * k + 4] - dot(n + 4 * k + 5, d1));
  const SandwichPack first(n, d2, d1);
  const R(&x)[16] = first.x, beside = dot(x + 1, x + 1) + fma(x[4], x[4], fma(x[8], x[8], x[12] * x[12]));
  const Mask more = (beside.v > 1e-29) & (dot(d1, d1).v > 0.0);
  if (!any(more)) return first;
  small_diattenuations(x, v2, v1);
  for (int k = 0; k < 3; ++k) v2[k] = select(more, v2[k], R(0.0)), v1[k] = select(more, v1[k], R(0.0));
  add_small(v2, first.behind, d2);
  add_small(v1, first.in_front, d1);
  return SandwichPack(n, d2, d1);
}

/// Columns p and q of x turn in their plane, and those of v with them, until those of x are perpendicular. Returns
/// where they were not nearly so: one more sweep is needed.
MMBRDF_INLINE Mask make_perpendicular(Mask left, R* xp, R* xq, R* vp, R* vq) {
  const R a = dot(xp, xp), b = dot(xq, xq), z = dot(xp, xq), square = z * z, h = R(0.5) * (b - a);
  const Mask counts = left & (square.v > (R(1e-31) * a * b).v);
  const R r = sqrt(fma(h, h, square)), d = absolute(h) + r;
  const R inverse = sqrt(R(0.5) / select(counts, r * d, R(1.0)));
  const R c = select(counts, d * inverse, R(1.0)), s = select(counts, z * copy_sign(inverse, h), R(0.0));
  const auto turn = [&](R& x, R& y) {
    const R old = x;
    x = fms(c, x, s * y);
    y = fma(c, y, s * old);
  };
  for (int k = 0; k < 3; ++k) turn(xp[k], xq[k]), turn(vp[k], vq[k]);
  return left & (square.v > (R(1e-17) * a * b).v);
}

/// The longer column first, by a quarter of a turn.
MMBRDF_INLINE void order(R* xp, R* xq, R* vp, R* vq) {
  const Mask wrong = dot(xp, xp).v < dot(xq, xq).v;
  const auto turn = [&](R& x, R& y) {
    const R old = x;
    x = select(wrong, y, x);
    y = select(wrong, -old, y);
  };
  for (int k = 0; k < 3; ++k) turn(xp[k], xq[k]), turn(vp[k], vq[k]);
}

/// m' = u diag(σ) vᵀ with rotations u and v, σ1 ≥ σ2 ≥ |σ3|; all by columns.
struct SingularValuesPack {
  R u[9], sigma[3], v[9];

  /// By turns of columns (Hestenes 1958). Lanes that are done turn no more, so that what a lane gives does not depend on
  /// how long its neighbours take.
  MMBRDF_INLINE explicit SingularValuesPack(const R (&m)[16]) {
    constexpr int most_sweeps = 20;
    R x[9];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) x[3 * j + i] = m[4 * i + 5 + j], v[3 * j + i] = R(i == j ? 1.0 : 0.0);
    Mask left = x[0].v == x[0].v;
    for (int sweep = 0; sweep < most_sweeps && any(left); ++sweep) {
      Mask next = make_perpendicular(left, x, x + 3, v, v + 3);
      next |= make_perpendicular(left, x, x + 6, v, v + 6);
      next |= make_perpendicular(left, x + 3, x + 6, v + 3, v + 6);
      left = next;
    }
    order(x, x + 3, v, v + 3), order(x + 3, x + 6, v + 3, v + 6), order(x, x + 3, v, v + 3);
    normalize(x, u);
    const R along = dot(u, x + 3);
    R across[3];
    for (int k = 0; k < 3; ++k) across[k] = fnma(along, u[k], x[3 + k]);
    normalize(across, u + 3);
    cross(u, u + 3, u + 6);
    for (int k = 0; k < 3; ++k) sigma[k] = dot(u + 3 * k, x + 3 * k);
    sigma[1] = select(sigma[1].v < sigma[0].v, sigma[1], sigma[0]);  // but for rounding they are
    const R last = absolute(sigma[2]);
    sigma[2] = copy_sign(select(last.v < sigma[1].v, last, sigma[1]), sigma[2]);
  }

  MMBRDF_INLINE static void normalize(const R* a, R* out) {
    const R over = R(1.0) / sqrt(dot(a, a));
    for (int k = 0; k < 3; ++k) out[k] = over * a[k];
  }

  /// Element i, j of m'.
  MMBRDF_INLINE R product(int i, int j) const {
    R sum = u[i] * sigma[0] * v[j];
    for (int k = 3; k < 9; k += 3) sum = fma(u[k + i] * sigma[k / 3], v[k + j], sum);
    return sum;
  }
};

/// Largest difference between n and the product of its factors.
MMBRDF_INLINE R error_of(const SandwichPack& s, const SingularValuesPack& m, const R (&n)[16]) {
  R columns[16], error(0.0);
  for (int i = 0; i < 4; ++i) {
    R row[4] = {s.x[0], R(0.0), R(0.0), R(0.0)};
    if (i > 0) row[0] = R(0.0);
    for (int j = 1; i > 0 && j < 4; ++j) row[j] = m.product(i - 1, j - 1);
    s.in_front.give_to(row[0], row + 1);
    for (int j = 0; j < 4; ++j) columns[4 * j + i] = row[j];
  }
  for (int j = 0; j < 4; ++j) {
    s.behind.give_to(columns[4 * j], columns + 4 * j + 1);
    for (int i = 0; i < 4; ++i) {
      const R e = absolute(columns[4 * j + i] - n[4 * i + j]);
      error = select(e.v < error.v, error, e);  // NaN stays
    }
  }
  return error;
}

struct SymmetricPack {
  R diattenuator2[16], retarder2[16], depolarizer[16], retarder1[16], diattenuator1[16];
};

/// Of n with n11 = 1, as decompositions.cpp has it, where nothing is singular; `intensity` is M11. Returns where it is,
/// and where the factors multiply back.
MMBRDF_INLINE Mask symmetric_decomposition(const R (&n)[16], R intensity, SymmetricPack& factors) {
  const SandwichPack s = sandwich(n);
  const SingularValuesPack m(s.x);
  s.behind.matrix(R(1.0), factors.diattenuator2);
  retarder_of_columns(m.u, factors.retarder2);
  for (R& element : factors.depolarizer) element = R(0.0);
  factors.depolarizer[0] = intensity * s.x[0];
  for (int k = 0; k < 3; ++k) factors.depolarizer[5 * k + 5] = intensity * m.sigma[k];
  retarder_of_columns(m.v, factors.retarder1);
  s.in_front.matrix(R(1.0), factors.diattenuator1);
  const Mask no_dyad = s.behind.length.v < 1 - 1e-6;  // of dyads those with |d1| near 1 never multiply back
  return no_dyad & (m.sigma[1].v > 1e-10) & (error_of(s, m, n).v < 1e-13);
}

}  // namespace
}  // namespace mmbrdf::MMBRDF_ISA
