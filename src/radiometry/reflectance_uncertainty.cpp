// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/radiometry/reflectance_uncertainty.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mmbrdf/polarization/analysis.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"

namespace mmbrdf {
namespace {

/// Of π aᵀ M s / (a1 s1), M with this covariance: an integral over the hemisphere is π times the mean.
double reflectance_uncertainty(const MuellerCovariance& covariance, const Stokes& analyzer, const Stokes& light) {
  degree_of_polarization(analyzer);
  degree_of_polarization(light);
  const auto slope = [&](std::size_t e) { return analyzer[e / 4] / analyzer[0] * (light[e % 4] / light[0]); };
  double variance = 0;
  for (std::size_t e = 0; e < 16; ++e)
    for (std::size_t other = 0; other < 16; ++other) variance += slope(e) * covariance(e, other) * slope(other);
  return std::numbers::pi * std::sqrt(std::max(variance, 0.0));
}

MuellerCovariance covariance_of_mean(const PreparedUncertainty& prepared, const Aperture& source,
                                     const Aperture& receiver, int nodes, Frame frame) {
  const MuellerGradient gradient = prepared.gradient(mean_rule(source, receiver, nodes), frame);
  return prepared.covariance(gradient, gradient);
}

}  // namespace

// In the sp frame the axes of the beam that stays are fixed; those of the other do not matter to the first row, or
// column.

double directional_hemispherical_uncertainty(const Model& model, const PreparedUncertainty& prepared,
                                             const Direction& incident, const Stokes& light_sp) {
  const MuellerCovariance covariance = covariance_of_mean(prepared, Aperture::direction(incident),
                                                          Aperture::hemisphere(), hemisphere_nodes(model), Frame::sp);
  return reflectance_uncertainty(covariance, {1, 0, 0, 0}, light_sp);
}

double hemispherical_directional_uncertainty(const Model& model, const PreparedUncertainty& prepared,
                                             const Direction& reflected, const Stokes& analyzer_sp) {
  const MuellerCovariance covariance = covariance_of_mean(
      prepared, Aperture::hemisphere(), Aperture::direction(reflected), hemisphere_nodes(model), Frame::sp);
  return reflectance_uncertainty(covariance, analyzer_sp, {1, 0, 0, 0});
}

double bihemispherical_uncertainty(const Model& model, const PreparedUncertainty& prepared) {
  const Aperture all = Aperture::hemisphere();
  const MuellerCovariance covariance = covariance_of_mean(prepared, all, all, hemisphere_nodes(model), Frame::xy);
  return reflectance_uncertainty(covariance, {1, 0, 0, 0}, {1, 0, 0, 0});
}

MuellerCovariance average_covariance(const PreparedUncertainty& prepared, const Aperture& source,
                                     const Aperture& receiver, int nodes) {
  return covariance_of_mean(prepared, source, receiver, nodes, Frame::xy);
}

}  // namespace mmbrdf
