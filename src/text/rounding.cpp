// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/text/rounding.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "text/numbers.hpp"

namespace mmbrdf {

std::string shortest(double value) {
  std::array<char, 32> text;
  return {text.begin(), std::to_chars(text.begin(), text.end(), value).ptr};
}

std::string to_place_of(double value, const std::optional<double>& uncertainty) {
  constexpr int most_decimals = 8, all_digits = 15;  // beyond, powers of ten are read more easily
  const double u = uncertainty.value_or(0);
  if (!(u > 0) || !std::isfinite(u)) return rounded(value, 6);
  std::array<char, 32> text;  // "1.0e-01" of 0.0996: the place is that of the rounded one
  *std::to_chars(text.begin(), text.end(), u, std::chars_format::scientific, 1).ptr = '\0';
  const int place = std::atoi(&text[4]) - 1;
  const double unit = std::pow(10, place), units = std::round(value / unit);
  if (place <= 0 && place >= -most_decimals) return fixed(units == 0 ? 0 : value, -place);  // no -0.00
  return rounded(units * unit, all_digits);
}

}  // namespace mmbrdf
