// SPDX-License-Identifier: BSD-3-Clause
/// Text of others - names, values, remarks out of files - as people are to see it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace mmbrdf {

/// In one line, and safe for a terminal: control characters, line ends, marks that turn the direction of writing, and
/// bytes that are not UTF-8 as \xNN. At most `longest` bytes of that, with "..." in place of the rest.
std::string printable(std::string_view text, std::size_t longest);

/// The same in quotes, short enough for a message.
std::string in_quotes(std::string_view text);

/// The name of something: as it is if it is one, of letters, digits and _ . - [ ], otherwise in quotes.
std::string shown_name(std::string_view name);

}  // namespace mmbrdf
