// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace mmbrdf::program {

/// Appends 17 significant digits, as std::to_chars with chars_format::general and printf with %.17g give them: reading
/// them gives the same number. Three times as fast as those for numbers of 1.1e-22 to 2^52, the others are left to
/// them.
void append_exact(std::string& text, double value);

}  // namespace mmbrdf::program
