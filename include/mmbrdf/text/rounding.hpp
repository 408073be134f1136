// SPDX-License-Identifier: BSD-3-Clause
/// Numbers as text, with as many digits as they have, or as their standard uncertainty leaves.
#pragma once

#include <optional>
#include <string>

namespace mmbrdf {

/// The fewest digits that are read back as the same number: "0.984"
std::string shortest(double value);

/// A number to the place where two significant digits of a standard uncertainty end: "0.3284" beside 0.0012, "98770"
/// beside 120. The uncertainty itself is to_place_of(u, u). Six significant digits if it is not known, or not positive.
std::string to_place_of(double value, const std::optional<double>& uncertainty);

}  // namespace mmbrdf
