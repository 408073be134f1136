// SPDX-License-Identifier: BSD-3-Clause
/// What is unknown of references, and how their matrices change with it: for refinements of any kind of instrument.
#pragma once

#include <span>
#include <vector>

#include "polarimetry/calibration_parts.hpp"

namespace mmbrdf::calibration {

/// No weight of a single reading is infinite: σ is at least this part of the largest reading.
inline constexpr double least_sigma = 1e-5;

/// Of a reference by itself: its gain, or tau, psi and delta.
Eigen::Index unknowns_of(ReferenceKind kind);

/// Where the unknowns are that all polarizers share; leak_imaginary −1: it is not one.
struct PolarizerPlaces {
  Eigen::Index offset, leak_real, leak_imaginary;
};

/// The derivative of a matrix over one unknown, by its place.
struct Derivative {
  Eigen::Index place;
  Eigen::Matrix4d slope;
};

struct ReferenceSlopes {
  Eigen::Matrix4d matrix;  ///< with its gain
  std::vector<Derivative> derivatives;
};

/// With its gain.
Eigen::Matrix4d expected(const Unknowns& x, std::span<const Reference> references, std::size_t i,
                         const CalibrationOptions& options);

/// Its own unknowns begin at `first`.
ReferenceSlopes reference_slopes(const Unknowns& x, std::span<const Reference> references, std::size_t i,
                                 const CalibrationOptions& options, Eigen::Index first,
                                 const PolarizerPlaces& polarizer);

/// Adds a step to the unknowns of all references.
void move_references(Unknowns& x, std::span<const Reference> references, const Eigen::VectorXd& step,
                     std::span<const Eigen::Index> first, const PolarizerPlaces& polarizer);

}  // namespace mmbrdf::calibration
