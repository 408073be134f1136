// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/geometry/apertures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "mmbrdf/numerics/quadrature.hpp"
#include "numerics/golden_section.hpp"
#include "text/numbers.hpp"

//   α, ψ     angle from the axis, and azimuth about it from e1 towards e2
//   s        1 − cos α, the versine: dΩ = ds dψ
//   A, B     tan half_theta and tan half_phi

namespace mmbrdf {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double edge = 1e-12;  // radians: angles that went through degrees still touch

std::string in_degrees_text(double angle) { return shortest(in_degrees(angle)); }

std::string text_of(const Direction& axis) { return in_degrees_text(axis.theta) + "," + in_degrees_text(axis.phi); }

void require_size(double size, const std::string& what) {
  if (size >= smallest_width) return;
  throw std::invalid_argument(what + ": " + in_degrees_text(size) + " degrees, must be at least " +
                              rounded(degrees(smallest_width), 3));
}

void require_inside_horizon(bool inside, const std::string& shape, const Direction& axis, const std::string& sizes) {
  if (inside) return;
  throw std::invalid_argument(shape + " about " + text_of(axis) + " with half-angle " + sizes +
                              " degrees reaches below the horizon");
}

/// Unit vectors along the axis, and across it along rising θ and φ, turned.
struct Axes {
  Vector3 along, e1, e2;
};

Axes axes_of(const Direction& axis, double turn) {
  const double sin_theta = std::sin(axis.theta), cos_theta = std::cos(axis.theta);
  const double sin_phi = std::sin(axis.phi), cos_phi = std::cos(axis.phi), c = std::cos(turn), s = std::sin(turn);
  const Vector3 theta{cos_theta * cos_phi, cos_theta * sin_phi, -sin_theta}, phi{-sin_phi, cos_phi, 0};
  Axes axes{unit_vector(axis), {}, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    axes.e1[i] = c * theta[i] + s * phi[i];
    axes.e2[i] = c * phi[i] - s * theta[i];
  }
  return axes;
}

/// a along + x e1 + y e2. Rounding may leave a node at the horizon below it.
Vector3 combined(const Axes& axes, double a, double x, double y) {
  Vector3 v;
  for (std::size_t i = 0; i < 3; ++i) v[i] = a * axes.along[i] + x * axes.e1[i] + y * axes.e2[i];
  v[2] = std::max(v[2], 0.0);
  return v;
}

double angle_between(const Direction& a, const Direction& b) {  // Haversines keep the digits of small angles
  const double polar = std::sin((a.theta - b.theta) / 2), azimuthal = std::sin((a.phi - b.phi) / 2);
  const double haversine = polar * polar + std::sin(a.theta) * std::sin(b.theta) * azimuthal * azimuthal;
  return 2 * std::asin(std::min(1.0, std::sqrt(haversine)));
}

/// Smallest value of a smooth function of an angle.
template <class F>
double minimum_on_circle(F f) {
  return f(scanned_minimum(f, 0, 2 * pi, 256, 1e-12));
}

double versine_difference(double low, double high) {
  return 2 * std::sin((high + low) / 2) * std::sin((high - low) / 2);
}

/// Gauss–Legendre in s from the inner to the outer circle of a cone × equidistant ψ.
void add_cone(const Axes& axes, double inner, double outer, int nodes, double sign,
              std::vector<WeightedDirection>& list) {
  const double first = versine_difference(0, inner), length = versine_difference(inner, outer);
  const int azimuths = 4 * nodes - 2;
  for (const Node& node : gauss_legendre(nodes))
    for (int a = 0; a < azimuths; ++a) {
      const double psi = 2 * pi * a / azimuths, s = first + length * node.x, sin_alpha = std::sqrt(s * (2 - s));
      const Vector3 v = combined(axes, 1 - s, sin_alpha * std::cos(psi), sin_alpha * std::sin(psi));
      list.push_back({direction(v), sign * v[2] * length * node.weight * 2 * pi / azimuths});
    }
}

/// With sin η = sin b sin s and |tan ξ| ≤ tan a cos s, and v = cos ξ (cos η axis + sin η e2) + sin ξ e1: cos θ dΩ =
/// v_z cos ξ dξ dη. Gauss–Legendre in ξ × equidistant s: everything is analytic in s, and hardly more narrow than b is for
/// b near π/2, if e2 is along the larger half-angle.
void add_ellipse(Axes axes, double half_a, double half_b, int nodes, double sign,
                 std::vector<WeightedDirection>& list) {
  if (half_a > half_b) {
    std::swap(axes.e1, axes.e2);
    std::swap(half_a, half_b);
  }
  const double tan_a = std::tan(half_a), sin_b = std::sin(half_b), cos_b = std::cos(half_b);
  const std::vector<Node> rule = gauss_legendre(2 * nodes);
  const int intervals = 2 * nodes + 1;
  for (int k = 1; k < intervals; ++k) {
    const double s = pi * k / intervals - pi / 2, cos_s = std::cos(s);
    const double sin_eta = sin_b * std::sin(s), cos_eta = std::hypot(cos_b, sin_b * cos_s);
    const double half = std::atan(tan_a * cos_s), d_eta = sin_b * cos_s / cos_eta * pi / intervals;
    for (const Node& node : rule) {
      const double xi = half * (2 * node.x - 1), cos_xi = std::cos(xi);
      const Vector3 v = combined(axes, cos_xi * cos_eta, std::sin(xi), cos_xi * sin_eta);
      list.push_back({direction(v), sign * v[2] * cos_xi * 2 * half * node.weight * d_eta});
    }
  }
}

/// With tan ξ = X A, tan η = Y B and v = axis + tan ξ e1 + tan η e2: cos θ dΩ = v_z dX A dY B / |v|⁴.
void add_rectangle(const Axes& axes, double half_a, double half_b, int nodes, double sign,
                   std::vector<WeightedDirection>& list) {
  const std::vector<Node> rule = gauss_legendre(2 * nodes);
  for (const Node& a : rule)
    for (const Node& b : rule) {
      const double x = std::tan(half_a * (2 * a.x - 1)), y = std::tan(half_b * (2 * b.x - 1));
      const double length_squared = 1 + x * x + y * y;
      const double jacobian = (1 + x * x) / length_squared * ((1 + y * y) / length_squared);
      const Vector3 v = combined(axes, 1, x, y);
      list.push_back({direction(v), sign * v[2] * jacobian * 4 * half_a * a.weight * half_b * b.weight});
    }
}

void add_ring(double theta_min, double theta_max, int nodes, double sign, std::vector<WeightedDirection>& list) {
  const int azimuths = 4 * nodes - 2;
  const auto add_circle = [&](double theta, double weight) {
    for (int a = 0; a < azimuths; ++a) list.push_back({{theta, 2 * pi * a / azimuths}, sign * weight / azimuths});
  };
  if (theta_min == theta_max) return add_circle(theta_min, 1);
  const double first = versine_difference(0, theta_min), length = versine_difference(theta_min, theta_max);
  for (const Node& node : gauss_legendre(nodes)) {
    const double s = first + length * node.x;
    add_circle(2 * std::asin(std::sqrt(s / 2)), (1 - s) * length * node.weight * 2 * pi);
  }
}

}  // namespace

