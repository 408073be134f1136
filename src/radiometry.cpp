// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/radiometry.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace mmbrdf {

double projected_integral(int n, DiscMapping mapping) {
  const double radial_integral = n == 0                                      ? std::numbers::pi
                                 : n == 2 && mapping == DiscMapping::lambert ? -std::numbers::pi / 3
                                                                             : 0;
  return std::sqrt((n + 1) / (2 * std::numbers::pi)) * radial_integral;
}

std::vector<Node> gauss_legendre(int count) {
  if (count < 1) throw std::invalid_argument("gauss_legendre: " + std::to_string(count) + " nodes");
  std::vector<Node> nodes;
  for (int i = 0; i < count; ++i) {  // Newton's method on the recurrence of the Legendre polynomials
    double x = std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5)), slope = 1;
    for (int step = 0; step < 100; ++step) {
      double p = 1, before = 0;
      for (int n = 1; n <= count; ++n) {
        const double next = ((2 * n - 1) * x * p - (n - 1) * before) / n;
        before = p;
        p = next;
      }
      slope = count * (x * p - before) / (x * x - 1);
      const double change = p / slope;
      x -= change;
      if (std::abs(change) < 1e-16) break;
    }
    nodes.push_back({(1 + x) / 2, 1 / ((1 - x * x) * slope * slope)});
  }
  return nodes;
}

double directional_hemispherical_reflectance(const Model& model, double wavelength, const Direction& incident) {
  require_valid(model);
  require_valid(Geometry{incident, {}}, "directional_hemispherical_reflectance");
  require_wavelength(wavelength);
  const FittedBlock& f11 = model.blocks.front();
  std::array<double, zernike_count(max_order)> k_i;
  zernike_table(orders(model).f11, disc_point(incident, model.mapping), k_i.data());
  const std::array<std::pair<int, double>, 2> integrals{{{zernike_index(0, 0), projected_integral(0, model.mapping)},
                                                         {zernike_index(2, 0), projected_integral(2, model.mapping)}}};
  double sum = 0, power = 1;
  std::size_t next = 0;
  for (int p = 0; p <= model.powers; ++p, power *= wavelength)
    for (const Mode& mode : f11.block.modes) {
      const double coefficient = power * f11.coefficients[next++];
      for (const Term& term : terms(mode, model.family))
        for (const auto& [index, integral] : integrals)
          if (term.reflected == index)
            sum += coefficient * term.weight * k_i[static_cast<std::size_t>(term.incident)] * integral;
    }
  return model.reflectance.at(wavelength) * sum;
}

}  // namespace mmbrdf
