// SPDX-License-Identifier: BSD-3-Clause
#include "standard_library.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>

// The C library below knows one locale, and reads and writes doubles exactly.
namespace {

/// Text of which from_chars takes nothing, or where it ends before strtod does.
bool begins_as_number(const char* first, const char* last) {
  if (first != last && *first == '-') ++first;
  if (first == last || *first == '+' || *first == '-') return false;
  return *first == '.' || std::isalnum(static_cast<unsigned char>(*first)) != 0;
}

__extension__ using Wide = unsigned __int128;

constexpr int most_digits = 19;  // of a decimal number in 64 bits
constexpr auto powers_of_ten = [] {
  std::array<std::uint64_t, most_digits + 1> powers{1};
  for (std::size_t i = 1; i < powers.size(); ++i) powers[i] = 10 * powers[i - 1];
  return powers;
}();

/// digits / 10^places, rounded once: the quotient has more than 62 bits, and the last says whether there is a rest.
double divided(std::uint64_t digits, int places) {
  const std::uint64_t power = powers_of_ten[static_cast<std::size_t>(places)];
  const int shift = 64 + __builtin_clzll(digits);
  const Wide dividend = Wide(digits) << shift, quotient = dividend / power;
  return std::ldexp(static_cast<double>(quotient | (quotient * power != dividend)), -shift);
}

/// Decimal digits with a point at most, as nearly all numbers of tables are; nothing for other text, or where they are more
/// than 64 bits hold. strtod, in numbers of 128 bits without a processor for them, takes many times as long.
std::optional<double> plain_decimal(const char* first, const char* last) {
  const bool negative = first != last && *first == '-';
  if (negative) ++first;
  std::uint64_t digits = 0;
  int significant = 0, behind_point = 0;
  bool any = false, point = false;
  for (; first != last; ++first) {
    if (*first == '.' && !point) {
      point = true;
      continue;
    }
    if (*first < '0' || *first > '9') return {};
    any = true;
    behind_point += point;
    if (digits != 0 || *first != '0') ++significant;
    if (significant > most_digits || behind_point > most_digits) return {};
    digits = 10 * digits + static_cast<std::uint64_t>(*first - '0');
  }
  if (!any) return {};
  const double value = digits == 0 ? 0 : divided(digits, behind_point);
  return negative ? -value : value;
}

std::to_chars_result put(char* first, char* last, const std::string& text) {
  if (static_cast<std::size_t>(last - first) < text.size()) return {last, std::errc::value_too_large};
  return {std::copy(text.begin(), text.end(), first), std::errc()};
}

std::string printed(const char* format, int precision, double value) {
  std::string text(400, '\0');
  text.resize(static_cast<std::size_t>(std::snprintf(text.data(), text.size(), format, precision, value)));
  return text;
}

/// The fewest digits, as "-1.25e-03", that are read back as the same number.
std::string shortest_scientific(double value) {
  for (int precision = 0; precision < 16; ++precision) {
    std::string text = printed("%.*e", precision, value);
    if (std::strtod(text.c_str(), nullptr) == value) return text;
  }
  return printed("%.*e", 16, value);
}

/// The same digits without exponent.
std::string without_exponent(const std::string& scientific, double value) {
  const std::size_t e = scientific.find('e');
  const auto digits = static_cast<int>(std::count_if(scientific.begin(), scientific.begin() + static_cast<long>(e),
                                                     [](unsigned char c) { return std::isdigit(c) != 0; }));
  return printed("%.*f", std::max(0, digits - 1 - std::atoi(&scientific[e + 1])), value);
}

}  // namespace

namespace std {

from_chars_result from_chars(const char* first, const char* last, double& value) {
  if (const optional<double> plain = plain_decimal(first, last)) {
    value = *plain;
    return {last, errc()};
  }
  if (!begins_as_number(first, last)) return {first, errc::invalid_argument};
  const string text(first, last);
  const std::size_t x = text.find_first_of("xX");  // of a hexadecimal number the 0 alone
  char* end = nullptr;
  const string decimal = text.substr(0, x);
  const double read = strtod(decimal.c_str(), &end);
  const std::ptrdiff_t length = end - decimal.c_str();
  if (length == 0) return {first, errc::invalid_argument};
  const bool is_word = decimal.find_first_of("nN") < static_cast<std::size_t>(length);
  const bool too_small =
      read == 0 && decimal.substr(0, decimal.find_first_of("eE")).find_first_of("123456789") != string::npos;
  if ((isinf(read) && !is_word) || too_small) return {first + length, errc::result_out_of_range};
  value = read;
  return {first + length, errc()};
}

to_chars_result to_chars(char* first, char* last, double value) {
  if (!isfinite(value)) return put(first, last, printed("%.*f", 0, value));
  const string scientific = shortest_scientific(value), fixed = without_exponent(scientific, value);
  return put(first, last, fixed.size() <= scientific.size() ? fixed : scientific);
}

to_chars_result to_chars(char* first, char* last, double value, chars_format format) {
  if (!isfinite(value)) return put(first, last, printed("%.*f", 0, value));
  const string scientific = shortest_scientific(value);
  return put(first, last, format == chars_format::fixed ? without_exponent(scientific, value) : scientific);
}

to_chars_result to_chars(char* first, char* last, double value, chars_format format, int precision) {
  const char* const how = format == chars_format::fixed ? "%.*f" : format == chars_format::scientific ? "%.*e" : "%.*g";
  return put(first, last, printed(how, precision, value));
}

}  // namespace std
