// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/formats/projection.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/numerics/quadrature.hpp"

namespace mmbrdf {

// ---- published form -------------------------------------------------------------------------------------------------

namespace {

struct ZernikeIndex {
  int n, k;
};

/// The inverse of zernike_index.
ZernikeIndex from_index(int index) {
  int n = 0;
  while (zernike_count(n) <= index) ++n;
  return {n, 2 * index - n * (n + 2)};
}

/// The published mode that a product belongs to at phi_i = 0, and the coefficient that gives it weight 1 there. Of an
/// element below the diagonal the product is that of Eq. 16; a mode with k, l ≥ 0 is taken from above the diagonal
/// only.
std::optional<std::pair<Mode, double>> published_mode(const Term& term) {
  auto [n, k] = from_index(term.incident);
  auto [m, l] = from_index(term.reflected);
  if (k < 0) return {};  // sin k phi_i is zero
  int row = term.row, column = term.column;
  int sign = 1;
  if (row > column) {
    if (l >= 0) return {};
    std::swap(row, column);
    std::swap(n, m);
    std::swap(k, l);
    sign = exchange_sign(row, column);
  } else if (row == column && std::tuple(n, k) < std::tuple(m, l)) {
    return {};  // its twin is there too
  }
  const Mode mode{function_of(row, column), n, m, k, l};
  return {{mode, sign / terms(mode, Family::germer2017).front().weight}};
}

}  // namespace

Model in_published_form(const Model& model) {
  require_valid(model);
  if (model.family == Family::germer2017) return model;
  if (!traits(model.family).published_form)
    throw std::invalid_argument("a model of the " + to_string(model.family) + " family has no published form");
  std::map<std::tuple<Function, int, int, int, int>, std::vector<double>> found;  // a coefficient for each power
  const auto key = [](const Mode& mode) { return std::tuple(mode.function, mode.n, mode.m, mode.k, mode.l); };
  std::vector<Mode> modes;
  const auto powers = static_cast<std::size_t>(model.powers) + 1;
  for (const FittedBlock& fitted : model.blocks)
    for (std::size_t q = 0; q < fitted.block.modes.size(); ++q)
      for (const Term& term : terms(fitted.block.modes[q], model.family)) {
        const auto published = published_mode(term);
        if (!published) continue;
        const auto [at, is_new] = found.try_emplace(key(published->first), powers, 0.0);
        if (is_new) modes.push_back(published->first);
        for (std::size_t p = 0; p < powers; ++p)
          at->second[p] += published->second * term.weight * fitted.coefficients[p * fitted.block.modes.size() + q];
      }
  Model result = model;
  result.family = Family::germer2017;
  result.rotation = Rotation::covariant;  // no matter what it was: the isotropic family is evaluated as it is
  result.reflectance = {model.reflectance.wavelengths, model.reflectance.values};
  result.posterior.reset();
  result.blocks.clear();
  for (Block& block : blocks(Family::germer2017, modes)) {
    FittedBlock fitted{std::move(block), {}, {}, 0, 0};
    for (std::size_t p = 0; p < powers; ++p)
      for (const Mode& mode : fitted.block.modes) fitted.coefficients.push_back(found.at(key(mode))[p]);
    result.blocks.push_back(std::move(fitted));
  }
  return result;
}

// ---- projection -----------------------------------------------------------------------------------------------------

namespace {

constexpr double right_angle = std::numbers::pi / 2;

/// Geometries at phi_i = 0 and weights that integrate over the range of a model in solid angle, dΩ = d(1 − cos θ) dφ.
std::vector<std::pair<Geometry, double>> quadrature(const Validity& validity, int order) {
  const double height_i = 1 - std::cos(validity.theta_i_max.value_or(right_angle)),
               height_r = 1 - std::cos(validity.theta_r_max.value_or(right_angle));
  const int azimuths = 4 * order + 8;
  std::vector<std::pair<Geometry, double>> result;
  for (const Node& i : gauss_legendre(order + 6))
    for (const Node& r : gauss_legendre(order + 6))
      for (int a = 0; a < azimuths; ++a)
        result.push_back(
            {{{std::acos(1 - i.x * height_i), 0}, {std::acos(1 - r.x * height_r), 2 * std::numbers::pi * a / azimuths}},
             i.weight * r.weight});
  return result;
}

/// powers + 1 or more wavelengths, enough to determine polynomials of that degree.
std::vector<double> wavelengths_for(const Model& model) {
  std::vector<double> list = model.validity.wavelengths;
  if (list.size() > static_cast<std::size_t>(model.powers)) return list;
  list.clear();
  for (int p = 0; p <= model.powers; ++p) list.push_back(0.5 + 0.5 * p);
  return list;
}

}  // namespace

Model projected_on_isotropic(const Model& model, const Orders& orders) {
  require_valid(model);
  if (model.family == Family::anisotropic)
    throw std::invalid_argument("a model of the anisotropic family is not isotropic");
  if (std::max(orders.f11, orders.other) > max_projected_order)
    throw std::invalid_argument("order " + std::to_string(std::max(orders.f11, orders.other)) +
                                " is more than can be projected on, " + std::to_string(max_projected_order));
  Model bare = model;
  bare.reflectance = {};
  FitAccumulator accumulator({Family::isotropic, orders, model.mapping});
  const Orders both = mmbrdf::orders(model);
  const auto nodes = quadrature(model.validity, std::max({orders.f11, orders.other, both.f11, both.other}));
  for (const double wavelength : wavelengths_for(model)) {
    const PreparedModel prepared = prepare(bare, wavelength);
    std::vector<Sample> samples;
    std::vector<Mueller> weights;
    for (const auto& [geometry, weight] : nodes) {
      const Mueller m = prepared.evaluate(geometry);
      samples.push_back({wavelength, geometry, m(0, 0), normalized(m)});
      weights.emplace_back().elements.fill(weight);
    }
    accumulator.add(samples, weights);
  }
  Model result = accumulator.solve({model.powers, ReflectanceTable{}, false}).model;
  for (FittedBlock& fitted : result.blocks) {
    fitted.covariance.clear();  // of the quadrature, not of the data
    fitted.rank = 0;
    fitted.condition = 0;
  }
  result.name = model.name;
  result.reflectance = {model.reflectance.wavelengths, model.reflectance.values};
  result.validity = model.validity;
  result.provenance = model.provenance;
  return result;
}

}  // namespace mmbrdf
