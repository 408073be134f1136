// SPDX-License-Identifier: BSD-3-Clause
#include "pages/digest.hpp"

#include <stdexcept>

#ifdef MMBRDF_LIBMD
#include <sha2.h>

#include <array>
#include <cstdint>

namespace mmbrdf::program {

std::string sha256(std::istream& in) {
  SHA2_CTX context;
  SHA256Init(&context);
  std::array<char, 1 << 16> some;
  do {
    in.read(some.data(), some.size());
    SHA256Update(&context, reinterpret_cast<const std::uint8_t*>(some.data()), static_cast<std::size_t>(in.gcount()));
  } while (in);
  if (in.bad()) throw std::runtime_error("cannot be read to its end");
  std::array<char, SHA256_DIGEST_STRING_LENGTH> text;
  return SHA256End(&context, text.data());
}

}  // namespace mmbrdf::program

#else

std::string mmbrdf::program::sha256(std::istream&) { return ""; }

#endif
