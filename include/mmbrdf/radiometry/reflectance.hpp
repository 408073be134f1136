// SPDX-License-Identifier: BSD-3-Clause
/// Radiometric quantities of a model: reflectances in closed form, and means over finite apertures.
///
/// Integrals over the hemisphere include directions beyond the fitted range, where the model extrapolates. Wavelengths
/// are in micrometres. All functions throw std::invalid_argument for an invalid model, wavelength or direction.
#pragma once

#include <numbers>
#include <vector>

#include "mmbrdf/geometry/apertures.hpp"
#include "mmbrdf/model/prepared.hpp"

namespace mmbrdf {
/// Slopes of the directional-hemispherical reflectance over the coefficients of the modes of element 11, for one power
/// of the wavelength and without reflectance table: it is linear in them. Throws std::invalid_argument for an invalid
/// direction, or modes that are not of the family.
std::vector<double> directional_hemispherical_slopes(const Block& f11, Family family, DiscMapping mapping,
                                                     const Direction& incident);

/// Directional-hemispherical reflectance for unpolarized light, ∫ f11 cos θ_r dΩ_r over the hemisphere, reflectance
/// table included (theory 5.1). Dimensionless. For a reflectance of about 1 exact to dhr_error: the integral of each
/// mode is known,
///   ∫ R_n^0 cos θ dΩ = π (n = 0), −π/3 (n = 2), else 0 for lambert;   π (n = 0), else 0 for projected.
double directional_hemispherical_reflectance(const Model& model, double wavelength, const Direction& incident);
inline constexpr double dhr_error = 1e-14;

/// Directional-hemispherical reflectance for incident light of any polarization, in the sp frame of the incident beam:
/// s is {1, 1, 0, 0} and p is {1, −1, 0, 0}. Reflected flux, whatever its polarization, per incident flux. Integrated
/// with hemisphere_nodes. Throws std::invalid_argument if the light cannot exist (degree_of_polarization).
double directional_hemispherical_reflectance(const Model& model, double wavelength, const Direction& incident,
                                             const Stokes& light_sp);

/// Hemispherical-directional reflectance: radiance reflected into a direction under uniform unpolarized illumination
/// from the whole hemisphere, per radiance of the perfect diffuser, as seen through an analyzer that passes the light
/// `analyzer_sp`, in the sp frame of the reflected beam. Of a reciprocal model it is the directional-hemispherical
/// reflectance for incident light from there with the third Stokes component of the opposite sign.
double hemispherical_directional_reflectance(const Model& model, double wavelength, const Direction& reflected);
double hemispherical_directional_reflectance(const Model& model, double wavelength, const Direction& reflected,
                                             const Stokes& analyzer_sp);

/// Bihemispherical reflectance (white-sky albedo): reflected per incident flux under uniform unpolarized illumination,
/// (1/π) ∫ DHR cos θ_i dΩ_i, in closed form; of published coefficients a00/2 − a20/√6 + a22/6. Exact to dhr_error.
double bihemispherical_reflectance(const Model& model, double wavelength);

/// Nodes with which Aperture::hemisphere().quadrature(nodes) gives the two integrals over Stokes vectors exactly but
/// for rounding: a row or column of the matrix, in the sp frame of the fixed beam, times cos θ is a polynomial of 1 −
/// cos θ after the integral over azimuth. For orders 7, 4 and the lambert mapping 4, of degree 6; of the azimuths 12
/// would do for the first integral.
int hemisphere_nodes(const Model& model);
int hemisphere_nodes(const Orders& orders, DiscMapping mapping);

/// π f11: the reflectance factor, and with luminance in the place of radiance the radiance factor. 1 for the perfect
/// diffuser.
constexpr double reflectance_factor(double f11) { return std::numbers::pi * f11; }

struct AverageOptions {
  double tolerance = 1e-10;           ///< relative to the largest element, 1e-13 or more
  long most_geometries = 10'000'000;  ///< in one rule
};

/// The mean of a BRDF over two apertures.
struct Average {
  Mueller mueller;  ///< sr⁻¹, frame xy
  double error;     ///< estimate of the quadrature's error in any element, sr⁻¹
  int nodes;        ///< of the rule behind `mueller`: mean_rule(source, receiver, nodes)
  long geometries;  ///< of this rule
  bool converged;   ///< whether the tolerance was reached
};

/// Mean of M over a source and a receiver, weighted with projected solid angle on both sides: the conical-conical BRDF
/// of Nicodemus et al. 1977, as measured under uniform incident radiance. Matrices are averaged in the xy frame, where
/// they are smooth. Nodes are increased until two rules in turn agree to the tolerance, or to evaluation_error × the
/// mean of |f11|, where the mean is 0, and have the projected solid angles of the apertures; the difference, with what is
/// missed of those and the error of evaluation, is the error given for the finer one. `converged` is false where the next rule would have more than
/// most_geometries, as it may be for an aperture beside and over the normal with a model of the family germer2017: at
/// θ_i = 0 that depends on the azimuth from which one comes. Throws std::invalid_argument unless 1e-13 ≤ tolerance < 1.
Average average(const PreparedModel& model, const Aperture& source, const Aperture& receiver,
                const AverageOptions& options = {});

}  // namespace mmbrdf
