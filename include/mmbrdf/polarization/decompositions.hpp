// SPDX-License-Identifier: BSD-3-Clause
/// A Mueller matrix as a sequence of a few media, each of which does one thing.
///
/// Of a diattenuator d the matrix is (1, dᵀ; d, √(1−d²) + (1 − √(1−d²)) d̂ d̂ᵀ), of a retarder (1, 0; 0, R) with a
/// rotation R of the Poincaré sphere. Both decompositions are of realizable matrices with M11 > 0; others are refused
/// with std::invalid_argument, and nearest_realizable() makes them so. Factors multiply back to M, in the singular
/// cases too. How well each of them is determined is another matter: with d close to 1 the matrix says little of what
/// comes before or after the diattenuator, and the other factors lose digits as ε / (1 − d).
#pragma once

#include "mmbrdf/polarization/mueller.hpp"

namespace mmbrdf {

/// M = depolarizer · retarder · diattenuator.
struct LuChipman {
  Mueller depolarizer;   ///< (1, 0; P, m_Δ) with m_Δ symmetric
  Mueller retarder;      ///< (1, 0; 0, m_R) with a rotation m_R
  Mueller diattenuator;  ///< M11 × that of the diattenuation vector of M; in units of M
};

/// Polar decomposition. With M' = M M_D⁻¹ = M11 (1, 0; P, m'), m' = m_Δ m_R is a polar decomposition; where |m'| < 0,
/// m_Δ is minus a matrix with eigenvalues ≥ 0. Lu & Chipman 1996.
///
/// Singular cases, where the factors are one choice of many:
///   diattenuation 1 (M = M11 (1, p)(1, d)ᵀ)      P = 0, m_Δ = |p|, m_R the smallest rotation from d to p: an ideal
///                                               polarizer is a diattenuator alone
///   m' = 0 (as for a perfect depolarizer)       m_R = 1
///   m' of rank 1, σ u vᵀ                         m_R the smallest rotation from v to u
///   m' of rank 2                                 m_R the only rotation that the two singular directions leave
/// Ranks are those of singular values above 1e-13. Throws std::invalid_argument if M11 ≤ 0 or M is not realizable.
/// The factors multiply back to lu_chipman_error × M11 if M is realizable to rounding (largest seen: 2e-13).
LuChipman lu_chipman(const Mueller& m);
inline constexpr double lu_chipman_error = 1e-12;

/// Angle in radians, in [0, π], by which a retarder turns the Poincaré sphere: cos = (tr m_R − 1)/2 (Lu & Chipman
/// 1996). Throws std::invalid_argument unless the matrix is M11 (1, 0; 0, rotation) to 1e-9, M11 > 0.
double retardance(const Mueller& retarder);

/// 1 − |tr m_Δ| / 3, in [0, 1]: 0 if nothing is depolarized, 1 for a perfect depolarizer (Lu & Chipman 1996). 0 too
/// where |tr m_Δ| is above 3, as digits lost beside a diattenuator of nearly 1 may leave it. M11 must be positive.
double depolarization_power(const Mueller& depolarizer);

/// M = diattenuator2 · retarder2 · depolarizer · retarder1ᵀ · diattenuator1.
struct SymmetricDecomposition {
  Mueller diattenuator2, retarder2;
  Mueller depolarizer;  ///< diagonal, (d0, d1, d2, ±d3) with d1 ≥ d2 ≥ d3 ≥ 0, in units of M; − where |M| < 0
  Mueller retarder1, diattenuator1;
};

/// Symmetric decomposition. With G = diag(1, −1, −1, −1), (1, −d_1) is the eigenvector of G Mᵀ G M to its largest
/// eigenvalue, and (1, d_2) ~ M (1, −d_1); what remains without the diattenuators, (d0, 0; 0, m'), gives the rest by
/// its singular values. Ossikovski 2009.
///
/// Singular cases:
///   perfect depolarizer, and all that do not polarize        both diattenuations 0
///   no depolarization                                        d_1 = 0 of the many choices, d0 = d1 = d2 = d3
///   diattenuation or polarizance 1 (M11 (1, p)(1, d)ᵀ)        d_1 = d, d_2 = p, depolarizer M11 (1, 0, 0, 0); for an
///                                                            ideal polarizer, |p| = |d| = 1, M11 / 2 (1, 1, 1, 1)
/// Throws std::invalid_argument if M11 ≤ 0 or M is not realizable, and where the factors would not multiply back to
/// symmetric_error × M11: matrices whose depolarizer cannot be diagonal (type II: that eigenvector is completely
/// polarized; Ossikovski 2010), and some that are close to one. Most multiply back to 1e-12.
SymmetricDecomposition symmetric_decomposition(const Mueller& m);
inline constexpr double symmetric_error = 1e-8;

}  // namespace mmbrdf
