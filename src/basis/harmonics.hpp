// SPDX-License-Identifier: BSD-3-Clause
/// Modes of what a real sample is besides isotropic: its azimuthal harmonics, what mirror symmetry forbids, and a
/// difference between source and receiver. All but the last are reciprocal.
///
///   q     harmonic: what k + l exceeds that of the isotropic family by. f(φ + α) = e^{iqα} f(φ), in turned axes
///   Z     V_n^k(incident) V_m^l(reflected); each Z comes as c Z with c = 1, c = i, or both
///
/// Two modes of the same functions of both directions are one: the twin that comes first in (n, m, k, l) is left out.
#pragma once

#include <span>
#include <vector>

#include "mmbrdf/basis/modes.hpp"

namespace mmbrdf {

/// Of m11 … m44.
Element element_of(Function function);

/// k + l of the isotropic family, 2 (σ_out + σ_in).
int spin_sum(Function function);

/// Terms of a mode of the isotropic family's functions, whatever k + l, with iZ in place of Z if imaginary. For 14 the
/// two are exchanged, as its isotropic modes are of iZ.
std::vector<Term> complex_terms(const Mode& mode, bool imaginary = false);

/// Re (Z(i,r) − Z(r,i)) in element 11, which reciprocity forbids.
std::vector<Term> antisymmetric_terms(const Mode& mode);

struct FreeMode {
  enum class Kind { harmonic, odd, nonreciprocal };
  Kind kind;
  int harmonic;  ///< |q|; 0 for the two others
  int degree;    ///< n + m
  std::vector<Term> terms;
};

/// Highest |q|.
inline constexpr int highest_harmonic = 3;

/// All of a block of the isotropic family: harmonics 1 … 3 and the mirror-odd modes with n, m ≤ order, and of element
/// 11 the non-reciprocal ones, k + l = 0, with n, m ≤ nonreciprocal_order.
std::vector<FreeMode> free_modes(const Block& block, int order, int nonreciprocal_order);

}  // namespace mmbrdf
