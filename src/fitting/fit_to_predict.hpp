// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mmbrdf/fitting/fit.hpp"
#include "numerics/svd_cache.hpp"

namespace mmbrdf {

/// What samples.solve(options) finds, without covariances and where the samples support the model: for fits of which
/// only predictions are wanted. Triangles in the cache are not decomposed again.
FitResult fit_to_predict(const FitAccumulator& samples, const FitOptions& options, SvdCache& known);

}  // namespace mmbrdf
