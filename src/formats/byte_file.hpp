// SPDX-License-Identifier: BSD-3-Clause
// Numbers of a binary file, from wherever they are in it.
#pragma once

#include <cstdint>
#include <fstream>
#include <span>
#include <string>

namespace mmbrdf {

class ByteFile {
 public:
  explicit ByteFile(const std::string& path);

  /// Throws std::runtime_error, naming the path and the offset, if they are not all there.
  void read(std::uint64_t offset, std::span<char> bytes);

 private:
  std::string path_;
  std::ifstream in_;
};

/// A little-endian number at the beginning of these bytes.
template <class Number>
Number little_endian(const char* bytes);

/// a × b; 2^64 − 1 if it is more than that.
std::uint64_t product(std::uint64_t a, std::uint64_t b);

}  // namespace mmbrdf
