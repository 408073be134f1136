// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/text/units.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace mmbrdf {
namespace {

/// Among numbers near `approximate`, one with few digits that `hits`.
template <class Predicate>
double roundest(double approximate, Predicate hits) {
  for (const int digits : {15, 16}) {
    std::array<char, 32> text;
    const auto end = std::to_chars(text.begin(), text.end(), approximate, std::chars_format::general, digits).ptr;
    double rounded = approximate;
    std::from_chars(text.begin(), end, rounded);
    if (hits(rounded)) return rounded;
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double near : {approximate, std::nextafter(approximate, -infinity), std::nextafter(approximate, infinity)})
    if (hits(near)) return near;
  return approximate;
}

}  // namespace

double in_degrees(double angle) {
  return roundest(degrees(angle), [=](double value) { return radians(value) == angle; });
}

double in_nanometres(double wavelength) {
  return roundest(wavelength * 1000, [=](double value) { return value / 1000 == wavelength; });
}

}  // namespace mmbrdf
