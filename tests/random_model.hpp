// SPDX-License-Identifier: BSD-3-Clause
/// Models with random coefficients, the same on every machine. Whatever the orders, f11 stays near 1/π sr⁻¹ and the
/// normalised elements mostly below 1.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <utility>

#include "mmbrdf/model.hpp"

namespace mmbrdf {

inline Model random_model(Family family, Orders orders, int powers, std::uint64_t seed,
                          DiscMapping mapping = DiscMapping::lambert) {
  std::mt19937_64 engine(seed);
  const auto random = [&] { return static_cast<double>(engine() >> 10) * 0x1p-53 - 1; };  // in [−1, 1)
  Model model;
  model.name = "random";
  model.family = family;
  model.mapping = mapping;
  model.powers = powers;
  for (Block& block : blocks(family, orders)) {
    FittedBlock fitted{std::move(block), {}, {}, 0, 0};
    const auto [row, column] = fitted.block.elements.front();
    const bool is_f11 = row == 0 && column == 0;
    const double count = static_cast<double>(fitted.block.modes.size()) * (powers + 1);
    const double amplitude =
        (is_f11 ? 0.03 : 0.3) * 2 * std::numbers::pi / std::sqrt(count);  // 2π: area of a hemisphere
    for (int p = 0; p <= powers; ++p)
      for (const Mode& mode : fitted.block.modes)
        fitted.coefficients.push_back(amplitude * random() / std::sqrt(squared_norm(mode, family, row, column)));
    // The first mode of f11 is a constant, weight × K_0^0(i) K_0^0(r), and K_0^0 is 1/√(2π).
    if (is_f11) fitted.coefficients.front() = 2 / terms(fitted.block.modes.front(), family).front().weight;
    model.blocks.push_back(std::move(fitted));
  }
  return model;
}

}  // namespace mmbrdf
