// SPDX-License-Identifier: BSD-3-Clause
// How the expansion is evaluated by programs that follow the printed equations: for each coefficient its wavelength
// power, its radial polynomials from factorials and powers, and its sines and cosines.
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "bench.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/samples/samples.hpp"
#include "models.hpp"

namespace mmbrdf::bench {
namespace {

double factorial(int n) { return n < 2 ? 1 : n * factorial(n - 1); }

/// Eq. 5
double radial_by_factorials(int n, int k, double rho) {
  k = std::abs(k);
  double sum = 0;
  for (int s = 0; s <= (n - k) / 2; ++s)
    sum += std::pow(-1, s) * factorial(n - s) /
           (factorial(s) * factorial((n + k) / 2 - s) * factorial((n - k) / 2 - s)) * std::pow(rho, n - 2 * s);
  return sum;
}

/// Eqs. 3, 4 and 6
double zernike_by_factorials(int n, int k, const mmbrdf::Direction& d) {
  const double azimuthal = k == 0 ? 1 / std::numbers::sqrt2 : k > 0 ? std::cos(k * d.phi) : std::sin(-k * d.phi);
  return std::sqrt((n + 1) / std::numbers::pi) *
         radial_by_factorials(n, k, std::numbers::sqrt2 * std::sin(d.theta / 2)) * azimuthal;
}

struct Order {
  int n, k;
};
/// Of a place in a table of Zernike functions.
Order order_of(int index) {
  int n = 0;
  while (zernike_count(n) <= index) ++n;
  return {n, 2 * index - n * (n + 2)};
}

struct Product {
  int row, column;
  Order incident, reflected;
  double weight;
};

Mueller evaluate_by_the_book(const Model& model, const std::vector<std::vector<std::vector<Product>>>& products,
                             double wavelength, const Geometry& g) {
  Mueller result;
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    const auto& [block, coefficients, covariance, rank, condition, null_space, rows] = model.blocks[b];
    for (std::size_t q = 0; q < block.modes.size(); ++q) {
      double a = 0;
      for (int p = 0; p <= model.powers; ++p)
        a += std::pow(wavelength, p) * coefficients[static_cast<std::size_t>(p) * block.modes.size() + q];
      for (const Product& product : products[b][q])
        result(product.row, product.column) +=
            a * product.weight * zernike_by_factorials(product.incident.n, product.incident.k, g.incident) *
            zernike_by_factorials(product.reflected.n, product.reflected.k, g.reflected);
    }
  }
  for (std::size_t e = 1; e < 16; ++e) result.elements[e] *= result.elements[0];
  return model.reflectance.at(wavelength) * result;
}

void textbook(benchmark::State& state, const Model& model) {
  std::vector<std::vector<std::vector<Product>>> products;
  for (const FittedBlock& fitted : model.blocks) {
    products.emplace_back();
    for (const Mode& mode : fitted.block.modes) {
      products.back().emplace_back();
      for (const Term& t : terms(mode, model.family))
        products.back().back().push_back({t.row, t.column, order_of(t.incident), order_of(t.reflected), t.weight});
    }
  }
  const std::vector<Geometry> geometries = random_geometries(100, 1);
  Report report(state);
  std::size_t q = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(evaluate_by_the_book(model, products, 0.532, geometries[q++ % geometries.size()]));
  report.finish(1);
}

}  // namespace

void register_textbook() {
  benchmark::RegisterBenchmark("textbook/germer2017", [](benchmark::State& state) {
    textbook(state, bench_model(Family::germer2017, {7, 4}, 1));
  });
  benchmark::RegisterBenchmark("textbook/isotropic",
                               [](benchmark::State& state) { textbook(state, material("ptfe")); });
}

}  // namespace mmbrdf::bench
