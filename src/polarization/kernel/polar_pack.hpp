// SPDX-License-Identifier: BSD-3-Clause
/// Lu and Chipman's factors, one matrix in each lane.
#pragma once

#include "polarization/kernel/vector_pack.hpp"

namespace mmbrdf::MMBRDF_ISA {
namespace {

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
  const R zero(0.0), one(1.0), half(0.5);
  const DiattenuatorPack in_front(n + 1);
  R x[9];
  for (int row = 0; row < 3; ++row) {
    R &first = depolarizer[4 * row + 4], *const b = x + 3 * row;
    first = n[4 * row + 4];
    for (int k = 0; k < 3; ++k) b[k] = n[4 * row + 5 + k];
    in_front.take_from(first, b);
  }
  R cofactor[9], y[9], product[9];
  cofactors(x, cofactor);
  const R determinant = dot(x, cofactor), size = squares(x), sign = copy_sign(one, determinant);
  // With σ1 σ2 at most half of the sum of squares, the last bound leaves no σ3 that the ranks of lu_chipman() count as 0.
  const Mask singular = (in_front.length.v > 1 - 1e-6) | (absolute(determinant).v < (R(1e-8) * size * sqrt(size)).v) |
                        (absolute(determinant).v < (R(1e-12) * size).v) | (size.v < 1e-20);
  for (int k = 0; k < 9; ++k) x[k] = select(singular, k % 4 == 0 ? one : zero, sign * x[k]);
  rotation_of(x, y);
  times_transposed(x, y, product);
  depolarizer[0] = one;
  for (int j = 1; j < 4; ++j) depolarizer[j] = zero;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) depolarizer[4 * i + 5 + j] = sign * (half * (product[3 * i + j] + product[3 * j + i]));
  retarder_of(y, retarder);
  in_front.matrix(intensity, diattenuator);
  return ~singular;
}

}  // namespace
}  // namespace mmbrdf::MMBRDF_ISA
