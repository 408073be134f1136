// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/radiometry/reflectance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "basis/rows.hpp"
#include "basis/spectral.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/polarization/analysis.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr double pi = std::numbers::pi;

/// Slopes over the coefficients of f11, one power of the wavelength.
std::vector<double> slopes_with(const Block& f11, Family family, const KTable& k_i, const KTable& k_r) {
  std::vector<double> slopes(f11.modes.size());
  Rows(f11.modes, family).add(0, k_i, k_r, slopes.data());
  return slopes;
}

/// Of a linear quantity with these slopes, reflectance table included.
double value_with(const std::vector<double>& slopes, const Model& model, double wavelength) {
  const std::vector<double> a = at_wavelength(model.blocks.front().coefficients, slopes.size(), wavelength);
  return model.reflectance.at(wavelength) * std::inner_product(a.begin(), a.end(), slopes.begin(), 0.0);
}

/// What has no part may be unknown.
double dot(const Stokes& of_model, const Stokes& light) {
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) sum += light[i] == 0 ? 0 : of_model[i] * light[i];
  return sum;
}

}  // namespace

// ---- over the hemisphere --------------------------------------------------------------------------------------------

std::vector<double> directional_hemispherical_slopes(const Block& f11, Family family, DiscMapping mapping,
                                                     const Direction& incident) {
  require_valid(Geometry{incident, {}});
  return slopes_with(f11, family, functions_at(incident, orders({f11}).f11, mapping), over_hemisphere(mapping));
}

double directional_hemispherical_reflectance(const Model& model, double wavelength, const Direction& incident) {
  require_valid(model);
  require_wavelength(wavelength);
  const Block& f11 = model.blocks.front().block;
  return value_with(directional_hemispherical_slopes(f11, model.family, model.mapping, incident), model, wavelength);
}

double bihemispherical_reflectance(const Model& model, double wavelength) {
  require_valid(model);
  require_wavelength(wavelength);
  const KTable integrals = over_hemisphere(model.mapping);
  return value_with(slopes_with(model.blocks.front().block, model.family, integrals, integrals), model, wavelength) /
         pi;
}

int hemisphere_nodes(const Model& model) { return hemisphere_nodes(orders(model), model.mapping); }

int hemisphere_nodes(const Orders& orders, DiscMapping mapping) {
  const int degree = orders.f11 + orders.other;                    // in the disc coordinates
  const int per_square = mapping == DiscMapping::lambert ? 1 : 2;  // ρ² is u, or u (2 − u)
  const int in_u = per_square * (degree / 2) + 1;                  // with cos θ = 1 − u
  // 2 nodes − 1 ≥ in_u, and 4 nodes − 2 azimuths > degree + 2: published models add two turns of their frame
  return std::max(in_u / 2 + 1, (degree + 8) / 4);
}

double directional_hemispherical_reflectance(const Model& model, double wavelength, const Direction& incident,
                                             const Stokes& light_sp) {
  degree_of_polarization(light_sp);
  const PreparedIncidence prepared = prepare(model, wavelength).at(incident);
  Stokes row{};
  for (const auto& [reflected, weight] : Aperture::hemisphere().quadrature(hemisphere_nodes(model))) {
    const Mueller m = prepared.evaluate(reflected, Frame::sp);
    for (int j = 0; j < 4; ++j) row[static_cast<std::size_t>(j)] += weight * m(0, j);
  }
  return dot(row, light_sp) / light_sp[0];
}

double hemispherical_directional_reflectance(const Model& model, double wavelength, const Direction& reflected) {
  return directional_hemispherical_reflectance(model, wavelength, reflected);  // f11 is reciprocal in every family
}

double hemispherical_directional_reflectance(const Model& model, double wavelength, const Direction& reflected,
                                             const Stokes& analyzer_sp) {
  degree_of_polarization(analyzer_sp);
  const PreparedModel prepared = prepare(model, wavelength);
  Stokes column{};
  for (const auto& [incident, weight] : Aperture::hemisphere().quadrature(hemisphere_nodes(model))) {
    const Mueller m = prepared.evaluate({incident, reflected}, Frame::sp);
    for (int i = 0; i < 4; ++i) column[static_cast<std::size_t>(i)] += weight * m(i, 0);
  }
  return dot(column, analyzer_sp) / analyzer_sp[0];
}

// ---- over two apertures ---------------------------------------------------------------------------------------------

namespace {

/// The mean of a matrix, and of |f11|, whose rounding is in it.
struct Mean {
  Mueller mueller;
  double magnitude = 0;
};

Mean mean(const PreparedModel& model, const std::vector<WeightedDirection>& source,
          const std::vector<WeightedDirection>& receiver) {
  Mean result;
  for (const WeightedDirection& incident : source) {
    const PreparedIncidence prepared = model.at(incident.direction);
    Mueller inner;
    double magnitude = 0;
    for (const WeightedDirection& reflected : receiver) {
      const Mueller m = prepared.evaluate(reflected.direction);
      for (std::size_t e = 0; e < 16; ++e) inner.elements[e] += reflected.weight * m.elements[e];
      magnitude += std::abs(reflected.weight * m(0, 0));
    }
    for (std::size_t e = 0; e < 16; ++e) result.mueller.elements[e] += incident.weight * inner.elements[e];
    result.magnitude += std::abs(incident.weight) * magnitude;
  }
  return result;
}

/// Nodes of an aperture whose weights add up to 1.
std::vector<WeightedDirection> mean_rule(const Aperture& aperture, int nodes) {
  std::vector<WeightedDirection> rule = aperture.quadrature(nodes);
  double total = 0;
  for (const WeightedDirection& node : rule) total += node.weight;
  for (WeightedDirection& node : rule) node.weight /= total;
  return rule;
}

double largest(const Mueller& m) {
  double result = 0;
  for (const double element : m.elements) result = std::max(result, std::abs(element));
  return result;
}

}  // namespace

Average average(const PreparedModel& model, const Aperture& source, const Aperture& receiver,
                const AverageOptions& options) {
  if (!(options.tolerance >= 1e-13 && options.tolerance < 1))
    throw std::invalid_argument("tolerance " + shortest(options.tolerance) + ": must be at least 1e-13 and below 1");
  Average result{};
  for (int nodes = 2; nodes <= Aperture::most_nodes; nodes += 1 + nodes / 5) {
    const auto incident = mean_rule(source, nodes), reflected = mean_rule(receiver, nodes);
    const long geometries = static_cast<long>(incident.size()) * static_cast<long>(reflected.size());
    if (nodes > 3 && geometries > options.most_geometries) break;  // two rules at least
    const auto [finer, magnitude] = mean(model, incident, reflected);
    const double difference = largest(finer - result.mueller), rounding = evaluation_error * magnitude;
    const bool converged = nodes > 2 && difference <= std::max(options.tolerance * largest(finer), rounding);
    result = {finer, difference + rounding, nodes, geometries, converged};
    if (converged) break;
  }
  return result;
}

}  // namespace mmbrdf
