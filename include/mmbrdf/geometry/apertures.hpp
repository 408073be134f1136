// SPDX-License-Identifier: BSD-3-Clause
/// Sets of directions from which a sample is illuminated or into which light is collected, and quadrature over them.
///
/// Angles are in radians. θ is the polar angle from the surface normal, α the angle from the axis of a cone. All
/// integrals are over projected solid angle, cos θ dΩ.
#pragma once

#include <array>
#include <vector>

#include "mmbrdf/geometry/geometry.hpp"

namespace mmbrdf {

/// A node of a rule on the hemisphere.
struct WeightedDirection {
  Direction direction;
  double weight;
};

/// Narrowest cone and ring. Whatever is narrower is a direction, or a ring of width 0.
inline constexpr double smallest_width = 1e-9;

/// A shape on the hemisphere, less the ports cut out of it. Each function that makes one throws std::invalid_argument,
/// in one line with the angles in degrees, for a shape that reaches below the horizon, for half-angles below
/// smallest_width, for an inner edge beyond the outer one, and for angles that are not finite.
class Aperture {
 public:
  static Aperture direction(const Direction& direction);

  /// α ≤ half_angle, and inner ≤ α ≤ outer.
  static Aperture cone(const Direction& axis, double half_angle);
  static Aperture annulus(const Direction& axis, double inner, double outer);

  /// The directions of axis + X tan(half_theta) e1 + Y tan(half_phi) e2 with X² + Y² ≤ 1, or |X|, |Y| ≤ 1: an ellipse
  /// or a rectangle in a plane across the axis. e1 is along the meridian, towards rising θ, e2 along rising φ; both are
  /// turned about the axis by `turn`, from e1 to e2. The half-angles are below π/2.
  static Aperture ellipse(const Direction& axis, double half_theta, double half_phi, double turn = 0);
  static Aperture rectangle(const Direction& axis, double half_theta, double half_phi, double turn = 0);

  /// theta_min ≤ θ ≤ theta_max at all azimuths. Without width it is a circle of directions: CIE's 45° annular geometry.
  static Aperture ring(double theta_min, double theta_max);
  static Aperture cap(double theta_max);  ///< ring(0, theta_max)
  static Aperture hemisphere();           ///< cap(π/2)

  /// With one more port: a circular cone that is taken out. Throws std::invalid_argument unless `port` is such a cone,
  /// lies wholly inside and apart from the other ports, and leaves something.
  Aperture without(const Aperture& port) const;

  /// ∫ cos θ dΩ in closed form: π cos θ_axis sin²α for a cone, π cos θ_axis sin a sin b for an ellipse of half-angles a
  /// and b, π (sin²θ_max − sin²θ_min) for a ring; ports subtracted. 0 for a direction and for a ring without width.
  double projected_solid_angle() const;

  /// Largest polar angle, of the shape without ports.
  double largest_theta() const;

  /// ∫ g cos θ dΩ ≈ Σ weight g(direction), for g smooth on the sphere; where the projected solid angle is 0, the mean
  /// of g. Ports come last, with negative weights. Nodes are within the hemisphere.
  ///   about an axis     `nodes` Gauss–Legendre in 1 − cos α × 4 nodes − 2 equidistant azimuths
  ///   rings and caps    as about an axis, the normal: exact for polynomials of degree 4 nodes − 3 in the disc
  ///                     coordinates of DiscMapping::lambert
  ///   ellipses          2 nodes × 2 nodes: Gauss–Legendre across the longer axis, Chebyshev along it
  ///   rectangles        2 nodes × 2 nodes Gauss–Legendre in the angles arctan(X tan half_theta), arctan(Y …)
  /// Throws std::invalid_argument unless 1 ≤ nodes ≤ most_nodes.
  std::vector<WeightedDirection> quadrature(int nodes) const;
  static constexpr int most_nodes = 1000;

  /// The nodes of quadrature() with weights that add up to 1, for the mean of g weighted with projected solid angle.
  std::vector<WeightedDirection> mean_rule(int nodes) const;

 private:
  enum class Shape { direction, cone, ellipse, rectangle, ring };
  Aperture(Shape shape, const Direction& axis, std::array<double, 2> sizes, double turn = 0)
      : shape_(shape), axis_(axis), sizes_(sizes), turn_(turn) {}
  bool contains(const Aperture& cone) const;
  void add_nodes(int nodes, double sign, std::vector<WeightedDirection>& list) const;

  Shape shape_;
  Direction axis_;               // of a ring: the normal
  std::array<double, 2> sizes_;  // inner and outer half-angle, half_theta and half_phi, or theta_min and theta_max
  double turn_;
  std::vector<Aperture> ports_;
};

/// All pairs of the nodes of both rules: Σ weight F(geometry) is the mean of F over source and receiver, weighted with
/// the projected solid angle of each. Throws as Aperture::quadrature does.
std::vector<WeightedGeometry> mean_rule(const Aperture& source, const Aperture& receiver, int nodes);

}  // namespace mmbrdf
