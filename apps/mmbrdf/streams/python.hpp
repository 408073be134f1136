// SPDX-License-Identifier: BSD-3-Clause
// Commands whose work the Python package does.
#pragma once

#include <string>
#include <vector>

namespace mmbrdf::program {

/// Becomes Python's interpreter, MMBRDF_PYTHON or python3, which calls main() of a module of the package with these words. It
/// says in a line that `command` needs the package and matplotlib where they are not to be had. Throws std::runtime_error,
/// which begins with `command`, where there is no such interpreter.
[[noreturn]] void become_python(const std::string& command, const std::string& module,
                                const std::vector<std::string>& words);

}  // namespace mmbrdf::program
