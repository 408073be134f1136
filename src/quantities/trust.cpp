// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/quantities/trust.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/polarization/analysis.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"
#include "mmbrdf/text/units.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

void take_in(ModelDiagnostics& result, const Geometry& geometry, const PreparedModel& prepared) {
  const Mueller f = prepared.evaluate(geometry);
  ++result.geometries;
  if (!(f(0, 0) > 0)) ++result.not_positive_f11;
  if (f(0, 0) < result.f11.value) result.f11 = {f(0, 0), geometry};
  if (f(0, 0) == 0) return;
  const double margin = realizability_margin(normalized(f));
  if (margin < 0) ++result.unrealizable;
  if (margin < result.margin.value) result.margin = {margin, geometry};
}

}  // namespace

ModelDiagnostics model_diagnostics(const Model& model, double wavelength, double theta_max) {
  if (!(theta_max >= 0 && theta_max <= radians(90) * (1 + 1e-12)))
    throw std::invalid_argument("largest polar angle " + shortest(degrees(theta_max)) + " degrees is not in [0, 90]");
  const PreparedModel prepared = prepare(model, wavelength);
  ModelDiagnostics result;
  result.wavelength = wavelength;
  result.theta_max = theta_max;
  result.margin.value = result.f11.value = std::numeric_limits<double>::max();
  const auto steps = static_cast<int>(degrees(theta_max) / 2.5 + 1e-9);
  for (int i = 0; i <= steps; ++i)
    for (int r = 0; r <= steps; ++r)
      for (int d = 0; d <= 24; ++d)
        take_in(result, {{radians(2.5 * i), 0}, {radians(2.5 * r), radians(7.5 * d)}}, prepared);
  if (result.margin.value == std::numeric_limits<double>::max()) result.margin = {};  // f11 is 0 everywhere
  for (int i = 0; i <= 5 * steps; ++i) {
    const double theta = radians(0.5 * i), dhr = directional_hemispherical_reflectance(model, wavelength, {theta, 0});
    if (i == 0 || dhr > result.dhr) {
      result.dhr = dhr;
      result.dhr_theta_i = theta;
    }
  }
  return result;
}

}  // namespace mmbrdf
