// SPDX-License-Identifier: BSD-3-Clause
/// Signs that the readings of a wafer leave open.
#pragma once

#include "polarimetry/calibration_parts.hpp"

namespace mmbrdf::calibration {

/// A wafer as readings show it, with or without the signs of cos 2ψ and of Δ.
struct SeenWafer {
  std::size_t reference = 0;  ///< its place
  DiattenuatorRetarder element;
  bool has_side = false, has_sign = false;
};

/// Gives wafers that have none the signs that are stated with them, and else those of the film at the thickness that
/// fits them best. Throws std::invalid_argument for a film that fits no wafers with these signs, or only without them.
void give_signs(std::vector<SeenWafer>& wafers, std::span<const Reference> references,
                const CalibrationOptions& options);

/// Throws std::invalid_argument unless what the references were found to be has the signs that are stated, and those of
/// the film and of no other instrument. Sets the thickness and misfit of the film.
void require_signs(Calibration& calibration, std::span<const Reference> references, const CalibrationOptions& options);

/// Of Δ, where sin 2ψ sin Δ is this far from 0: noise and errors of references are not.
inline constexpr double clear_sign = 0.05;

/// Throws std::invalid_argument for a retarder that was found with the other sign of Δ than is stated, or +1.
void require_signs_of_retarders(std::span<const FittedReference> found, std::span<const Reference> references);

/// Without wafers the sign of S2, S3 and S4 together is open: retarders leave it as it is. Gives it by the polarizer, whose
/// azimuth at dial 0 must roughly be known. Throws std::invalid_argument if it is not.
void give_orientation(Unknowns& unknowns, const CalibrationOptions& options);

/// psi and delta of a matrix that is, nearly, one of a diattenuator-retarder; tau is its element 11.
DiattenuatorRetarder element_of(const Mueller& m);

}  // namespace mmbrdf::calibration
