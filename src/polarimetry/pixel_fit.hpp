// SPDX-License-Identifier: BSD-3-Clause
/// The fit of one pixel of a camera, near to where its image was fitted: Gauss and Newton, with normal equations in which
/// what belongs to one reference alone is eliminated first.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "mmbrdf/polarimetry/images.hpp"
#include "polarimetry/retarder_problem.hpp"

namespace mmbrdf::calibration {

/// What all pixels share: what is unknown, where it stands, and from where they start.
struct PixelProblem {
  std::vector<Reference> references;
  CalibrationOptions options;
  std::optional<RetarderProblem> retarders;  ///< of `options` above: not to be copied
  std::size_t generators = 0, analyzers = 0;
  std::size_t readings = 0;  ///< of a reference
  PolarizerPlaces polarizer{-1, -1, -1};
  Eigen::Index size = 0;  ///< of what belongs to no reference alone
  long degrees_of_freedom = 0;
  RetarderState start;  ///< W and A in its references, unless it is of retarders

  PixelProblem(const Calibration& from, std::span<const Reference> given, const CalibrationOptions& its_options);
  PixelProblem(const PixelProblem&) = delete;
  PixelProblem& operator=(const PixelProblem&) = delete;
  Eigen::Index own(std::size_t reference) const;  ///< how many unknowns are of one reference alone
};

struct FittedPixel {
  RetarderState x;
  Eigen::VectorXd uncertainties;  ///< of what belongs to no reference alone, in its order
  double misfit = 0;
  PixelFailure failure = PixelFailure::none;
};

/// `readings` of all references, one after the other.
FittedPixel fit_pixel(const PixelProblem& problem, std::span<const float> readings, double most_misfit);

}  // namespace mmbrdf::calibration
