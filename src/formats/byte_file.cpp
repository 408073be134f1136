// SPDX-License-Identifier: BSD-3-Clause
#include "formats/byte_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <stdexcept>

#include "mmbrdf/text/input.hpp"

namespace mmbrdf {

ByteFile::ByteFile(const std::string& path) : path_(path), in_(open_input(path)) {}

void ByteFile::read(std::uint64_t offset, std::span<char> bytes) {
  in_.clear();
  in_.seekg(static_cast<std::streamoff>(offset));
  in_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!in_ || in_.gcount() != static_cast<std::streamsize>(bytes.size()))
    throw std::runtime_error(path_ + ": offset " + std::to_string(offset) + ": " + std::to_string(bytes.size()) +
                             " bytes of numbers are not all there: cut off?");
}

template <class Number>
Number little_endian(const char* bytes) {
  std::array<char, sizeof(Number)> raw;
  std::copy_n(bytes, sizeof(Number), raw.begin());
  if constexpr (std::endian::native == std::endian::big) std::ranges::reverse(raw);
  return std::bit_cast<Number>(raw);
}

template std::int8_t little_endian<std::int8_t>(const char*);
template std::uint8_t little_endian<std::uint8_t>(const char*);
template std::uint16_t little_endian<std::uint16_t>(const char*);
template std::int16_t little_endian<std::int16_t>(const char*);
template std::uint32_t little_endian<std::uint32_t>(const char*);
template std::int32_t little_endian<std::int32_t>(const char*);
template std::uint64_t little_endian<std::uint64_t>(const char*);
template std::int64_t little_endian<std::int64_t>(const char*);
template float little_endian<float>(const char*);
template double little_endian<double>(const char*);

std::uint64_t product(std::uint64_t a, std::uint64_t b) {
  constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  return b != 0 && a > most / b ? most : a * b;
}

}  // namespace mmbrdf
