// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/text/sha256.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <stdexcept>

namespace mmbrdf {
namespace {

constexpr std::size_t block_size = 64, rounds = 64;
using Words = std::array<std::uint32_t, 8>;

/// The first 32 bits of the fraction of x.
constexpr std::uint32_t fraction_bits(long double x) {
  return static_cast<std::uint32_t>((x - static_cast<long double>(static_cast<std::uint64_t>(x))) * 4294967296.0L);
}

/// Of the cube roots of the first 64 primes, and of the square roots of the first eight.
struct Constants {
  std::array<std::uint32_t, rounds> cube_roots;
  Words square_roots;
};

Constants constants_of_primes() {
  Constants result{};
  std::size_t found = 0;
  for (std::uint32_t n = 2; found < rounds; ++n) {
    bool prime = true;
    for (std::uint32_t d = 2; d * d <= n; ++d) prime = prime && n % d != 0;
    if (!prime) continue;
    result.cube_roots[found] = fraction_bits(std::cbrt(static_cast<long double>(n)));
    if (found < result.square_roots.size())
      result.square_roots[found] = fraction_bits(std::sqrt(static_cast<long double>(n)));
    ++found;
  }
  return result;
}

class Digest {
 public:
  void add(std::string_view bytes) {
    size_ += bytes.size();
    for (const char byte : bytes) {
      block_[filled_++] = static_cast<unsigned char>(byte);
      if (filled_ == block_size) take_block();
    }
  }

  std::string end() {
    const std::uint64_t bits = 8 * size_;
    add("\x80");
    while (filled_ != block_size - 8) add(std::string_view("\0", 1));
    std::string length(8, '\0');
    for (std::size_t i = 0; i < 8; ++i) length[i] = static_cast<char>(bits >> (56 - 8 * i) & 0xff);
    add(length);
    std::string text;
    for (const std::uint32_t word : state_) {
      std::array<char, 9> hex{};
      std::snprintf(hex.data(), hex.size(), "%08x", static_cast<unsigned>(word));
      text += hex.data();
    }
    return text;
  }

 private:
  void take_block() {
    std::array<std::uint32_t, rounds> w{};
    for (std::size_t i = 0; i < 16; ++i)
      for (std::size_t byte = 0; byte < 4; ++byte) w[i] = w[i] << 8 | block_[4 * i + byte];
    for (std::size_t i = 16; i < rounds; ++i) {
      const std::uint32_t s0 = std::rotr(w[i - 15], 7) ^ std::rotr(w[i - 15], 18) ^ w[i - 15] >> 3;
      const std::uint32_t s1 = std::rotr(w[i - 2], 17) ^ std::rotr(w[i - 2], 19) ^ w[i - 2] >> 10;
      w[i] = w[i - 16] + s0 + w[i - 7] + s1;
    }
    auto [a, b, c, d, e, f, g, h] = state_;
    for (std::size_t i = 0; i < rounds; ++i) {
      const std::uint32_t s1 = std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25);
      const std::uint32_t t1 = h + s1 + ((e & f) ^ (~e & g)) + constants_.cube_roots[i] + w[i];
      const std::uint32_t s0 = std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22);
      const std::uint32_t t2 = s0 + ((a & b) ^ (a & c) ^ (b & c));
      h = g, g = f, f = e, e = d + t1, d = c, c = b, b = a, a = t1 + t2;
    }
    const Words added{a, b, c, d, e, f, g, h};
    for (std::size_t i = 0; i < state_.size(); ++i) state_[i] += added[i];
    filled_ = 0;
  }

  Constants constants_ = constants_of_primes();
  Words state_ = constants_.square_roots;
  std::array<unsigned char, block_size> block_{};
  std::size_t filled_ = 0;
  std::uint64_t size_ = 0;
};

}  // namespace

std::string sha256(std::string_view bytes) {
  Digest digest;
  digest.add(bytes);
  return digest.end();
}

std::string sha256(std::istream& in) {
  Digest digest;
  std::array<char, 65536> piece;
  while (in) {
    in.read(piece.data(), piece.size());
    digest.add({piece.data(), static_cast<std::size_t>(in.gcount())});
  }
  if (in.bad()) throw std::runtime_error("cannot be read");
  return digest.end();
}

}  // namespace mmbrdf
