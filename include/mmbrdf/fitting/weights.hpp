// SPDX-License-Identifier: BSD-3-Clause
/// Weights of the samples of a fit.
#pragma once

#include <span>
#include <vector>

#include "mmbrdf/fitting/fit.hpp"

namespace mmbrdf {

/// Weights of a noise law, as FitAccumulator::add takes them: w = 1/σ² for m_ij, and for f11 / reflectance
/// w / (f11 / reflectance)² with the f11 of `model`, to which its noise is relative; where that is less than what the
/// model typically leaves of f11 (1.48 times the median), with this. Throws std::invalid_argument, with the sample's
/// number, where weight() does or f11 would be 0.
std::vector<Mueller> noise_weights(std::span<const Sample> samples, const Model& model, const NoiseLaw& law);

/// noise_weights() of the speckle law with scale 1: w = cos θr / cos θi.
std::vector<Mueller> speckle_weights(std::span<const Sample> samples, const Model& model);

/// 1/u² of the samples' uncertainties: for f11 / reflectance (reflectance / u)², and turned as at_zero_azimuth() turns
/// them where the basis turns samples; 0 for what was not measured. Throws std::invalid_argument if no sample has
/// uncertainties; with the sample's number, for an uncertainty that is not known of what was measured, and for one so small
/// that its weight is more than 1e9 times those of all other samples together.
std::vector<Mueller> data_weights(std::span<const Sample> samples, const Basis& basis = {},
                                  const ReflectanceTable& reflectance = {});

/// The weights of these names, from a fit of the same samples: the f11 and the reflectance of its model, and for
/// Weights::estimated its noise. Empty for none. Throws as noise_weights() and data_weights(), and for
/// estimated without noise.
std::vector<Mueller> fit_weights(std::span<const Sample> samples, const Basis& basis, const FitResult& fitted,
                                 Weights weights);

}  // namespace mmbrdf
