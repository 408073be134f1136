// SPDX-License-Identifier: BSD-3-Clause
/// Files that are read.
#pragma once

#include <fstream>
#include <string>

namespace mmbrdf {

/// Opens a file for reading. Throws std::runtime_error, naming the path and the reason, if that fails or it is a
/// folder.
std::ifstream open_input(const std::string& path);

}  // namespace mmbrdf
