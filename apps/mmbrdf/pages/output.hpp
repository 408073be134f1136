// SPDX-License-Identifier: BSD-3-Clause
// Results on standard output, talk on standard error.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "mmbrdf/polarization/mueller.hpp"
#include "mmbrdf/text/printable.hpp"
#include "mmbrdf/text/rounding.hpp"
#include "pages/exact.hpp"

namespace mmbrdf::program {

enum class Format { text, csv, json, html };

/// Throws std::runtime_error unless everything sent to standard output so far could be written.
void flush_output();

/// A file that is written whatever goes wrong afterwards, which say_failure() then says.
void note_written(const std::string& path);

/// One line on standard error.
void say(const std::string& message);
void say_failure(const std::string& message);
void warn(const std::string& message);
void note(const std::string& message);

/// Of a text out of a file, where people read it: printable.hpp.
inline constexpr std::size_t longest_text = 400;

/// As printf.
[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...);

/// "a, b, c"
std::string joined(const std::vector<std::string>& words, const std::string& between = ", ");

/// 17 significant digits: reading them gives the same number.
std::string exact(double value);

/// Up to 10 significant digits, no more than needed: 532, 81.87 …
std::string brief(double value);

/// ",f11,f12,…,f44", or of normalised elements ",f11,m12,…,m44".
std::string element_columns(bool normalized);

/// Appends "," and 17 significant digits for each of the 16 elements.
void append_elements(std::string& text, const Mueller& m);

/// M with all elements but 11 divided by it. Throws std::invalid_argument if f11 is 0.
Mueller normalized_beside_f11(const Mueller& f);

}  // namespace mmbrdf::program
