// SPDX-License-Identifier: BSD-3-Clause
#include "mixed/directions.hpp"

#include <cmath>
#include <numbers>

namespace mmbrdf {
namespace {

constexpr double spread_to = radians(70);

double halton(int n, int base) {
  double result = 0;
  for (double part = 1.0 / base; n > 0; n /= base, part /= base) result += part * (n % base);
  return result;
}

}  // namespace

std::vector<Geometry> spread_directions(std::size_t count) {
  std::vector<Geometry> result;
  const double top = std::sin(spread_to), turn = 2 * std::numbers::pi;
  for (int n = 1; result.size() < count; ++n)
    result.push_back({{std::asin(top * std::sqrt(halton(n, 2))), turn * halton(n, 5)},
                      {std::asin(top * std::sqrt(halton(n, 3))), turn * halton(n, 7)}});
  return result;
}

}  // namespace mmbrdf
