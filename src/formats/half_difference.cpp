// SPDX-License-Identifier: BSD-3-Clause
#include "formats/half_difference.hpp"

#include <cmath>
#include <numbers>

#include "formats/reader.hpp"

namespace mmbrdf {
namespace {

/// A beam along k with its axis ⊥: the angle, doubled, from ⊥ to s, which is at `phi` + 90 degrees in the surface.
Mueller to_sp(const Vector3& k, const Vector3& perpendicular, double phi) {
  const Vector3& x = perpendicular;
  const Vector3 y{k[1] * x[2] - k[2] * x[1], k[2] * x[0] - k[0] * x[2], k[0] * x[1] - k[1] * x[0]};
  const double s_x = -std::sin(phi), s_y = std::cos(phi);
  const double c = x[0] * s_x + x[1] * s_y, s = y[0] * s_x + y[1] * s_y;
  return rotator(c * c - s * s, 2 * c * s);
}

double azimuth(const Vector3& v) { return v[0] == 0 && v[1] == 0 ? 0 : std::atan2(v[1], v[0]); }

}  // namespace

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

HalfAngles half_angles(const Vector3& incident, const Vector3& reflected) {
  Vector3 h{};
  for (std::size_t k = 0; k < 3; ++k) h[k] = incident[k] + reflected[k];
  const double length = std::hypot(h[0], h[1], h[2]), across = std::hypot(h[0], h[1]);
  const Vector3 d{incident[0] - reflected[0], incident[1] - reflected[1], incident[2] - reflected[2]};
  // b = n × h and t = b × h; along the normal those of azimuth 0.
  const double c = across > 0 ? h[0] / across : 1, s = across > 0 ? h[1] / across : 0;
  const double along_b = -s * d[0] + c * d[1];
  const double along_t = (h[2] * (c * d[0] + s * d[1]) - across * d[2]) / length;
  return {std::atan2(across, h[2]), std::atan2(std::hypot(d[0], d[1], d[2]), length), std::atan2(along_b, along_t)};
}

NodeAxes::NodeAxes(const HalfDifference& directions)
    : geometry(isotropic_geometry(directions.incident, directions.reflected)) {
  const auto& [i, o, perpendicular] = directions;
  // Of incident light s is z × k as well, and points the other way: half a turn, which changes no Stokes vector.
  const Mueller incident = to_sp({-i[0], -i[1], -i[2]}, perpendicular, azimuth(i));
  const Mueller reflected = to_sp(o, perpendicular, azimuth(o));
  const FrameAngles angles = angles_to_xy(geometry, Frame::sp);
  left = rotator(angles.scattered) * reflected;
  right = transpose(rotator(angles.incident) * incident);
}

}  // namespace mmbrdf
