// SPDX-License-Identifier: BSD-3-Clause
/// Radiometric quantities of a model, in closed form.
#pragma once

#include <vector>

#include "mmbrdf/model.hpp"

namespace mmbrdf {

/// A node of a quadrature rule.
struct Node {
  double x, weight;
};

/// Gauss–Legendre nodes on [0, 1], falling: exact for polynomials up to degree 2 count − 1.
/// Throws std::invalid_argument unless count ≥ 1.
std::vector<Node> gauss_legendre(int count);

/// ∫ K_n^0 cos θ dΩ over the hemisphere; all other K integrate to 0.
double projected_integral(int n, DiscMapping mapping);

/// Slopes of the directional-hemispherical reflectance over the coefficients of the modes of element 11, for one power
/// of the wavelength and without reflectance table: it is linear in them. Throws std::invalid_argument for an invalid
/// direction, or modes that are not of the family.
std::vector<double> directional_hemispherical_slopes(const Block& f11, Family family, DiscMapping mapping,
                                                     const Direction& incident);

/// Directional-hemispherical reflectance for unpolarized light, ∫ f11 cos θ_r dΩ_r over the hemisphere, reflectance
/// table included (theory 4.3). Dimensionless. For a reflectance of about 1 exact to dhr_error: the integral of each
/// mode is known,
///   ∫ R_n^0 cos θ dΩ = π (n = 0), −π/3 (n = 2), else 0 for lambert;   π (n = 0), else 0 for projected.
/// The integral includes directions beyond the fitted range, where the model extrapolates.
/// Throws std::invalid_argument for an invalid model, wavelength (micrometres) or direction.
double directional_hemispherical_reflectance(const Model& model, double wavelength, const Direction& incident);
inline constexpr double dhr_error = 1e-14;

}  // namespace mmbrdf
