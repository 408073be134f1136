// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace mmbrdf::program {

/// SHA-256 in lower-case hexadecimal, as sha256sum prints it; "", not known, where the program was built without libmd.
std::string sha256(std::string_view bytes);

}  // namespace mmbrdf::program
