// SPDX-License-Identifier: BSD-3-Clause
/// Degrees and nanometres, as people and files give them; inside there are radians and micrometres.
#pragma once

#include <numbers>

namespace mmbrdf {

constexpr double radians(double degrees) { return degrees * (std::numbers::pi / 180); }
constexpr double degrees(double radians) { return radians * (180 / std::numbers::pi); }

/// Degrees with the fewest digits for which radians() gives `angle` again; where no number of degrees does, the
/// nearest.
double in_degrees(double angle);

/// Nanometres with the fewest digits for which division by 1000 gives `wavelength` again; where none does, the nearest.
double in_nanometres(double wavelength);

}  // namespace mmbrdf
