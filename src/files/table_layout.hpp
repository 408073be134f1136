// SPDX-License-Identifier: BSD-3-Clause
// How other programs write tables: what separates, what names mean, how numbers look (docs/formats.md).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mmbrdf {

/// What separates the fields of a line: ';', a tab or ',', whichever there is outside of quotes, in this order; else ' '.
char separator_of(std::string_view line);

/// The fields of a line, without blanks and quotes around them, into `fields`. False for a quote without its end, or with
/// more behind it.
bool split(std::string_view line, char separator, std::vector<std::string_view>& fields);

/// A name as names are compared: in lower case, with _ for blanks and marks between words, Greek letters spelt out, and
/// units as own names have them: "Theta_i (°)", "THETA_I [deg]" → "theta_i_deg", "f11 [1/sr]" → "f11". A name of an
/// element such as M12, S12, F12 stays as it is unless `upper_case`, since it often means one that is not divided; so do
/// the published f_r12/f_r11.
std::string column_key(std::string_view name, bool upper_case);

/// How to name a column that is called otherwise, of those that a table has: "; if it has another name, give that: columns
/// f11=NAME, of AOI, BRDF", behind what says that there is no f11.
std::string other_name_hint(const std::string& own, const std::vector<std::string>& columns);

/// A number without what only others write: D for E in exponents, ',' for '.', the minus sign of typeset text. Nothing if it has none of these.
std::optional<std::string> plain_number(std::string_view field);

}  // namespace mmbrdf
