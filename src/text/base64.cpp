// SPDX-License-Identifier: BSD-3-Clause
#include "text/base64.hpp"

#include <algorithm>
#include <array>

namespace mmbrdf {
namespace {

constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr char filler = '=';

}  // namespace

std::string to_base64(std::span<const std::uint8_t> bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t first = 0; first < bytes.size(); first += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - first);
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 3; ++i) bits = (bits << 8) | (i < count ? bytes[first + i] : 0u);
    for (std::size_t i = 0; i < 4; ++i) text += i <= count ? letters[(bits >> (18 - 6 * i)) & 63] : filler;
  }
  return text;
}

std::optional<std::vector<std::uint8_t>> from_base64(std::string_view text) {
  static const std::array<int, 256> values = [] {
    std::array<int, 256> result;
    result.fill(-1);
    for (std::size_t i = 0; i < letters.size(); ++i)
      result[static_cast<unsigned char>(letters[i])] = static_cast<int>(i);
    return result;
  }();
  if (text.size() % 4 != 0) return {};
  std::size_t fillers = 0;
  while (fillers < 2 && fillers < text.size() && text[text.size() - 1 - fillers] == filler) ++fillers;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(text.size() / 4 * 3);
  for (std::size_t first = 0; first < text.size(); first += 4) {
    const std::size_t missing = first + 4 == text.size() ? fillers : 0;
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const int value = i < 4 - missing ? values[static_cast<unsigned char>(text[first + i])] : 0;
      if (value < 0) return {};
      bits = (bits << 6) | static_cast<std::uint32_t>(value);
    }
    for (std::size_t i = 0; i < 3 - missing; ++i) bytes.push_back(static_cast<std::uint8_t>(bits >> (16 - 8 * i)));
  }
  return bytes;
}

}  // namespace mmbrdf
