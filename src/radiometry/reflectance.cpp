// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/radiometry/reflectance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/polarization/analysis.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr double pi = std::numbers::pi;

using Table = std::array<double, zernike_count(max_order)>;

/// Slopes over the coefficients of f11, one power of the wavelength, with these values in the place of K(incident) and
/// K(reflected).
std::vector<double> slopes_with(const Block& f11, Family family, const Table& k_i, const Table& k_r) {
  std::vector<double> slopes;
  for (const Mode& mode : f11.modes) {
    double slope = 0;
    for (const Term& term : terms(mode, family))
      slope +=
          term.weight * k_i[static_cast<std::size_t>(term.incident)] * k_r[static_cast<std::size_t>(term.reflected)];
    slopes.push_back(slope);
  }
  return slopes;
}

/// Of a linear quantity with these slopes, reflectance table included.
double value_with(const std::vector<double>& slopes, const Model& model, double wavelength) {
  double sum = 0, power = 1;
  auto coefficient = model.blocks.front().coefficients.begin();
  for (int p = 0; p <= model.powers; ++p, power *= wavelength)
    for (const double slope : slopes) sum += power * *coefficient++ * slope;
  return model.reflectance.at(wavelength) * sum;
}

Table projected_integrals(DiscMapping mapping) {
  Table integrals{};
  for (const int n : {0, 2}) integrals[static_cast<std::size_t>(zernike_index(n, 0))] = projected_integral(n, mapping);
  return integrals;
}

double dot(const Stokes& a, const Stokes& b) {
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace

// ---- over the hemisphere --------------------------------------------------------------------------------------------

std::vector<double> directional_hemispherical_slopes(const Block& f11, Family family, DiscMapping mapping,
                                                     const Direction& incident) {
  require_valid(Geometry{incident, {}});
  Table k_i;
  zernike_table(orders({f11}).f11, disc_point(incident, mapping), k_i.data());
  return slopes_with(f11, family, k_i, projected_integrals(mapping));
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
  const Table integrals = projected_integrals(model.mapping);
  return value_with(slopes_with(model.blocks.front().block, model.family, integrals, integrals), model, wavelength) /
         pi;
}

int hemisphere_nodes(const Model& model) {
  const Orders order = orders(model);
  const int degree = order.f11 + order.other;                            // in the disc coordinates
  const int per_square = model.mapping == DiscMapping::lambert ? 1 : 2;  // ρ² is u, or u (2 − u)
  const int in_u = per_square * (degree / 2) + 1;                        // with cos θ = 1 − u
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

Mueller mean(const PreparedModel& model, const std::vector<WeightedDirection>& source,
             const std::vector<WeightedDirection>& receiver) {
  Mueller result;
  for (const WeightedDirection& incident : source) {
    const PreparedIncidence prepared = model.at(incident.direction);
    Mueller inner;
    for (const WeightedDirection& reflected : receiver) {
      const Mueller m = prepared.evaluate(reflected.direction);
      for (std::size_t e = 0; e < 16; ++e) inner.elements[e] += reflected.weight * m.elements[e];
    }
    for (std::size_t e = 0; e < 16; ++e) result.elements[e] += incident.weight * inner.elements[e];
  }
  return result;
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
    const std::vector<WeightedDirection> incident = source.mean_rule(nodes), reflected = receiver.mean_rule(nodes);
    const long geometries = static_cast<long>(incident.size()) * static_cast<long>(reflected.size());
    if (nodes > 3 && geometries > options.most_geometries) break;  // two rules at least
    const Mueller finer = mean(model, incident, reflected);
    const double size = largest(finer), difference = largest(finer - result.mueller);
    const bool converged = nodes > 2 && difference <= options.tolerance * size;
    result = {finer, difference + evaluation_error * size, nodes, geometries, converged};
    if (converged) break;
  }
  return result;
}

}  // namespace mmbrdf
