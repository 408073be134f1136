// SPDX-License-Identifier: BSD-3-Clause
/// The textbook sum, as slow and as exact as it can be: what the kernels are compared with.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <vector>

#include "mmbrdf/model/model.hpp"

namespace mmbrdf {

/// The sum of Eqs. 17–20 in the xy frame as it stands there, for the azimuths given, with 64 bits of mantissa.
inline Mueller sum_in_extended_precision(const Model& model, double wavelength, const Geometry& geometry) {
  using Long = long double;
  const auto index = [](int n) { return static_cast<std::size_t>(n); };
  const auto k_table = [&](const Direction& d) {
    const int order = std::max(orders(model).f11, orders(model).other);
    const Long theta = d.theta,
               rho = model.mapping == DiscMapping::lambert ? std::sqrt(2.0L) * std::sin(theta / 2) : std::sin(theta);
    std::vector<std::vector<Long>> r(index(order) + 1, std::vector<Long>(index(order) + 2));
    std::vector<Long> table(index(zernike_count(order)));
    for (int n = 0; n <= order; ++n)
      for (int k = n % 2; k <= n; k += 2) {
        Long& value = r[index(n)][index(k)];
        if (n == 0)
          value = 1;
        else
          value = rho * (r[index(n - 1)][index(std::abs(k - 1))] + r[index(n - 1)][index(k + 1)]) -
                  (n > 1 ? r[index(n - 2)][index(k)] : 0);
        const Long norm = std::sqrt((n + 1) / std::numbers::pi_v<Long>), phi = d.phi;
        table[index(zernike_index(n, k))] = norm * value * (k == 0 ? std::sqrt(0.5L) : std::cos(k * phi));
        if (k > 0) table[index(zernike_index(n, -k))] = norm * value * std::sin(k * phi);
      }
    return table;
  };
  const auto k_i = k_table(geometry.incident), k_r = k_table(geometry.reflected);
  std::array<Long, 16> sums{};
  for (const FittedBlock& fitted : model.blocks) {
    const auto& [block, coefficients] = std::tie(fitted.block, fitted.coefficients);
    for (std::size_t q = 0; q < block.modes.size(); ++q) {
      Long coefficient = 0;
      for (int p = 0; p <= model.powers; ++p)
        coefficient += coefficients[index(p) * block.modes.size() + q] * std::pow(static_cast<Long>(wavelength), p);
      for (const Term& term : terms(block.modes[q], model.family))
        sums[index(4 * term.row + term.column)] +=
            coefficient * term.weight * k_i[index(term.incident)] * k_r[index(term.reflected)];
    }
  }
  Mueller result;
  const Long f11 = sums[0] * model.reflectance.at(wavelength);
  for (std::size_t e = 0; e < 16; ++e) result.elements[e] = static_cast<double>(e == 0 ? f11 : f11 * sums[e]);
  return result;
}

/// The largest difference of two elements, relative to m11 of the second; infinite if a number is not finite.
inline double deviation_of_m11(const Mueller& a, const Mueller& b) {
  double largest = 0;
  for (std::size_t e = 0; e < 16; ++e) {
    const double difference = std::abs(a.elements[e] - b.elements[e]);
    if (!std::isfinite(difference)) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, difference);
  }
  return largest / std::abs(b(0, 0));
}

}  // namespace mmbrdf
