// SPDX-License-Identifier: BSD-3-Clause
#include "formats/half_difference.hpp"

#include <cmath>
#include <numbers>

#include "formats/reader.hpp"

namespace mmbrdf {

HalfDifference half_difference(double theta_h, double theta_d, double phi_d) {
  const double sh = std::sin(theta_h), ch = std::cos(theta_h), sd = std::sin(theta_d), cd = std::cos(theta_d);
  const double c = std::cos(phi_d), s = std::sin(phi_d);
  const Vector3 h{sh, 0, ch}, r{c * ch, s, -c * sh};  // r is perpendicular to h, towards the source
  HalfDifference result;
  for (std::size_t k = 0; k < 3; ++k) {
    result.incident[k] = sd * r[k] + cd * h[k];
    result.reflected[k] = -sd * r[k] + cd * h[k];
  }
  result.perpendicular = {r[1] * h[2] - r[2] * h[1], r[2] * h[0] - r[0] * h[2], r[0] * h[1] - r[1] * h[0]};
  return result;
}

bool above_horizon(const HalfDifference& directions) {
  return directions.incident[2] > horizon && directions.reflected[2] > horizon;
}

Geometry isotropic_geometry(const Vector3& incident, const Vector3& reflected) {
  const Direction i = direction(incident), r = direction(reflected);
  double difference = r.phi - i.phi;
  if (difference > std::numbers::pi) difference -= 2 * std::numbers::pi;
  if (difference <= -std::numbers::pi) difference += 2 * std::numbers::pi;
  return {{i.theta, 0}, {r.theta, difference}};
}

}  // namespace mmbrdf
