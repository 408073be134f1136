// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarimetry/measurement.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "text/numbers.hpp"

namespace mmbrdf {

Sample reduced(const Reduction& reduction, const RawMeasurement& measurement, double solid_angle,
               const ReadingNoise& noise) {
  for (const double part : {noise.dark, noise.shot, noise.relative})
    if (!(part >= 0) || !std::isfinite(part))
      throw std::invalid_argument("a noise of " + shortest(part) + ", must be finite and not negative");
  const auto& [wavelength, geometry, readings] = measurement;
  const Mueller m = reduction.mueller(readings);
  Sample result = sample(m, wavelength, geometry, solid_angle);
  std::vector<double> variances;
  for (const double reading : readings) variances.push_back(variance(noise, reading));
  const MuellerCovariance c = normalized(reduction.from_readings(variances), m);
  result.uncertainty = standard_uncertainty(change_frame(c, geometry, Frame::scattering_plane, Frame::xy));
  result.uncertainty(0, 0) /= solid_angle * std::cos(geometry.reflected.theta);
  for (const double u : result.uncertainty.elements)
    if (!std::isfinite(u)) throw std::invalid_argument("the noise leaves no finite uncertainty");
  return result;
}

}  // namespace mmbrdf
