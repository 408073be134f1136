// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/text/notation.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr std::string_view minus = "\u2212", times_ten = " \u00d7 10", thin_plus_minus = " \u00b1 ";

std::string superscript(int number) {
  constexpr std::array<std::string_view, 10> digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = number < 0 ? "⁻" : "";
  for (const char digit : std::to_string(std::abs(number))) text += digits[static_cast<std::size_t>(digit - '0')];
  return text;
}

/// With a minus sign.
std::string signed_text(const std::string& number) {
  return number.starts_with('-') ? std::string(minus) + number.substr(1) : number;
}

/// The power of ten of the first digit, once the number is rounded to so many.
int first_place(double value, int digits) {
  std::array<char, 32> text;
  char* const end =
      std::to_chars(text.begin(), text.end() - 1, std::abs(value), std::chars_format::scientific, digits - 1).ptr;
  *end = '\0';
  return std::atoi(std::find(text.begin(), end, 'e') + 1);
}

/// The digits of an uncertainty that stand in brackets: "32" of "0.00032", "1.2" of "1.2".
std::string bracketed(const std::string& u) {
  if (!u.starts_with("0.")) return u;
  return u.substr(u.find_first_not_of("0."));
}

bool is_letter(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

/// All `from` that are words of their own, and no part of names of files.
void replace_words(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos;) {
    const std::size_t end = at + from.size();
    const bool part_of_name = (at > 0 && is_letter(text[at - 1]) && is_letter(from.front())) ||
                              (end < text.size() && is_letter(text[end]) && is_letter(from.back())) ||
                              (end + 1 < text.size() && text[end] == '.' && is_letter(text[end + 1]));
    if (!part_of_name) text.replace(at, from.size(), to);
    at += part_of_name ? from.size() : to.size();
  }
}

/// "θᵢ 45" is "θᵢ = 45°" in a sentence that ends its list of angles with "degrees".
void set_degrees(std::string& text) {
  constexpr std::string_view unit = " degrees";
  for (std::size_t at = 0; (at = text.find(unit, at)) != std::string::npos;)
    if (at > 0 && std::isdigit(static_cast<unsigned char>(text[at - 1])))
      text.replace(at, unit.size(), "°");
    else
      at += unit.size();
}

/// Of numbers that stand alone.
void set_minus(std::string& text) {
  for (std::size_t at = 0; (at = text.find(" -", at)) != std::string::npos; ++at)
    if (at + 2 < text.size() && std::isdigit(static_cast<unsigned char>(text[at + 2]))) text.replace(at + 1, 1, minus);
}

/// Numbers of angles that stand before the last of their list: "θᵢ 45, θᵣ 60°".
void set_angles(std::string& text) {
  for (const std::string_view name : {"θᵢ", "θᵣ", "φᵢ", "φᵣ"})
    for (std::size_t at = 0; (at = text.find(name, at)) != std::string::npos;) {
      at += name.size();
      const bool less = text.compare(at, 5, " ≤ ") == 0;
      const std::size_t number = at + (less ? 5 : 1);
      if (number >= text.size() || (!less && text[at] != ' ')) continue;
      const std::size_t digits = number + (text.compare(number, minus.size(), minus) == 0 ? minus.size() : 0);
      std::size_t end = digits;
      while (end < text.size() &&
             (std::isdigit(static_cast<unsigned char>(text[end])) ||
              (text[end] == '.' && end + 1 < text.size() && std::isdigit(static_cast<unsigned char>(text[end + 1])))))
        ++end;
      if (end == digits || text.compare(end, 4, " to ") == 0) continue;
      if (text.compare(end, 2, "°") != 0) text.insert(end, "°");
      if (!less) text.insert(at, " =");
    }
}

}  // namespace

Notation notation_from(const std::string& name) {
  if (name == "brackets") return Notation::brackets;
  if (name == "plus-minus") return Notation::plus_minus;
  throw std::invalid_argument("\"" + name + "\": expected brackets or plus-minus");
}

std::string in_print(double value, const std::optional<double>& uncertainty, Notation notation) {
  const double u = uncertainty.value_or(0);
  if (!std::isfinite(value)) return "not known";
  if (!(u > 0) || !std::isfinite(u)) return significant(value, 3);
  const std::string number = to_place_of(value, u), its_u = to_place_of(u, u);
  if (number.find('e') != std::string::npos || its_u.find('e') != std::string::npos) {
    const int power = first_place(std::max(std::abs(value), u), 2);
    constexpr double least = 1e-7;  // below, two digits of u are beyond the decimals that to_place_of() writes
    if (u < least * std::pow(10, power)) return signed_text(number) + std::string(thin_plus_minus) + significant(u, 2);
    const std::string scaled = in_print(value / std::pow(10, power), u / std::pow(10, power), notation);
    const bool alone = notation == Notation::brackets;
    return (alone ? scaled : "(" + scaled + ")") + std::string(times_ten) + superscript(power);
  }
  if (notation == Notation::plus_minus) return signed_text(number) + std::string(thin_plus_minus) + its_u;
  return signed_text(number) + "(" + bracketed(its_u) + ")";
}

std::string significant(double value, int digits) {
  if (!std::isfinite(value)) return "not known";
  if (value == 0) return "0";
  const int place = first_place(value, digits);
  constexpr int smallest = -4, largest = 6;
  if (place < smallest || place > largest)
    return signed_text(fixed(value / std::pow(10, place), digits - 1)) + std::string(times_ten) + superscript(place);
  const int decimals = digits - 1 - place;
  if (decimals >= 0) return signed_text(fixed(value, decimals));
  const double unit = std::pow(10, -decimals);
  return signed_text(fixed(std::round(value / unit) * unit, 0));
}

std::string symbols_in_print(const std::string& sentence) {
  std::string text = sentence;
  constexpr std::array<std::pair<std::string_view, std::string_view>, 12> symbols{{{"theta_i", "θᵢ"},
                                                                                   {"theta_r", "θᵣ"},
                                                                                   {"phi_i", "φᵢ"},
                                                                                   {"phi_r", "φᵣ"},
                                                                                   {"φᵣ - φᵢ", "φᵣ − φᵢ"},
                                                                                   {"chi^2", "χ²"},
                                                                                   {"sr^-1", "sr⁻¹"},
                                                                                   {"f11", "f₁₁"},
                                                                                   {"pi", "π"},
                                                                                   {" <= ", " ≤ "},
                                                                                   {" +- ", " ± "},
                                                                                   {"um", "µm"}}};
  for (const auto& [from, to] : symbols) replace_words(text, from, to);
  set_minus(text);
  set_degrees(text);
  set_angles(text);
  return text;
}

}  // namespace mmbrdf
