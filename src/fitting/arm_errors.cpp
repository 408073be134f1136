// SPDX-License-Identifier: BSD-3-Clause
#include "fitting/arm_errors.hpp"

#include <algorithm>
#include <cmath>

namespace mmbrdf {
namespace {

constexpr double step = 1e-4;

double dot(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Rodrigues' rotation.
Vector3 turned(const Vector3& v, const Vector3& axis, double angle) {
  const Vector3 across = cross(axis, v);
  const double c = std::cos(angle), s = std::sin(angle), along = dot(axis, v) * (1 - c);
  return {v[0] * c + across[0] * s + axis[0] * along, v[1] * c + across[1] * s + axis[1] * along,
          v[2] * c + across[2] * s + axis[2] * along};
}

/// Axes x and y of a scattered beam along k in the xy frame (theory 1.1).
struct Axes {
  Vector3 x, y;
  explicit Axes(const Vector3& k) {
    const double a = 1 + k[2];
    x = {1 - k[0] * k[0] / a, -k[0] * k[1] / a, -k[0]};
    y = cross(x, k);
  }
};

/// Angle from the axes at k2, turned back to k, to those at k.
double carried(const Vector3& k2, const Vector3& k, const Vector3& axis, double angle) {
  const Axes there(k2);
  const Vector3 x = turned(there.x, axis, -angle), y = turned(there.y, axis, -angle), here = Axes(k).y;
  return std::atan2(dot(here, x), dot(here, y));
}

/// f11 and the normalised elements with the arms turned by these angles.
Mueller reading(const PreparedModel& model, const Geometry& g, double source, double receiver) {
  const Vector3 axis{std::sin(g.incident.phi), -std::cos(g.incident.phi), 0};
  const Vector3 s = unit_vector(g.incident), r = unit_vector(g.reflected);
  Vector3 s2 = turned(s, axis, source), r2 = turned(r, axis, receiver);
  s2[2] = std::max(s2[2], 0.0);
  r2[2] = std::max(r2[2], 0.0);
  Mueller m = model.evaluate({direction(s2), direction(r2)});
  const double f11 = m(0, 0);
  for (double& element : m.elements) element /= f11;
  m = rotated(m, carried(r2, r, axis, receiver), 0);  // the source stays on its meridian, along which axes are carried
  m(0, 0) = f11;
  return m;
}

Mueller slope(const Mueller& above, const Mueller& below) {
  Mueller result;
  for (std::size_t e = 0; e < 16; ++e) result.elements[e] = (above.elements[e] - below.elements[e]) / (2 * step);
  return result;
}

}  // namespace

ArmErrors arm_errors(const PreparedModel& model, std::span<const Geometry> geometries) {
  ArmErrors result;
  for (const Geometry& g : geometries) {
    result.source.push_back(slope(reading(model, g, step, 0), reading(model, g, -step, 0)));
    result.receiver.push_back(slope(reading(model, g, 0, step), reading(model, g, 0, -step)));
  }
  return result;
}

}  // namespace mmbrdf
