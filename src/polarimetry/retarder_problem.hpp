// SPDX-License-Identifier: BSD-3-Clause
/// The least-squares problem of two turning retarders and their references: what is unknown, and its rows.
#pragma once

#include <span>
#include <vector>

#include "mmbrdf/polarimetry/rotating_retarders.hpp"
#include "numerics/levenberg_marquardt.hpp"
#include "polarimetry/reference_slopes.hpp"

namespace mmbrdf::calibration {

/// Of the row that holds the mean gain of the empty references, against those of readings.
inline constexpr double firmness = 1e3;

/// All that is unknown.
struct RetarderState {
  RotatingRetarders instrument;
  Unknowns references;
  std::vector<double> drifts;  ///< of each reference
};

/// What is fitted, and where each unknown stands.
struct RetarderProblem {
  std::vector<Reference> references;
  const CalibrationOptions& options;
  std::span<const DialAngles> dials;
  std::vector<std::size_t> free;  ///< parameters of the instrument
  PolarizerPlaces polarizer{-1, -1, -1};
  std::vector<Eigen::Index> first;  ///< of each reference; its drift comes behind it
  Eigen::Index size = 0;

  RetarderProblem(std::vector<Reference> some, const CalibrationOptions& given);
  Eigen::Index readings() const { return index(references.size() * dials.size()); }
  long degrees_of_freedom() const { return readings() - (size - 1); }
  double time(Eigen::Index frame) const {
    const auto count = static_cast<double>(dials.size());
    return (static_cast<double>(frame) + 0.5 - count / 2) / count;
  }
};

/// The readings of all references, and, unless it is null, their slopes.
Eigen::VectorXd predicted(const RetarderState& x, const RetarderProblem& problem, Eigen::MatrixXd* jacobian = nullptr);
Eigen::VectorXd measured(const RetarderProblem& problem);

/// In units of σ; the last row holds the mean of the empty references' gains.
Linearised linearised(const RetarderState& x, const RetarderProblem& problem, const Eigen::VectorXd& sigma);

/// σ of each reading, from what the unknowns predict.
Eigen::VectorXd deviations(const RetarderState& x, const RetarderProblem& problem);

/// Maximum likelihood, from a start near to it.
void minimise(RetarderState& x, const RetarderProblem& problem);

}  // namespace mmbrdf::calibration
