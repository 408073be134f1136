// SPDX-License-Identifier: BSD-3-Clause
// Surfaces as codes of radiative transfer take them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mmbrdf/formats/export.hpp"
#include "mmbrdf/numerics/quadrature.hpp"

namespace mmbrdf {

Export::Made make_vlidort(const Model& model, const ExportOptions& options);
Export::Made make_sixs(const Model& model, const ExportOptions& options);

/// Gauss–Legendre on (0, 1), cosines rising as the codes have them.
std::vector<Node> stream_cosines(int streams);

/// How many moments a quadrature of so many cosines in a hemisphere carries: all, 2 × streams, for `asked` 0. Throws
/// std::invalid_argument for more, and for less than 0.
int moments_carried(int asked, int streams);

/// Throws std::invalid_argument for a polar angle (radians) that is not in [0, π/2].
void require_polar_angles(std::span<const double> angles, const std::string& name);

/// Throws std::invalid_argument for an azimuth (radians) that is not in [−2π, 2π].
void require_azimuths(std::span<const double> azimuths);

}  // namespace mmbrdf
