// SPDX-License-Identifier: BSD-3-Clause
/// What the steps of a calibration hand on: the eigenvalue method, the signs of wafers, the refinement.
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
  std::vector<double> gains;  ///< of each reference that is empty or a polarizer (there tau); 1 for the others
  std::vector<DiattenuatorRetarder> elements;  ///< of each wafer or retarder; unused for the others
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

/// Of the axes of a wafer or retarder.
inline double azimuth_of(const Reference& reference) {
  return reference.kind == ReferenceKind::retarder ? reference.angle : 0;
}

/// Without its gain.
Mueller reference_matrix(const Unknowns& unknowns, std::span<const Reference> references, std::size_t i,
                         const CalibrationOptions& options);

/// Polarizer with transmittance 1 along its axis and this leak of the amplitude across it. Smooth where that is 0.
Mueller leaky_polarizer(double azimuth, double leak_real, double leak_imaginary);

}  // namespace mmbrdf::calibration
