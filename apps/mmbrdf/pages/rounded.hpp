// SPDX-License-Identifier: BSD-3-Clause
// Numbers for people: as many digits as their uncertainty leaves.
#pragma once

#include <optional>
#include <string>

namespace mmbrdf::program {

/// A number to the place where two digits of a standard uncertainty end: "0.3284" beside 0.0012. Without one, and where
/// that place is before the point or beyond the twelfth decimal: six digits.
std::string to_place_of(double value, const std::optional<double>& uncertainty);

/// Both: "0.3284 +- 0.0012". Without an uncertainty the value alone.
std::string rounded(double value, const std::optional<double>& uncertainty);

}  // namespace mmbrdf::program
