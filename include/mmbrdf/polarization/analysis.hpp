// SPDX-License-Identifier: BSD-3-Clause
/// What one Mueller matrix says: depolarization, diattenuation, co- and cross-polarized parts, and whether it can
/// exist.
///
/// Every function takes finite matrices of any magnitude and returns finite numbers; elements that are not finite are
/// refused with std::invalid_argument. "M11 must be positive" below means that std::invalid_argument names it where it
/// is not. What would be too large for a double, such as an element divided by a far smaller M11, is a number close to
/// the largest; what would need more digits than a double has below 1e-307 is rounded to a multiple of 5e-324, so that
/// sums and realizability hold to that number, not to a part of M11.
#pragma once

#include <array>
#include <complex>

#include "mmbrdf/polarization/mueller.hpp"

namespace mmbrdf {

/// D = √(Σ_{ij≠11} M_ij²) / (√3 M11): 0 for a perfect depolarizer, 1 where no light is depolarized, never more for a
/// realizable matrix. The same in all frames and conventions. M11 must be positive.
/// Gil & Bernabeu 1986; Germer 2017, Eq. 21 with the square root and f11² that its text lacks.
double depolarization(const Mueller& m);

/// (M12, M13, M14) / M11: the Stokes components, relative to the first, of the incident light that is scattered most.
/// Its length, in [0, 1] for a realizable matrix, is the diattenuation. M11 must be positive. Lu & Chipman 1996.
std::array<double, 3> diattenuation_vector(const Mueller& m);
double diattenuation(const Mueller& m);

/// (M21, M31, M41) / M11: what unpolarized light becomes. Its length, in [0, 1] for a realizable matrix, is the
/// polarizance. M11 must be positive. Lu & Chipman 1996.
std::array<double, 3> polarizance_vector(const Mueller& m);
double polarizance(const Mueller& m);

/// √(S2² + S3² + S4²) / S1, in [0, 1]. Throws std::invalid_argument unless S1 > 0 and the light is not more than
/// completely polarized (to stokes_tolerance).
double degree_of_polarization(const Stokes& light);
inline constexpr double stokes_tolerance = 1e-12;  ///< relative to S1

/// Degree of polarization of M · incident; 0 where there is no light but for rounding, as behind crossed polarizers.
/// May exceed 1 for a matrix that is not realizable. Throws std::invalid_argument for incident light that cannot exist,
/// or if the matrix makes an intensity below 0 or polarized light without intensity.
double degree_of_polarization(const Mueller& m, const Stokes& incident);

/// BRDFs between linear polarizations in sr⁻¹; the first letter is the incident polarization.
struct PolarizedBrdf {
  double ss, sp, ps, pp;
};

/// f_ab = (M11 + a M12 + b M21 + a b M22) / 2 of a matrix in the sp frame, a = +1 for incident s, −1 for p, and b so
/// for the scattered light: what a polarizer in front of the source and another in front of the detector leave
/// (theory 6.1). None is negative for a realizable matrix, and ss + sp + ps + pp = 2 M11.
/// NaN where one of the four elements was not measured; of the others nothing is asked.
PolarizedBrdf co_and_cross_polarized(const Mueller& m_sp);

/// Hermitian, 4 × 4, row-major. In units of M.
using Coherency = std::array<std::complex<double>, 16>;

/// T = ¼ Σ M_ij σ_i ⊗ conj σ_j with σ = {1, diag(1, −1), (0 1; 1 0), (0 −i; i 0)}. tr T = M11, tr T² = ¼ Σ M_ij².
/// A Jones matrix with rows J has T = ½ v v†, v = (J11, J12, J21, J22). Cloude 1986, theory 6.1.
Coherency coherency(const Mueller& m);

/// The inverse: M_ij = tr[T (σ_i ⊗ conj σ_j)]. Only the Hermitian part of T counts.
Mueller from_coherency(const Coherency& t);

/// Eigenvalues of T, rising; they add up to M11. In units of M, exact to eigenvalue_error × |largest element|. The same
/// in all frames and conventions.
std::array<double, 4> coherency_eigenvalues(const Mueller& m);
inline constexpr double eigenvalue_error = 4e-15;

/// Smallest eigenvalue of T divided by M11: at most 1/4 (the perfect depolarizer), 0 at the limit of what can exist
/// (with every matrix that does not depolarize), negative beyond. M11 must be positive.
double realizability_margin(const Mueller& m);

/// Whether a passive or active linear medium can have this matrix: no eigenvalue of T is below −realizability_tolerance
/// × M11. The zero matrix can exist; none else with M11 ≤ 0. Cloude 1986.
bool realizable(const Mueller& m);
inline constexpr double realizability_tolerance = 1e-12;

/// tr T² / M11² = (1 + 3 D²) / 4, D the depolarization parameter: ¼ for a perfect depolarizer, 1 for a Jones matrix.
/// M11 must be positive.
double purity(const Mueller& m);

/// −Σ p log₄ p over the eigenvalues p of T / M11: 1 for a perfect depolarizer, 0 for a Jones matrix. Of a matrix that
/// is not realizable, that of the nearest that is. M11 must be positive. Cloude & Pottier 1995.
double entropy(const Mueller& m);

/// All of the above that compare a matrix with its M11, in the bits of each, from the same eigenvalues. M11 must be positive.
struct Ratios {
  double depolarization, diattenuation, polarizance, purity, realizability_margin, entropy;
};
Ratios ratios(const Mueller& m);

/// M = Σ weights[q] components[q].
struct CloudeDecomposition {
  std::array<double, 4> weights;  ///< eigenvalues of T, falling, in units of M. All M11, one after the other, in sum
  std::array<Mueller, 4> components;  ///< matrices that do not depolarize, with element 11 equal to 1
};

/// At most four parallel media that do not depolarize: the eigenvectors of T. A weight of 0 (to rounding) is that of a
/// component which is not there; a negative weight shows that M is not realizable. The sum of the parts is M to 1e-14 ×
/// |largest element|. Where weights are equal the components are one choice of many. Cloude 1986.
CloudeDecomposition cloude_decomposition(const Mueller& m);

/// The realizable matrix closest to M in the sum of squares of the elements, with the same M11.
struct Projection {
  Mueller matrix;
  double change;  ///< √(Σ (matrix − M)_ij²), in units of M; 0 if M was realizable
};

/// Eigenvalues of T are moved to the nearest point with all ≥ 0 and the same sum (theory 6.2). A realizable matrix
/// comes back with the same bits, so projecting again changes nothing. With M11 = 0 the result is the zero matrix.
/// Throws std::invalid_argument if M11 < 0: no realizable matrix has it.
Projection nearest_realizable(const Mueller& m);

}  // namespace mmbrdf
