// SPDX-License-Identifier: BSD-3-Clause
/// Files that are replaced as a whole, or not at all.
#pragma once

#include <functional>
#include <iosfwd>
#include <string>

namespace mmbrdf {

/// Runs `write` on a stream whose contents appear under `path` only when all of it is written: a temporary file in the
/// same folder, renamed. Links are followed, and an existing file keeps its permissions. A path that exists and is not
/// a regular file (a device, a pipe, /dev/stdout) is written to directly. The stream can go back to the beginning,
/// seekp(0), where the file can. Throws std::runtime_error naming the path if it cannot be written in full, and
/// whatever `write` throws; then an earlier file is left as it was.
void write_file(const std::string& path, const std::function<void(std::ostream&)>& write);

}  // namespace mmbrdf
