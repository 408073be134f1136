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

std::vector<double> directional_hemispherical_slopes(const Block& f11, Family family, DiscMapping mapping,
                                                     const Direction& incident) {
  require_valid(Geometry{incident, {}}, "directional_hemispherical_reflectance");
  std::array<double, zernike_count(max_order)> k_i;
  zernike_table(orders({f11}).f11, disc_point(incident, mapping), k_i.data());
  std::vector<double> slopes;
  for (const Mode& mode : f11.modes) {
    double slope = 0;
    for (const Term& term : terms(mode, family))
      for (const int n : {0, 2})  // all others integrate to 0
        if (term.reflected == zernike_index(n, 0))
          slope += term.weight * k_i[static_cast<std::size_t>(term.incident)] * projected_integral(n, mapping);
    slopes.push_back(slope);
  }
  return slopes;
}

double directional_hemispherical_reflectance(const Model& model, double wavelength, const Direction& incident) {
  require_valid(model);
  require_wavelength(wavelength);
  const FittedBlock& f11 = model.blocks.front();
  const std::vector<double> slopes = directional_hemispherical_slopes(f11.block, model.family, model.mapping, incident);
  double sum = 0, power = 1;
  auto coefficient = f11.coefficients.begin();
  for (int p = 0; p <= model.powers; ++p, power *= wavelength)
    for (const double slope : slopes) sum += power * *coefficient++ * slope;
  return model.reflectance.at(wavelength) * sum;
}

}  // namespace mmbrdf
