// SPDX-License-Identifier: BSD-3-Clause
/// Numbers as they are printed in papers and reports (SI brochure 5.4, GUM 7.2.2): UTF-8, with a minus sign U+2212 and
/// powers of ten as "× 10⁻¹⁷".
#pragma once

#include <optional>
#include <string>

namespace mmbrdf {

enum class Notation {
  brackets,    ///< "0.98412(32)": the last two digits of the value are uncertain by these
  plus_minus,  ///< "0.98412 ± 0.00032"
};

/// "brackets" or "plus-minus"; throws std::invalid_argument for another name.
Notation notation_from(const std::string& name);

/// A value to the place where two digits of its standard uncertainty end, with that: "0.98412(32)", "(2.346 ± 0.032) ×
/// 10⁻¹⁴". Where the uncertainty is not known, or not positive, the value alone to three digits; "not known" for a value
/// that is not finite.
std::string in_print(double value, const std::optional<double>& uncertainty, Notation notation = Notation::brackets);

/// A number alone, to this many significant digits, zeros among them: "0.0050", "−9.5 × 10⁻¹⁷".
std::string significant(double value, int digits);

/// Names and units of this project's sentences as they are printed: "theta_i <= 75 degrees" is "θᵢ ≤ 75°", "chi^2" "χ²",
/// "sr^-1" "sr⁻¹".
std::string symbols_in_print(const std::string& sentence);

}  // namespace mmbrdf
