// SPDX-License-Identifier: BSD-3-Clause
/// Mueller matrices of the optical elements of which polarimeters and their references are made. Axes e1, e2 and signs
/// are those of mueller.hpp; for a wafer in reflection e1 is s, e2 is p. Angles in radians.
#pragma once

#include <complex>

#include "mmbrdf/polarization/mueller.hpp"

namespace mmbrdf {

/// An element turned by `azimuth` from e1 towards e2: rotator(−azimuth) · element · rotator(azimuth).
Mueller rotated(const Mueller& element, double azimuth);

/// An element that keeps e1 and e2 apart, with amplitudes r1 and r2 on them: r2 / r1 = tan psi · exp(i delta).
struct DiattenuatorRetarder {
  double tau = 1;    ///< of unpolarized light: (|r1|² + |r2|²) / 2
  double psi = 0;    ///< 0 … π/2
  double delta = 0;  ///< in (−π, π]
};

/// τ [1 c 0 0; c 1 0 0; 0 0 S cos Δ, −S sin Δ; 0 0 S sin Δ, S cos Δ], c = cos 2ψ, S = sin 2ψ. Its eigenvalues are
/// |r1|² = 2 τ cos² ψ, |r2|² = 2 τ sin² ψ and τ S exp(±iΔ).
Mueller mueller(const DiattenuatorRetarder& element);

/// A polarizer that passes all of the light along `azimuth` and the part `extinction` of that across it, with `phase`
/// between the two. Throws std::invalid_argument unless extinction is in [0, 1] and all is finite.
///   polarizer(0) is ½ [1 1 0 0; 1 1 0 0; 0; 0].
Mueller polarizer(double azimuth, double extinction = 0, double phase = 0);

/// A lossless retarder, its axis at `azimuth`: it multiplies the field across the axis by exp(i retardance).
Mueller retarder(double retardance, double azimuth = 0);

/// A layer on an absorbing half-space, in air. Indices are n + ik with k ≥ 0, for the time factor exp(−iωt).
struct Film {
  std::complex<double> film_index = 1;
  double thickness = 0;  ///< micrometres
  std::complex<double> substrate_index = 1;
};

/// Specular reflection of a film at a wavelength (micrometres) and angle of incidence, in the axes (s, p, k) of each
/// beam: Δ = π at normal incidence. Fresnel's coefficients of one layer. Throws std::invalid_argument for an angle that
/// is not in [0, π/2), indices with n ≤ 0 or k < 0, a negative thickness, a wavelength that is not positive, or numbers
/// so large that no finite reflection is left.
DiattenuatorRetarder reflection(const Film& film, double wavelength, double theta_i);

}  // namespace mmbrdf
