// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "mmbrdf/fitting/fit.hpp"

namespace mmbrdf {

/// The variance of a row of unit weight: s², none without degrees of freedom; or 1 as given.
inline std::optional<double> row_variance(const Solution& solution, Covariance covariance) {
  if (covariance == Covariance::given) return 1;
  if (solution.degrees_of_freedom() <= 0) return {};
  return solution.variance();
}

}  // namespace mmbrdf
