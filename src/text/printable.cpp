// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/text/printable.hpp"

#include <algorithm>
#include <cstdint>

namespace mmbrdf {
namespace {

unsigned char byte(char c) { return static_cast<unsigned char>(c); }

/// Bytes of the character in UTF-8 at the beginning, and its number: 0 bytes if there is none.
struct Character {
  std::size_t size = 0;
  std::uint32_t number = 0;
};

Character first_of(std::string_view text) {
  constexpr std::uint32_t smallest[] = {0, 0, 0x80, 0x800, 0x10000};
  const unsigned char first = byte(text[0]);
  const std::size_t size = first < 0x80 ? 1 : first >> 5 == 6 ? 2 : first >> 4 == 14 ? 3 : first >> 3 == 30 ? 4 : 0;
  if (size < 2) return {size, first};
  std::uint32_t number = first & (0x7fU >> size);
  for (std::size_t i = 1; i < size; ++i) {
    if (i >= text.size() || byte(text[i]) >> 6 != 2) return {};
    number = number << 6 | (byte(text[i]) & 0x3fU);
  }
  const bool valid = number >= smallest[size] && number <= 0x10ffff && (number < 0xd800 || number > 0xdfff);
  return valid ? Character{size, number} : Character{};
}

bool is_harmless(std::uint32_t c) {
  const bool control = c < 0x20 || (c >= 0x7f && c < 0xa0);
  const bool line_or_direction =
      (c >= 0x200e && c <= 0x200f) || (c >= 0x2028 && c <= 0x202e) || (c >= 0x2066 && c <= 0x2069);
  return !control && !line_or_direction;
}

}  // namespace

std::string printable(std::string_view text, std::size_t longest) {
  constexpr std::string_view hexadecimal = "0123456789abcdef";
  std::string result;
  for (std::size_t at = 0, size = 0; at < text.size(); at += size) {
    const Character c = first_of(text.substr(at));
    size = std::max<std::size_t>(c.size, 1);
    std::string shown(text.substr(at, size));
    if (c.size == 0 || !is_harmless(c.number)) {
      shown.clear();
      for (const char one : text.substr(at, size))
        (shown += "\\x") += {hexadecimal[byte(one) / 16], hexadecimal[byte(one) % 16]};
    }
    if (result.size() + shown.size() > longest) return result + "...";
    result += shown;
  }
  return result;
}

std::string in_quotes(std::string_view text) { return "'" + printable(text, 40) + "'"; }

std::string shown_name(std::string_view name) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_.-[]").find(c) != std::string_view::npos;
  };
  return !name.empty() && name.size() <= 40 && std::ranges::all_of(name, plain) ? std::string(name) : in_quotes(name);
}

}  // namespace mmbrdf
