// SPDX-License-Identifier: BSD-3-Clause
/// Whether two fits differ by more than their uncertainties say.
#pragma once

#include <array>
#include <span>

#include "mmbrdf/model/model.hpp"
#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf {

/// Of one element: differences d of two models, and their standard uncertainty u = √(u₁² + u₂²), since the fits are
/// independent. Two fits of one sample that are as uncertain as they say have a mean of |d| / u of 0.8 and 95 % within
/// 1.96; what is systematic, of fit or sample, shows as more.
struct Significance {
  long samples = 0;       ///< where u is not 0
  double mean = 0;        ///< of |d| / u
  double largest = 0;     ///< |d| / u where it is largest
  double wavelength = 0;  ///< where that is, micrometres
  Geometry geometry;
  double within = 1;  ///< share of |d| ≤ coverage × u
  static constexpr double coverage = 1.96;
};

/// Of f11 (element 11) and of the other elements divided by it, xy frame, over samples that the second model was
/// evaluated at (simulate() without noise). Throws std::invalid_argument where u is not known, as
/// prepare_uncertainty() does, and where f11 of a model is not positive.
std::array<Significance, 16> significance(const Model& first, const Model& second, std::span<const Sample> of_second);

}  // namespace mmbrdf
