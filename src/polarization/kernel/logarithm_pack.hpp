// SPDX-License-Identifier: BSD-3-Clause
/// Logarithms, one in each lane.
#pragma once

#include "polarization/kernel/matrix_pack.hpp"

namespace mmbrdf::MMBRDF_ISA {
namespace {

/// log₂ x of normal x > 0, to 2e-16 of the larger of 1 and |log₂ x|. With x = 2^e m, m in [√½, √2), and s = (m − 1) /
/// (m + 1), ln m = 2 (s + s³/3 + s⁵/5 + …); the first term left out is below 1e-18.
MMBRDF_INLINE R log2_of(R x) {
  const Bits bits = bits_of(x), whole = (bits >> 52) & 0x7ff;
  const R m = from_bits((bits & 0xfffffffffffffLL) | (0x3ffLL << 52));
  const auto above = m.v > 1.4142135623730951;
  const R reduced = select(above, R(0.5) * m, m), one(1.0);
  // E + 2⁵² has E in its last bits.
  const R e = from_bits(whole | (0x433LL << 52)) - select(above, R(0x1p52 + 1022), R(0x1p52 + 1023));
  const R s = (reduced - one) / (reduced + one), ss = s * s;
  R sum(1.0 / 23);
  for (int k = 21; k >= 3; k -= 2) sum = fma(sum, ss, R(1.0 / k));
  return fma(R(2 / 0.6931471805599453), fma(sum * ss, s, s), e);
}

}  // namespace
}  // namespace mmbrdf::MMBRDF_ISA
