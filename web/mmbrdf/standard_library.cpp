// SPDX-License-Identifier: BSD-3-Clause
#include "standard_library.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

// The C library below knows one locale, and reads and writes doubles exactly.
namespace {

/// Text of which from_chars takes nothing, or where it ends before strtod does.
bool begins_as_number(const char* first, const char* last) {
  if (first != last && *first == '-') ++first;
  if (first == last || *first == '+' || *first == '-') return false;
  return *first == '.' || std::isalnum(static_cast<unsigned char>(*first)) != 0;
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