// ---- shapes ---------------------------------------------------------------------------------------------------------

Aperture Aperture::direction(const Direction& direction) {
  require_valid(Geometry{direction, direction}, "aperture");
  return {Shape::direction, direction, {0, 0}};
}

Aperture Aperture::cone(const Direction& axis, double half_angle) {
  require_valid(Geometry{axis, axis}, "cone");
  require_size(half_angle, "half-angle of a cone");
  require_inside_horizon(axis.theta + half_angle <= pi / 2 + edge, "a cone", axis, in_degrees_text(half_angle));
  return {Shape::cone, axis, {0, half_angle}};
}

Aperture Aperture::annulus(const Direction& axis, double inner, double outer) {
  require_valid(Geometry{axis, axis}, "annulus");
  if (!(inner >= 0))
    throw std::invalid_argument("inner half-angle of an annulus: " + in_degrees_text(inner) + " degrees, is negative");
  require_size(outer - inner, "outer less inner half-angle of an annulus");
  require_inside_horizon(axis.theta + outer <= pi / 2 + edge, "an annulus", axis, in_degrees_text(outer));
  return {Shape::cone, axis, {inner, outer}};
}

namespace {

void require_across(const std::string& shape, const Direction& axis, double half_theta, double half_phi, double turn) {
  require_valid(Geometry{axis, axis}, shape.c_str());
  for (const double half : {half_theta, half_phi}) {
    require_size(half, "half-angle of " + shape);
    if (!(half < pi / 2))
      throw std::invalid_argument("half-angle of " + shape + ": " + in_degrees_text(half) +
                                  " degrees, must be below 90");
  }
  if (!std::isfinite(turn))
    throw std::invalid_argument("turn of " + shape + ": " + shortest(turn) + ", must be finite");
}

std::string text_of_sizes(double half_theta, double half_phi, double turn) {
  return in_degrees_text(half_theta) + " x " + in_degrees_text(half_phi) +
         (turn == 0 ? "" : " turned by " + in_degrees_text(turn));
}

}  // namespace

