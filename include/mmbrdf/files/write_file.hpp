// SPDX-License-Identifier: BSD-3-Clause
/// Files that are replaced as a whole, or not at all.
#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

namespace mmbrdf {

/// Runs `write` on a stream whose contents appear under `path` only when all of it is written: a temporary file in the
/// same folder, brought to the disk (fsync) and renamed. Symbolic links are followed, and an existing file keeps its
/// permissions; its other names (hard links) keep the old contents. What is no regular file (a device, a pipe) and what
/// a process holds open (/dev/stdout, /dev/fd/3) is written to directly. The stream can go back to the beginning,
/// seekp(0), where the file can. Throws std::runtime_error naming the path if it cannot be written in full, and
/// whatever `write` throws; then an earlier file is left as it was.
void write_file(const std::string& path, const std::function<void(std::ostream&)>& write);

struct NewFile {
  std::string path;
  std::function<void(std::ostream&)> write;
};

/// The same for files that belong together: all of them are replaced, or none; at no moment is a new one there beside an
/// old one. A process killed (SIGKILL) in the instant of the exchange may leave old ones under temporary names.
void write_files(const std::vector<NewFile>& files);

/// Removes the temporary files of this process, ".mmbrdf-PROCESS-NUMBER", for a handler of a signal that ends it:
/// nothing that is not safe there is called.
void remove_temporary_files() noexcept;

}  // namespace mmbrdf
