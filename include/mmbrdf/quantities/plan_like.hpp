// SPDX-License-Identifier: BSD-3-Clause
/// What a plan takes over from a fit.
#pragma once

#include <optional>

#include "mmbrdf/mixed/plan.hpp"
#include "mmbrdf/model/model.hpp"

namespace mmbrdf {

inline constexpr double least_noise = 1e-6, largest_noise = 10;

/// The sample and the instrument of a fit at one of its wavelengths (micrometres; its first), or of no fit the default
/// ones; with this noise, relative for f11 at normal directions, instead of theirs. Throws std::invalid_argument for a
/// fit without a posterior, another wavelength, a wavelength without a fit, and a noise out of range.
VarianceComponents components_like(const Model* fit, std::optional<double> wavelength = {},
                                   std::optional<double> noise = {});

}  // namespace mmbrdf
