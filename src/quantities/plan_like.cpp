// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/quantities/plan_like.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "mmbrdf/model/description.hpp"
#include "mmbrdf/samples/samples.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {

VarianceComponents components_like(const Model* fit, std::optional<double> wavelength, std::optional<double> noise) {
  if (noise && !(*noise >= least_noise && *noise <= largest_noise))
    throw std::invalid_argument("noise " + shortest(*noise) + ": must be in " + shortest(least_noise) + "..." +
                                shortest(largest_noise) + ", relative for f11");
  if (!fit && wavelength) throw std::invalid_argument("a wavelength is that of a fit: without one it says nothing");
  if (!fit) return noise ? default_components(*noise) : default_components();
  if (!fit->posterior)
    throw std::invalid_argument("it says nothing of the sample's variances: fit it with uncertainty sample");
  const std::vector<PosteriorAt>& fitted = fit->posterior->data().wavelengths;
  const auto at =
      wavelength ? std::ranges::find_if(
                       fitted, [&](const PosteriorAt& one) { return same_wavelength(one.wavelength, *wavelength); })
                 : fitted.begin();
  if (at == fitted.end())
    throw std::invalid_argument("it was fitted at " + nanometre_list(fit->validity.wavelengths) + ", not at " +
                                nanometre_list(std::array{*wavelength}));
  VarianceComponents result = components_of(*fit->posterior, at->wavelength);
  for (VarianceComponents::OfBlock& block : result.blocks)
    if (noise) block.noise_variance = *noise * *noise;
  return result;
}

}  // namespace mmbrdf
