// SPDX-License-Identifier: BSD-3-Clause
/// Measurements that a model would give.
#pragma once

#include <span>
#include <vector>

#include "mmbrdf/model/model.hpp"
#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf {

/// One sample for each wavelength (micrometres) and geometry, wavelength by wavelength, with Gaussian noise of the
/// speckle law: standard deviation speckle × √(cos θi / cos θr), relative for f11 and absolute for the normalised
/// elements (theory 3.3). speckle = 0: the model's values. The same seed gives the same noise.
/// Throws std::invalid_argument for an invalid model, wavelength or geometry, if f11 of the model is not positive at
/// one, if speckle is negative or not finite, or, with noise, where θr is 90 degrees.
std::vector<Sample> simulate(const Model& model, std::span<const double> wavelengths,
                             std::span<const Geometry> geometries, double speckle = 0, unsigned long seed = 0);

}  // namespace mmbrdf
