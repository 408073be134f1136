// SPDX-License-Identifier: BSD-3-Clause
// Numbers as text in files: independent of the locale, and read back to the same bits.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "mmbrdf/text/printable.hpp"
#include "mmbrdf/text/rounding.hpp"

namespace mmbrdf {

/// Without surrounding blanks and tabs.
std::string_view trimmed(std::string_view text);

/// The whole text, but for surrounding blanks and a leading +, as a finite number.
/// Throws std::invalid_argument with the text for anything else.
double parse_number(std::string_view text);

/// The whole text, but for surrounding blanks and a leading +, as an integer in [−1000, 1000]: no index of a mode comes
/// near.
int parse_index(std::string_view text);

/// At most this many significant digits, for messages.
std::string rounded(double value, int digits);

/// With this many decimals, for messages.
std::string fixed(double value, int decimals);

}  // namespace mmbrdf
