// SPDX-License-Identifier: BSD-3-Clause
#include "pages/digest.hpp"

#ifdef MMBRDF_LIBMD
#include <sha2.h>

#include <array>
#include <cstdint>

std::string mmbrdf::program::sha256(std::string_view bytes) {
  std::array<char, SHA256_DIGEST_STRING_LENGTH> text;
  return SHA256Data(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), text.data());
}

#else

std::string mmbrdf::program::sha256(std::string_view) { return ""; }

#endif
