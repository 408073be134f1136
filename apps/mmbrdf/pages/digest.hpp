// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <istream>
#include <string>

namespace mmbrdf::program {

/// SHA-256 of what is left of a stream, in lower-case hexadecimal, as sha256sum prints it; "", not known, where the program
/// was built without libmd. Throws std::runtime_error if the stream cannot be read.
std::string sha256(std::istream& in);

}  // namespace mmbrdf::program
