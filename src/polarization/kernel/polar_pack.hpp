// SPDX-License-Identifier: BSD-3-Clause
/// Lu and Chipman's factors, one matrix in each lane. Vectors are three Packs, 3 × 3 matrices nine, row by row.
#pragma once

#include "numerics/pack.hpp"
#include "polarization/kernel/coherency_pack.hpp"

namespace mmbrdf::MMBRDF_ISA {
namespace {

MMBRDF_INLINE R dot(const R* a, const R* b) { return fma(a[0], b[0], fma(a[1], b[1], a[2] * b[2])); }
MMBRDF_INLINE void cross(const R* a, const R* b, R* out) {
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    out[k] = fms(a[i], b[j], a[j] * b[i]);
  }
}
MMBRDF_INLINE R squares(const R (&x)[9]) { return dot(x, x) + dot(x + 3, x + 3) + dot(x + 6, x + 6); }
/// |x| x⁻ᵀ
MMBRDF_INLINE void cofactors(const R (&x)[9], R (&out)[9]) {
  cross(x + 3, x + 6, out), cross(x + 6, x, out + 3), cross(x, x + 3, out + 6);
}
/// a bᵀ
MMBRDF_INLINE void times_transposed(const R (&a)[9], const R (&b)[9], R (&out)[9]) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out[3 * i + j] = dot(a + 3 * i, b + 3 * j);
}

/// A rotation y near the one of b = h y, h positive definite, made as exact as rounding allows: b yᵀ = h exp Ω, whose
/// skew part has the axis (tr h − h) ω; then one step towards yᵀy = 1.
MMBRDF_INLINE void refine_rotation(const R (&b)[9], R (&y)[9]) {
  R s[9], h[9], adjugate[9], old[9];
  times_transposed(b, y, s);
  const R half(0.5), w[3] = {s[7] - s[5], s[2] - s[6], s[3] - s[1]}, trace = s[0] + s[4] + s[8];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) h[3 * i + j] = i == j ? trace - s[4 * i] : -(half * (s[3 * i + j] + s[3 * j + i]));
  cofactors(h, adjugate);
  const R inverse = R(1.0) / dot(h, adjugate);
  R omega[3];
  for (int k = 0; k < 3; ++k) omega[k] = inverse * dot(adjugate + 3 * k, w);
  for (int k = 0; k < 9; ++k) old[k] = y[k];
  for (int column = 0; column < 3; ++column) {
    const R v[3] = {old[column], old[3 + column], old[6 + column]};
    R first[3], second[3];
    cross(omega, v, first);
    cross(omega, first, second);
    for (int k = 0; k < 3; ++k) y[3 * k + column] = fma(half, second[k], v[k] + first[k]);
  }
  times_transposed(y, y, s);  // y ← y + ½ (1 − y yᵀ) y
  for (int k = 0; k < 9; ++k) old[k] = y[k], s[k] = half * ((k % 4 == 0 ? R(1.0) : R(0.0)) - s[k]);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      y[3 * i + j] =
          fma(s[3 * i], old[j], fma(s[3 * i + 1], old[3 + j], fma(s[3 * i + 2], old[6 + j], old[3 * i + j])));
}

/// The rotation of b = h y, |b| > 0: Newton's iteration y ← ½ (γ y + y⁻ᵀ / γ), with γ as Higham (1986) has it. Lanes
/// that are done stay.
MMBRDF_INLINE void rotation_of(const R (&b)[9], R (&y)[9]) {
  constexpr int most = 20;
  for (int k = 0; k < 9; ++k) y[k] = b[k];
  Mask left = b[0].v == b[0].v;
  for (int i = 0; i < most && any(left); ++i) {
    R inverse[9];
    cofactors(y, inverse);
    const R over = R(1.0) / dot(y, inverse);
    for (R& element : inverse) element = over * element;
    const R gamma = sqrt(sqrt(squares(inverse) / squares(y))), own = R(0.5) * gamma, other = R(0.5) / gamma;
    R moved(0.0);
    for (int k = 0; k < 9; ++k) {
      const R next = fma(own, y[k], other * inverse[k]), step = next - y[k];
      moved = fma(step, step, moved);
      y[k] = select(left, next, y[k]);
    }
    left &= moved.v > 1e-10;  // it converges quadratically, and is refined
  }
  refine_rotation(b, y);
  refine_rotation(b, y);
}

/// Depolarizer, retarder and diattenuator of n with n11 = 1, as decompositions.cpp has them, where nothing is singular;
/// `intensity` is M11. Returns where it is.
MMBRDF_INLINE Mask lu_chipman(const R (&n)[16], R intensity, R (&depolarizer)[16], R (&retarder)[16],
                              R (&diattenuator)[16]) {
  const R zero(0.0), one(1.0), half(0.5), *d = n + 1;
  const R length = sqrt(dot(d, d)), a = sqrt((one - length) * (one + length));
  const R over_length = select(length.v > 0.0, one / select(length.v > 0.0, length, one), zero);
  const R axis[3] = {over_length * d[0], over_length * d[1], over_length * d[2]};
  const R over_plus = one / (one + length), over_minus = one / (one - length), over_a = one / a;
  R x[9];
  for (int row = 0; row < 3; ++row) {
    const R *b = n + 4 * row + 5, first = n[4 * row + 4], along = dot(b, axis);
    R across[3];
    for (int k = 0; k < 3; ++k) across[k] = fnma(along, axis[k], b[k]);
    const R rest = dot(across, axis);
    for (int k = 0; k < 3; ++k) across[k] = fnma(rest, axis[k], across[k]);
    const R plus = (first + along) * over_plus, minus = (first - along) * over_minus;
    depolarizer[4 * row + 4] = half * (plus + minus);
    for (int k = 0; k < 3; ++k) x[3 * row + k] = fma(half * (plus - minus), axis[k], over_a * across[k]);
  }
  R cofactor[9], y[9], product[9];
  cofactors(x, cofactor);
  const R determinant = dot(x, cofactor), size = squares(x), sign = copy_sign(one, determinant);
  // With σ1 σ2 at most half of the sum of squares, the last bound leaves no σ3 that the ranks of lu_chipman() count as 0.
  const Mask singular = (length.v > 1 - 1e-6) | (absolute(determinant).v < (R(1e-8) * size * sqrt(size)).v) |
                        (absolute(determinant).v < (R(1e-12) * size).v) | (size.v < 1e-20);
  for (int k = 0; k < 9; ++k) x[k] = select(singular, k % 4 == 0 ? one : zero, sign * x[k]);
  rotation_of(x, y);
  times_transposed(x, y, product);
  depolarizer[0] = retarder[0] = one;
  for (int j = 1; j < 4; ++j) depolarizer[j] = retarder[j] = zero;
  for (int i = 0; i < 3; ++i) {
    retarder[4 * i + 4] = zero;
    for (int j = 0; j < 3; ++j) {
      depolarizer[4 * i + 5 + j] = sign * (half * (product[3 * i + j] + product[3 * j + i]));
      retarder[4 * i + 5 + j] = y[3 * i + j];
    }
  }
  const R factor = one / (one + a);
  diattenuator[0] = intensity;
  for (int i = 0; i < 3; ++i) {
    diattenuator[i + 1] = diattenuator[4 * i + 4] = intensity * d[i];
    for (int j = 0; j < 3; ++j) {
      const R outer = factor * (d[i] * d[j]);
      diattenuator[4 * i + 5 + j] = intensity * (i == j ? a + outer : outer);
    }
  }
  return ~singular;
}

}  // namespace
}  // namespace mmbrdf::MMBRDF_ISA
