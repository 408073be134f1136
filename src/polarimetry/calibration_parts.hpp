// SPDX-License-Identifier: BSD-3-Clause
/// What the sources of calibration.hpp share.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "mmbrdf/polarimetry/calibration.hpp"
#include "numerics/eigen_index.hpp"

namespace mmbrdf::calibration {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// All that is unknown: B_i = g_i A M_i W.
struct Unknowns {
  Eigen::MatrixXd generator;  ///< W, 4 × states
  Eigen::MatrixXd analyzer;   ///< Aᵀ, 4 × states
  double offset = 0;          ///< azimuth of the polarizer at dial 0
  double leak_real = 0;       ///< √extinction cos phase
  double leak_imaginary = 0;  ///< √extinction sin phase
  std::vector<double> gains;  ///< of each reference that is empty or a polarizer (there tau); 1 for a wafer
  std::vector<DiattenuatorRetarder> elements;  ///< of each reference that is a wafer; unused for the others
  double singular_ratio = 0;
  double identifiability = 0;
};

/// B, a row for each analysis state.
inline Eigen::Map<const RowMajor> matrix(std::span<const double> readings, const CalibrationOptions& options) {
  return {readings.data(), index(options.analyzer_states), index(options.generator_states)};
}

inline Eigen::Matrix4d matrix(const Mueller& m) {
  return Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(m.elements.data());
}

/// Without its gain.
Mueller reference_matrix(const Unknowns& unknowns, std::span<const Reference> references, std::size_t i,
                         const CalibrationOptions& options);

/// Polarizer with transmittance 1 along its axis and this leak of the amplitude across it. Smooth where that is 0.
Mueller leaky_polarizer(double azimuth, double leak_real, double leak_imaginary);

/// The eigenvalue method. Throws std::invalid_argument for what it cannot solve.
Unknowns solve_linear(std::span<const Reference> references, const CalibrationOptions& options);

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

/// psi and delta of a matrix that is, nearly, one of a diattenuator-retarder; tau is its element 11.
DiattenuatorRetarder element_of(const Mueller& m);

struct Refinement {
  std::vector<double> covariance;  ///< of W and A
  double chi_squared = 0;
};

/// Maximum likelihood, from a start near to it.
Refinement refine(Unknowns& unknowns, std::span<const Reference> references, const CalibrationOptions& options);

/// Readings less unknowns; the scale that A and W share does not count.
long degrees_of_freedom(std::span<const Reference> references, const CalibrationOptions& options);

}  // namespace mmbrdf::calibration
