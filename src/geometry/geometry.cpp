// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/geometry/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "text/names.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr Named<Frame> frame_names[] = {
    {Frame::xy, "xy"}, {Frame::sp, "sp"}, {Frame::scattering_plane, "scattering_plane"}};

/// Angles from the (s, p) axes of each beam to (⊥, ∥).
///
/// With d = φr − φi, and s, p of each beam, ⊥ = k_in × k_out has the components
///
///     ⊥·s_in  = −sin(θi − θr) − 2 cos θi sin θr sin²(d/2)         ⊥·p_in  = −sin θr sin d
///     ⊥·s_out =  sin(θi − θr) − 2 sin θi cos θr sin²(d/2)         ⊥·p_out = −sin θi sin d
///
/// which is the cross product multiplied out, but keeps its digits where the beams are nearly parallel: there the
/// product of two rounded vectors has lost them.
FrameAngles angles_from_sp_to_plane(const Geometry& g) {
  const double sin_i = std::sin(g.incident.theta), cos_i = std::cos(g.incident.theta);
  const double sin_r = std::sin(g.reflected.theta), cos_r = std::cos(g.reflected.theta);
  const double d = g.reflected.phi - g.incident.phi;
  const double sin_difference = std::sin(g.incident.theta - g.reflected.theta);
  const double sin_d = std::sin(d), half = std::sin(d / 2), versine = 2 * half * half;

  const double s_in = -sin_difference - cos_i * sin_r * versine, p_in = -sin_r * sin_d;
  const double s_out = sin_difference - sin_i * cos_r * versine, p_out = -sin_i * sin_d;
  if (std::hypot(s_in, p_in) < parallel_limit)  // ⊥ is s_in = (sin φi, −cos φi, 0)
    return {.scattered = std::atan2(cos_r * sin_d, -std::cos(d)), .incident = 0};
  return {.scattered = std::atan2(p_out, s_out), .incident = std::atan2(p_in, s_in)};
}

std::string begun(const char* where) { return *where == 0 ? "" : std::string(where) + ": "; }

void require_theta(double theta, const char* where, const char* name) {
  if (theta >= 0 && theta <= radians(90)) return;
  throw std::invalid_argument(begun(where) + name + " = " + shortest(in_degrees(theta)) +
                              " degrees, must be in 0...90");
}

void require_phi(double phi, const char* where, const char* name) {
  if (std::isfinite(phi)) return;
  throw std::invalid_argument(begun(where) + name + " = " + shortest(phi) + ", must be finite");
}

}  // namespace

Vector3 unit_vector(const Direction& direction) {
  const double sin_theta = std::sin(direction.theta);
  return {sin_theta * std::cos(direction.phi), sin_theta * std::sin(direction.phi), std::cos(direction.theta)};
}

Direction direction(const Vector3& vector) {
  const auto [x, y, z] = vector;
  if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z) || z < 0 || (x == 0 && y == 0 && z == 0))
    throw std::invalid_argument("vector = (" + shortest(x) + ", " + shortest(y) + ", " + shortest(z) +
                                "), must be finite, not 0, with z >= 0");
  if (x == 0 && y == 0) return {0, 0};
  const double longest = std::max({std::abs(x), std::abs(y), z});  // no overflow for any length
  const double phi = std::atan2(y, x);                             // −π where y is −0 or lost beside x
  return {std::atan2(std::hypot(x / longest, y / longest), z / longest),
          phi == -std::numbers::pi ? std::numbers::pi : phi};
}

Direction unfolded(const Direction& direction) {
  if (direction.theta < 0) return {-direction.theta, direction.phi + std::numbers::pi};
  return direction;
}

Direction direction_from_degrees(double theta, double phi) {
  if (!(std::abs(theta) <= 90))
    throw std::invalid_argument(shortest(theta) + "," + shortest(phi) +
                                ": the polar angle is not in [-90, 90] degrees");
  const double opposite = phi + (phi > 0 ? -180 : 180);
  return {radians(std::abs(theta)), radians(theta < 0 ? opposite : phi)};
}

void require_valid(const Geometry& geometry, const char* where) {
  require_theta(geometry.incident.theta, where, "theta_i");
  require_theta(geometry.reflected.theta, where, "theta_r");
  require_phi(geometry.incident.phi, where, "phi_i");
  require_phi(geometry.reflected.phi, where, "phi_r");
}

Geometry exchanged(const Geometry& geometry) { return {geometry.reflected, geometry.incident}; }

FrameAngles angles_to_xy(const Geometry& geometry, Frame frame) {
  const FrameAngles from_sp{.scattered = -geometry.reflected.phi, .incident = geometry.incident.phi};
  switch (frame) {
    case Frame::xy:
      return {0, 0};
    case Frame::sp:
      return from_sp;
    case Frame::scattering_plane: {
      const FrameAngles plane = angles_from_sp_to_plane(geometry);
      return {from_sp.scattered - plane.scattered, from_sp.incident - plane.incident};
    }
  }
  throw std::invalid_argument("no frame has the number " + std::to_string(static_cast<int>(frame)));
}

Mueller change_frame(const Mueller& m, const Geometry& geometry, Frame from, Frame to) {
  require_valid(geometry);
  if (from == to) return m;
  const FrameAngles a = angles_to_xy(geometry, from), b = angles_to_xy(geometry, to);
  return rotated(m, a.scattered - b.scattered, a.incident - b.incident);
}

MuellerCovariance change_frame(const MuellerCovariance& covariance, const Geometry& geometry, Frame from, Frame to) {
  require_valid(geometry);
  const FrameAngles a = angles_to_xy(geometry, from), b = angles_to_xy(geometry, to);
  return transformed(covariance, rotator(a.scattered - b.scattered), rotator(b.incident - a.incident));
}

Mueller turned(const Mueller& m_xy, double angle) { return rotated(m_xy, -angle, angle); }

std::string to_string(Frame frame) { return name_of(frame_names, frame); }
Frame frame_from(const std::string& name) { return value_of(frame_names, name, "frame"); }

}  // namespace mmbrdf
