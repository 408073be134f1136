// SPDX-License-Identifier: BSD-3-Clause
#include "text/numbers.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace mmbrdf {
namespace {

/// What from_chars is to read: it takes no leading + and no blanks.
std::string_view bare(std::string_view text) {
  text = trimmed(text);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  return text;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

double parse_number(std::string_view text) {
  const std::string_view digits = bare(text);
  double value = 0;
  const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (problem == std::errc::invalid_argument || end != digits.data() + digits.size())
    throw std::invalid_argument(in_quotes(text) + " is not a number");
  if (problem == std::errc::result_out_of_range)
    throw std::invalid_argument(in_quotes(text) + " is beyond the range of double precision");
  if (!std::isfinite(value)) throw std::invalid_argument(in_quotes(text) + " is not a finite number");
  return value;
}

int parse_index(std::string_view text) {
  constexpr int largest = 1000;
  const std::string_view digits = bare(text);
  int value = 0;
  const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (problem == std::errc::invalid_argument || end != digits.data() + digits.size())
    throw std::invalid_argument(in_quotes(text) + " is not an integer");
  if (problem != std::errc() || value < -largest || value > largest)
    throw std::invalid_argument(in_quotes(text) + " is out of range");
  return value;
}

std::string rounded(double value, int digits) {
  std::array<char, 48> text;
  return {text.begin(), std::to_chars(text.begin(), text.end(), value, std::chars_format::general, digits).ptr};
}

std::string fixed(double value, int decimals) {
  std::array<char, 350> text;  // the largest double has 309 digits before the point
  return {text.begin(), std::to_chars(text.begin(), text.end(), value, std::chars_format::fixed, decimals).ptr};
}

}  // namespace mmbrdf
