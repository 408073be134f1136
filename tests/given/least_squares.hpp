// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/samples/simulation.hpp"

namespace mmbrdf {

/// A built-in material as least squares finds it on the published grid, with noise: a covariance of the coefficients, and
/// of the reflectance table where there are several wavelengths.
inline Model least_squares(const std::string& name) {
  const Model truth = material(name);
  Model result = fit(simulate(truth, truth.validity.wavelengths, germer2017_grid(), 0.006, 1)).model;
  result.name = name;
  return result;
}

}  // namespace mmbrdf
