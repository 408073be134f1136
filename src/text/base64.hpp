// SPDX-License-Identifier: BSD-3-Clause
/// Numbers as text of few letters: their bits, least significant byte first, in base 64 (RFC 4648).
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace mmbrdf {

std::string to_base64(std::span<const std::uint8_t> bytes);
/// Nothing for what is no such text.
std::optional<std::vector<std::uint8_t>> from_base64(std::string_view text);

template <class Number>
  requires std::floating_point<Number> || std::unsigned_integral<Number>
std::string numbers_to_base64(std::span<const Number> numbers) {
  using Bits = std::conditional_t<sizeof(Number) == 8, std::uint64_t, std::uint32_t>;
  static_assert(sizeof(Bits) == sizeof(Number));
  std::vector<std::uint8_t> bytes;
  bytes.reserve(numbers.size() * sizeof(Number));
  for (const Number number : numbers)
    for (std::size_t byte = 0; byte < sizeof(Number); ++byte)
      bytes.push_back(static_cast<std::uint8_t>(std::bit_cast<Bits>(number) >> (8 * byte)));
  return to_base64(bytes);
}

/// Nothing for what is no such text, or not of whole numbers.
template <class Number>
  requires std::floating_point<Number> || std::unsigned_integral<Number>
std::optional<std::vector<Number>> numbers_from_base64(std::string_view text) {
  using Bits = std::conditional_t<sizeof(Number) == 8, std::uint64_t, std::uint32_t>;
  const auto bytes = from_base64(text);
  if (!bytes || bytes->size() % sizeof(Number) != 0) return {};
  std::vector<Number> result;
  for (std::size_t first = 0; first < bytes->size(); first += sizeof(Number)) {
    Bits bits = 0;
    for (std::size_t byte = sizeof(Number); byte-- > 0;) bits = (bits << 8) | (*bytes)[first + byte];
    result.push_back(std::bit_cast<Number>(bits));
  }
  return result;
}

}  // namespace mmbrdf
