// SPDX-License-Identifier: BSD-3-Clause
/// Models for tests, and what compares them.
#pragma once

#include <rapidcheck.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "mmbrdf/model/model.hpp"

namespace mmbrdf {

/// Random coefficients, the same on every machine. Whatever the orders, f11 stays near 1/π sr⁻¹ and the normalised
/// elements mostly below 1.
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

/// f11 = Σ_p values[p] λ^p sr⁻¹ at every geometry, and nothing else.
inline Model diffuser(const std::vector<double>& values) {
  Model model;
  model.powers = static_cast<int>(values.size()) - 1;
  model.blocks.push_back({blocks(model.family, {0, 0}).front(), {}, {}, 0, 0});
  for (const double value : values)
    model.blocks[0].coefficients.push_back(value * std::numbers::pi / 2);  // the mode is 2/π
  return model;
}

/// Of germer2017, not its own mirror image: element 12 has sines of φ_r − φ_i beside cosines, element 13 cosines. Element 12 is
/// known as if by a fit that saw one side.
inline Model handed() {
  Model model;
  model.name = "handed";
  model.family = Family::germer2017;
  model.blocks.push_back({blocks(model.family, std::vector<Mode>{{Function::m11, 0, 0, 0, 0}}).front(), {0.3}, {}});
  for (const auto& [modes, coefficients] :
       {std::pair{std::vector<Mode>{{Function::m12, 0, 2, 0, 2}, {Function::m12, 0, 2, 0, -2}}, std::vector{0.2, 0.3}},
        std::pair{std::vector<Mode>{{Function::m13, 0, 2, 0, 2}}, std::vector{-0.2}}})
    model.blocks.push_back({blocks(model.family, modes).front(), coefficients, {}});
  model.blocks[1].covariance = {1e-4, 9e-5, 9e-5, 1e-4};
  return model;
}

inline Geometry in_degrees(double theta_i, double phi_i, double theta_r, double phi_r) {
  return {{radians(theta_i), radians(phi_i)}, {radians(theta_r), radians(phi_r)}};
}

/// Of the coefficients of two models with the same modes.
inline double largest_difference(const Model& a, const Model& b) {
  EXPECT_EQ(a.blocks.size(), b.blocks.size());
  double largest = 0;
  for (std::size_t block = 0; block < a.blocks.size(); ++block) {
    EXPECT_EQ(a.blocks[block].block.modes, b.blocks[block].block.modes);
    for (std::size_t i = 0; i < a.blocks[block].coefficients.size(); ++i)
      largest = std::max(largest, std::abs(a.blocks[block].coefficients.at(i) - b.blocks[block].coefficients.at(i)));
  }
  return largest;
}

/// Root mean square over the 15 normalised elements of residuals.
inline double rms(const std::vector<Mueller>& residuals) {
  double squares = 0;
  for (const Mueller& r : residuals)
    for (std::size_t e = 1; e < 16; ++e) squares += r.elements[e] * r.elements[e];
  return std::sqrt(squares / 15 / static_cast<double>(residuals.size()));
}

/// The model covariant or as printed.
inline Model either_way(Model model) {
  model.rotation = *rc::gen::element(Rotation::covariant, Rotation::as_printed);
  return model;
}

}  // namespace mmbrdf
