// SPDX-License-Identifier: BSD-3-Clause
/// Vectors of three Packs, 3 × 3 matrices of nine, row by row; diattenuators.
#pragma once

#include "polarization/kernel/matrix_pack.hpp"

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

/// The diattenuator A(d), |d| < 1, whose transmittance of unpolarized light is 1: (1, dᵀ; d, a + d dᵀ / (1 + a)),
/// a² = 1 − d².
struct DiattenuatorPack {
  R d[3], axis[3], length, a, over_plus, over_minus, over_a;

  MMBRDF_INLINE explicit DiattenuatorPack(const R* vector) {
    const R zero(0.0), one(1.0);
    length = sqrt(dot(vector, vector)), a = sqrt((one - length) * (one + length));
    const R over_length = select(length.v > 0.0, one / select(length.v > 0.0, length, one), zero);
    for (int k = 0; k < 3; ++k) d[k] = vector[k], axis[k] = over_length * d[k];
    over_plus = one / (one + length), over_minus = one / (one - length), over_a = one / a;
  }

  /// A row (first, b) becomes (first, b) A(d)⁻¹, in the eigenvectors (1, ±d̂) and those across them.
  MMBRDF_INLINE void take_from(R& first, R* b) const {
    const R half(0.5), along = dot(b, axis);
    R across[3];
    for (int k = 0; k < 3; ++k) across[k] = fnma(along, axis[k], b[k]);
    const R rest = dot(across, axis);
    for (int k = 0; k < 3; ++k) across[k] = fnma(rest, axis[k], across[k]);
    const R plus = (first + along) * over_plus, minus = (first - along) * over_minus;
    first = half * (plus + minus);
    for (int k = 0; k < 3; ++k) b[k] = fma(half * (plus - minus), axis[k], over_a * across[k]);
  }

  /// A row (first, b) becomes (first, b) A(d).
  MMBRDF_INLINE void give_to(R& first, R* b) const {
    const R along = dot(b, d), own = fma(along, R(1.0) / (R(1.0) + a), first);
    first = first + along;
    for (int k = 0; k < 3; ++k) b[k] = fma(a, b[k], own * d[k]);
  }

  /// intensity A(d)
  MMBRDF_INLINE void matrix(R intensity, R (&m)[16]) const {
    const R factor = R(1.0) / (R(1.0) + a);
    m[0] = intensity;
    for (int i = 0; i < 3; ++i) {
      m[i + 1] = m[4 * i + 4] = intensity * d[i];
      for (int j = 0; j < 3; ++j) {
        const R outer = factor * (d[i] * d[j]);
        m[4 * i + 5 + j] = intensity * (i == j ? a + outer : outer);
      }
    }
  }
};

/// (1, 0; 0, rotation)
MMBRDF_INLINE void retarder_of(const R (&rotation)[9], R (&m)[16]) {
  m[0] = R(1.0);
  for (int i = 0; i < 3; ++i) {
    m[i + 1] = m[4 * i + 4] = R(0.0);
    for (int j = 0; j < 3; ++j) m[4 * i + 5 + j] = rotation[3 * i + j];
  }
}
MMBRDF_INLINE void retarder_of_columns(const R (&columns)[9], R (&m)[16]) {
  R rotation[9];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) rotation[3 * i + j] = columns[3 * j + i];
  retarder_of(rotation, m);
}

}  // namespace
}  // namespace mmbrdf::MMBRDF_ISA