Aperture Aperture::ellipse(const Direction& axis, double half_theta, double half_phi, double turn) {
  require_across("an ellipse", axis, half_theta, half_phi, turn);
  const Axes axes = axes_of(axis, turn);  // the lowest point of the rim has z = along − depth, at distance 1
  const double depth = std::hypot(std::tan(half_theta) * axes.e1[2], std::tan(half_phi) * axes.e2[2]);
  require_inside_horizon(depth <= axes.along[2] + edge, "an ellipse", axis, text_of_sizes(half_theta, half_phi, turn));
  return {Shape::ellipse, axis, {half_theta, half_phi}, turn};
}

Aperture Aperture::rectangle(const Direction& axis, double half_theta, double half_phi, double turn) {
  require_across("a rectangle", axis, half_theta, half_phi, turn);
  const Axes axes = axes_of(axis, turn);
  const double depth = std::abs(std::tan(half_theta) * axes.e1[2]) + std::abs(std::tan(half_phi) * axes.e2[2]);
  require_inside_horizon(depth <= axes.along[2] + edge, "a rectangle", axis, text_of_sizes(half_theta, half_phi, turn));
  return {Shape::rectangle, axis, {half_theta, half_phi}, turn};
}

Aperture Aperture::ring(double theta_min, double theta_max) {
  const std::string text = "ring from " + in_degrees_text(theta_min) + " to " + in_degrees_text(theta_max) + " degrees";
  if (!(theta_min >= 0)) throw std::invalid_argument(text + ": begins below 0");
  if (!(theta_max <= pi / 2)) throw std::invalid_argument(text + ": reaches below the horizon");
  if (theta_max < theta_min) throw std::invalid_argument(text + ": ends before it begins");
  if (theta_max != theta_min) require_size(theta_max - theta_min, text + ": width");
  return {Shape::ring, {}, {theta_min, theta_max}};
}

Aperture Aperture::cap(double theta_max) {
  require_size(theta_max, "half-angle of a cap");
  return ring(0, theta_max);
}

Aperture Aperture::hemisphere() { return cap(pi / 2); }

// ---- ports ----------------------------------------------------------------------------------------------------------

Aperture Aperture::without(const Aperture& port) const {
  if (port.shape_ != Shape::cone || port.sizes_[0] > 0 || !port.ports_.empty())
    throw std::invalid_argument("a port must be a circular cone without ports");
  const std::string name =
      "port about " + text_of(port.axis_) + " with half-angle " + in_degrees_text(port.sizes_[1]) + " degrees";
  if (!contains(port)) throw std::invalid_argument(name + ": does not lie wholly inside the aperture");
  for (const Aperture& other : ports_)
    if (angle_between(port.axis_, other.axis_) < port.sizes_[1] + other.sizes_[1] - edge)
      throw std::invalid_argument(name + ": overlaps another port");
  Aperture result = *this;
  result.ports_.push_back(port);
  if (!(result.projected_solid_angle() > 1e-9 * projected_solid_angle()))
    throw std::invalid_argument(name + ": leaves nothing of the aperture");
  return result;
}

/// Whether a circular cone lies inside, the ports not regarded.
bool Aperture::contains(const Aperture& cone) const {
  const double radius = cone.sizes_[1] - edge;
  if (shape_ == Shape::direction) return false;
  if (shape_ == Shape::cone || shape_ == Shape::ring) {
    const double from_axis = shape_ == Shape::ring ? cone.axis_.theta : angle_between(axis_, cone.axis_);
    return from_axis + radius <= sizes_[1] && (sizes_[0] == 0 || from_axis - radius >= sizes_[0]);
  }
  const Axes axes = axes_of(axis_, turn_);
  const Vector3 c = unit_vector(cone.axis_);
  const auto along = [&c](const Vector3& v) { return v[0] * c[0] + v[1] * c[1] + v[2] * c[2]; };
  const double z = along(axes.along), x = along(axes.e1), y = along(axes.e2);
  const double a = std::tan(sizes_[0]), b = std::tan(sizes_[1]);
  if (shape_ == Shape::rectangle)  // distances from the planes through the edges
    return std::asin((a * z - std::abs(x)) / std::hypot(1, a)) >= radius &&
           std::asin((b * z - std::abs(y)) / std::hypot(1, b)) >= radius;
  const double to_rim = minimum_on_circle([&](double t) {
    return angle_between(cone.axis_, mmbrdf::direction(combined(axes, 1, a * std::cos(t), b * std::sin(t))));
  });
  return z > 0 && std::hypot(x / a, y / b) < z && to_rim >= radius;
}

