// SPDX-License-Identifier: BSD-3-Clause
/// How the quantities of analysis.hpp follow the elements of the matrix, and with that their standard uncertainties in
/// first order (GUM 2008, 5.1.2 and 5.2.2).
///
/// A gradient is a Mueller whose element ij is the derivative with respect to M_ij, in the units of the quantity over
/// those of M. Arguments and refusals are those of the function of analysis.hpp with the same name; results are finite.
/// Where a quantity has a corner, as D has where all light is depolarized, first order says nothing: the gradient is as
/// told below, and draws (draws.hpp) are the way.
#pragma once

#include "mmbrdf/polarization/covariance.hpp"

namespace mmbrdf {

/// Of the depolarization D: ∂D/∂M_ij = M_ij / (3 D M11²), ∂D/∂M11 = −D / M11 (theory 4.4). 0 where D = 0.
Mueller depolarization_gradient(const Mueller& m);

/// Of the diattenuation d: ∂d/∂M_1j = M_1j / (d M11²), ∂d/∂M11 = −d / M11. 0 where d = 0.
Mueller diattenuation_gradient(const Mueller& m);

/// Of the polarizance p: ∂p/∂M_i1 = M_i1 / (p M11²), ∂p/∂M11 = −p / M11. 0 where p = 0.
Mueller polarizance_gradient(const Mueller& m);

/// The gradients of f_ss, f_sp, f_ps, f_pp, the same for all matrices in the sp frame: ½, a/2, b/2 and ab/2 in the
/// elements 11, 12, 21 and 22.
struct PolarizedBrdfGradients {
  Mueller ss, sp, ps, pp;
};
PolarizedBrdfGradients co_and_cross_polarized_gradients();

/// Of the smallest eigenvalue λ of the coherency matrix T: ∂λ/∂M_ij = C_ij / 4, where C is Cloude's component of λ,
/// with C_11 = 1. Eigenvalues that are equal to realizability_tolerance × M11 count as one, and the gradient is that of
/// their mean: a single one of them has none. M11 must be positive.
Mueller smallest_eigenvalue_gradient(const Mueller& m);

/// Of the smallest eigenvalue of the coherency matrix divided by M11: λ / M11.
Mueller realizability_margin_gradient(const Mueller& m);

/// Of the purity: M_ij / (2 M11²), and for 11 what makes the purity independent of the scale of M.
Mueller purity_gradient(const Mueller& m);

/// Of the entropy: Σ w_q ∂p_q/∂M, w_q = −(log₄ p_q − their mean), over the eigenvalues p_q of T / M11 that are above
/// realizability_tolerance. The slope for those at 0 is infinite, and left out.
Mueller entropy_gradient(const Mueller& m);

/// Of √(S2² + S3² + S4²) / S1 of S = M · incident: 0 where that is 0.
Mueller degree_of_polarization_gradient(const Mueller& m, const Stokes& incident);

/// gᵀ V h: covariance of two quantities with these gradients, from the covariance of the elements of M, in the same
/// frame. Beyond the largest double: that number.
double covariance(const Mueller& gradient, const Mueller& other, const MuellerCovariance& of_elements);

/// √(gᵀ V g): standard uncertainty of a quantity with this gradient, from the covariance of the elements of M.
double standard_uncertainty(const Mueller& gradient, const MuellerCovariance& of_elements);

/// ⅓ Σ_{ij≠11} σ_ij²: by how much errors of the elements m_ij = M_ij / M11, of standard deviations σ_ij, raise the
/// expected D² (theory 4.5). Speckle is fully polarized light, so it makes a sample appear to depolarize less. For
/// measured matrices σ is their noise; for those of a fit standard_uncertainty() of PreparedUncertainty::normalized().
/// Element 11 of `sigma` does not count. Throws std::invalid_argument for a σ that is negative or not finite.
double squared_depolarization_bias(const Mueller& sigma);

/// √max(0, D² − bias): of a measured or fitted M with these errors of m_ij.
double corrected_depolarization(const Mueller& m, const Mueller& sigma);

}  // namespace mmbrdf
