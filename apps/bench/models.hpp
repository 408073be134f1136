// SPDX-License-Identifier: BSD-3-Clause
/// Models with every mode of their orders. The time does not depend on the coefficients.
#pragma once

#include "mmbrdf/model/model.hpp"

namespace mmbrdf::bench {

inline Model bench_model(Family family, Orders orders, int powers) {
  Model model;
  model.family = family;
  model.powers = powers;
  for (Block& block : blocks(family, orders)) {
    FittedBlock fitted{std::move(block), {}, {}, 0, 0};
    const std::size_t count = fitted.block.modes.size() * static_cast<std::size_t>(powers + 1);
    for (std::size_t i = 0; i < count; ++i) fitted.coefficients.push_back(0.1 / static_cast<double>(i + 1));
    model.blocks.push_back(std::move(fitted));
  }
  return model;
}

}  // namespace mmbrdf::bench