// ---- integrals ------------------------------------------------------------------------------------------------------

double Aperture::projected_solid_angle() const {
  const auto [first, second] = sizes_;
  const double cos_axis = std::cos(axis_.theta);
  double result = 0;
  if (shape_ == Shape::cone || shape_ == Shape::ring)
    result = pi * cos_axis * std::sin(second + first) * std::sin(second - first);
  if (shape_ == Shape::ellipse) result = pi * cos_axis * std::sin(first) * std::sin(second);
  if (shape_ == Shape::rectangle)
    result = 2 * cos_axis *
             (std::sin(first) * std::atan(std::tan(second) * std::cos(first)) +
              std::sin(second) * std::atan(std::tan(first) * std::cos(second)));
  for (const Aperture& port : ports_) result -= port.projected_solid_angle();
  return result;
}

double Aperture::largest_theta() const {
  if (shape_ == Shape::direction) return axis_.theta;
  if (shape_ == Shape::cone) return std::min(axis_.theta + sizes_[1], pi / 2);
  if (shape_ == Shape::ring) return sizes_[1];
  const Axes axes = axes_of(axis_, turn_);
  const double a = std::tan(sizes_[0]), b = std::tan(sizes_[1]);
  const auto theta = [&axes](double x, double y) { return mmbrdf::direction(combined(axes, 1, x, y)).theta; };
  if (shape_ == Shape::ellipse)
    return -minimum_on_circle([&](double t) { return -theta(a * std::cos(t), b * std::sin(t)); });
  return std::max({theta(a, b), theta(a, -b), theta(-a, b), theta(-a, -b)});
}

void Aperture::add_nodes(int nodes, double sign, std::vector<WeightedDirection>& list) const {
  switch (shape_) {
    case Shape::direction:
      list.push_back({axis_, sign});
      return;
    case Shape::cone:
      return add_cone(axes_of(axis_, turn_), sizes_[0], sizes_[1], nodes, sign, list);
    case Shape::ellipse:
      return add_ellipse(axes_of(axis_, turn_), sizes_[0], sizes_[1], nodes, sign, list);
    case Shape::rectangle:
      return add_rectangle(axes_of(axis_, turn_), sizes_[0], sizes_[1], nodes, sign, list);
    case Shape::ring:
      return add_ring(sizes_[0], sizes_[1], nodes, sign, list);
  }
}

std::vector<WeightedDirection> Aperture::quadrature(int nodes) const {
  if (nodes < 1 || nodes > most_nodes)
    throw std::invalid_argument(std::to_string(nodes) + " nodes, must be 1 to " + std::to_string(most_nodes));
  std::vector<WeightedDirection> list;
  add_nodes(nodes, 1, list);
  for (const Aperture& port : ports_) port.add_nodes(nodes, -1, list);
  return list;
}

std::vector<WeightedDirection> Aperture::mean_rule(int nodes) const {
  std::vector<WeightedDirection> list = quadrature(nodes);
  double total = 0;
  for (const WeightedDirection& node : list) total += node.weight;
  for (WeightedDirection& node : list) node.weight /= total;
  return list;
}

std::vector<WeightedGeometry> mean_rule(const Aperture& source, const Aperture& receiver, int nodes) {
  const std::vector<WeightedDirection> incident = source.mean_rule(nodes), reflected = receiver.mean_rule(nodes);
  std::vector<WeightedGeometry> list;
  list.reserve(incident.size() * reflected.size());
  for (const WeightedDirection& i : incident)
    for (const WeightedDirection& r : reflected) list.push_back({{i.direction, r.direction}, i.weight * r.weight});
  return list;
}

}  // namespace mmbrdf
