// SPDX-License-Identifier: BSD-3-Clause
/// Fourier moments of a Mueller BRDF in azimuth, as codes of radiative transfer take a surface:
///
///   f(phi) = Σ_m C_m cos m phi + S_m sin m phi,      phi = phi_r − phi_i,      m = 0 … highest_moment
///
/// in sr⁻¹ and the frame sp: Stokes vectors are about the meridian plane of each beam, (s, p) as in geometry.hpp. The weight
/// of each m is 1: C_m is 1/π times the integral of f cos m phi over the circle, and half that for m = 0. Forward
/// scattering is phi = π; for codes that count from there each m has the factor (−1)^m.
///
/// They come from the modes in closed form, at any polar angle. Of a model that does not depend on how the sample is turned
/// f is a finite trigonometric polynomial, in the frame sp too, so that no moment is left out and none is an estimate (theory
/// 5.4).
#pragma once

#include <span>
#include <vector>

#include "mmbrdf/model/prepared.hpp"

namespace mmbrdf {

/// At one pair of polar angles. Elements that were not measured are NaN.
struct FourierMoments {
  std::vector<Mueller> cosine, sine;  ///< of m = 0, 1, …; sine[0] is 0
};

/// The highest m: order of f11 + order of the others + 2, 13 for orders 7 and 4, or less where modes are missing; 0 of a
/// perfect diffuser. Throws std::invalid_argument for a model that depends on the azimuth of the source: the family
/// anisotropic, and germer2017 as printed.
int highest_moment(const PreparedModel& model);

/// Whether M(−phi) = P M(phi) P, P = diag(1, 1, −1, −1): elements with one index in {1, 2} and one in {3, 4} are sums of
/// sines of phi, all others of cosines. By its modes, whatever their coefficients. Those of isotropic and the published
/// ones of germer2017 are so, and f11 always is; files of germer2017 may have others. Throws as highest_moment.
bool is_its_own_mirror_image(const PreparedModel& model);

/// At each pair of cosines of polar angles, those of the source rising fastest: moments[r × mu_incident.size() + i].
/// Throws std::invalid_argument as highest_moment, and for a cosine that is not in [0, 1].
std::vector<FourierMoments> fourier_moments(const PreparedModel& model, std::span<const double> mu_incident,
                                            std::span<const double> mu_reflected);
FourierMoments fourier_moments(const PreparedModel& model, double mu_incident, double mu_reflected);

/// The BRDF that moments add up to at phi = phi_r − phi_i (radians), frame sp; to moment_error × f11 that of the model.
Mueller resummed(const FourierMoments& moments, double phi);
inline constexpr double moment_error = 1e-12;

}  // namespace mmbrdf
