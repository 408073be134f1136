// SPDX-License-Identifier: BSD-3-Clause
/// Whether models and measurements differ by more than their uncertainties say.
#pragma once

#include <array>
#include <span>

#include "mmbrdf/model/model.hpp"
#include "mmbrdf/samples/samples.hpp"
#include "mmbrdf/uncertainty/budget.hpp"

namespace mmbrdf {

/// Of one element: differences d, and their standard uncertainty u = √(u₁² + u₂²), since both are independent. Two fits of
/// one sample that are as uncertain as they say have a root mean square of d / u of 1, a mean of |d| / u of 0.8, 95 %
/// within 1.96 and 4.6 % beyond 2; what is systematic, of fit or sample, shows as more.
struct Significance {
  long samples = 0;       ///< where u is known, and not 0
  double u = 0;           ///< root mean square of u
  double rms = 0;         ///< of d / u
  double mean = 0;        ///< of |d| / u
  double largest = 0;     ///< |d| / u where it is largest
  double wavelength = 0;  ///< where that is, micrometres
  Geometry geometry;
  double within = 1;  ///< share of |d| ≤ coverage × u
  double beyond = 0;  ///< share of |d| > 2 u
  static constexpr double coverage = 1.96;
};

/// Of f11 (element 11) and of the other elements divided by it, xy frame, over samples that the second model was
/// evaluated at (simulate() without noise), but for those where f11 of the first is not positive. `terms` are errors of the difference that neither knows: their effects on
/// the first model (budget.hpp). Throws std::invalid_argument where u is not known, as
/// prepare_uncertainty() does, where f11 of the second is not positive, and as effects() does.
std::array<Significance, 16> significance(const Model& first, const Model& second, std::span<const Sample> of_second,
                                          std::span<const TypeBTerm> terms = {});

/// Of measured samples and a model; if it was fitted to them, both are not independent and d / u is smaller. Elements
/// whose uncertainty a sample does not have are left out, and all of a sample where f11 of the model is not positive.
std::array<Significance, 16> significance(const Model& model, std::span<const Sample> samples,
                                          std::span<const TypeBTerm> terms = {});

/// Of samples that belong together (matching.hpp), second − first pair by pair; without those that either does not know.
/// Throws std::invalid_argument for lists of different lengths.
std::array<Significance, 16> significance(std::span<const Sample> first, std::span<const Sample> second);

}  // namespace mmbrdf
