// SPDX-License-Identifier: BSD-3-Clause
/// Which bytes a file held, in 64 letters.
#pragma once

#include <istream>
#include <string>
#include <string_view>

namespace mmbrdf {

/// SHA-256 (FIPS 180-4) in lower-case hexadecimal, as sha256sum prints it. Of a stream: of what is left of it; throws
/// std::runtime_error if that cannot be read.
std::string sha256(std::string_view bytes);
std::string sha256(std::istream& in);

}  // namespace mmbrdf
