// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/geometry/apertures.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "given/cases.hpp"
#include "mmbrdf/numerics/quadrature.hpp"

namespace mmbrdf {
namespace {

constexpr double pi = std::numbers::pi;

using Integrand = std::function<double(const Vector3&)>;

/// ∫ g cos θ dΩ.
double integral(const Aperture& aperture, int nodes, const Integrand& g) {
  double sum = 0;
  for (const auto& [direction, weight] : aperture.quadrature(nodes)) sum += weight * g(unit_vector(direction));
  return sum;
}

double one(const Vector3&) { return 1; }
double smooth(const Vector3& v) { return std::exp(0.7 * v[0] - 0.4 * v[1] + 0.9 * v[2]); }

Direction at(double theta, double phi) { return {radians(theta), radians(phi)}; }

/// ∫ g cos θ dΩ over the directions of axis + x e1 + y e2, for one node of area `area` at (x, y).
double gnomonic_node(const Direction& axis, double turn, double x, double y, double area, const Integrand& g) {
  const double ct = std::cos(axis.theta), st = std::sin(axis.theta), cp = std::cos(axis.phi), sp = std::sin(axis.phi);
  const double along_theta = std::cos(turn) * x - std::sin(turn) * y;
  const double along_phi = std::sin(turn) * x + std::cos(turn) * y;
  Vector3 v{st * cp + along_theta * ct * cp - along_phi * sp, st * sp + along_theta * ct * sp + along_phi * cp,
            ct - along_theta * st};
  const double length = std::sqrt(1 + x * x + y * y);
  for (double& component : v) component /= length;
  return g(v) * v[2] * area / (length * length * length);
}

// Of polynomials up to degree 4 nodes − 3 = 5 the rule has no error: left is rounding of a hundred terms.
TEST(Apertures, ConesIntegrateTheUnitVectorAsTheirTensorSays) {
  const Direction axis = at(35, 60);
  const double half = radians(40), c = std::cos(half);
  const Vector3 a = unit_vector(axis);
  const double along = 2 * pi * (1 - c * c * c) / 3, across = (2 * pi * (1 - c) - along) / 2;  // ∫ v vᵀ dΩ
  for (std::size_t i = 0; i < 3; ++i) {
    const double expected = (along - across) * a[i] * a[2] + (i == 2 ? across : 0);
    EXPECT_NEAR(integral(Aperture::cone(axis, half), 2, [i](const Vector3& v) { return v[i]; }), expected, 1e-15) << i;
  }
}

// The convergence is geometric; the widest shapes here need 16 nodes for 1e-13 of some 0.5.
RC_GTEST_PROP(Apertures, HaveTheProjectedSolidAngleOfTheClosedForm, ()) {
  const Direction axis{between(0, 1), between(-4, 4)};
  const double half = between(1e-4, 0.5), other = between(1e-4, 0.5), turn = between(-3, 3);
  for (const Aperture& aperture :
       {Aperture::cone(axis, half), Aperture::annulus(axis, 0.3 * half, half), Aperture::annulus(axis, 0, half),
        Aperture::ellipse(axis, half, other, turn), Aperture::rectangle(axis, 0.5 * half, 0.5 * other, turn),
        Aperture::ring(axis.theta, axis.theta + half), Aperture::cap(half), Aperture::hemisphere()}) {
    const double exact = aperture.projected_solid_angle();
    RC_ASSERT(exact > 0);
    RC_ASSERT(std::abs(integral(aperture, 16, one) / exact - 1) < 1e-12);
  }
}

TEST(Apertures, HaveTheProjectedSolidAnglesOfTheTextbook) {
  EXPECT_NEAR(Aperture::hemisphere().projected_solid_angle(), pi, 1e-15);
  EXPECT_NEAR(Aperture::cap(radians(30)).projected_solid_angle(), pi / 4, 1e-15);
  EXPECT_NEAR(Aperture::cone(at(60, 0), radians(30)).projected_solid_angle(), pi / 8, 1e-15);
  EXPECT_EQ(Aperture::direction(at(60, 0)).projected_solid_angle(), 0);
  EXPECT_EQ(Aperture::ring(radians(45), radians(45)).projected_solid_angle(), 0);
  // A circle is an ellipse; a small rectangle has 4 a b cos θ, less some a² b².
  EXPECT_NEAR(Aperture::ellipse(at(50, 20), 0.3, 0.3).projected_solid_angle(),
              Aperture::cone(at(50, 20), 0.3).projected_solid_angle(), 1e-15);
  EXPECT_NEAR(Aperture::rectangle(at(60, 0), 1e-4, 2e-4).projected_solid_angle(), 4e-8 * 2 * 0.5, 1e-15);
}

// The definition, integrated in X and Y themselves: other nodes, the same integral.
TEST(Apertures, EllipsesAndRectanglesAreWhatTheirDefinitionSays) {
  const Direction axis = at(40, 110);
  const double half_theta = radians(25), half_phi = radians(10), turn = radians(30);
  const double a = std::tan(half_theta), b = std::tan(half_phi);
  double rectangle = 0, ellipse = 0;
  for (const Node& x : gauss_legendre(30)) {
    for (const Node& y : gauss_legendre(30))
      rectangle +=
          gnomonic_node(axis, turn, a * (2 * x.x - 1), b * (2 * y.x - 1), 4 * a * b * x.weight * y.weight, smooth);
    for (int k = 0; k < 60; ++k)
      ellipse += gnomonic_node(axis, turn, a * x.x * std::cos(pi * k / 30), b * x.x * std::sin(pi * k / 30),
                               a * b * x.x * x.weight * pi / 30, smooth);
  }
  EXPECT_NEAR(integral(Aperture::rectangle(axis, half_theta, half_phi, turn), 12, smooth), rectangle, 1e-14);
  EXPECT_NEAR(integral(Aperture::ellipse(axis, half_theta, half_phi, turn), 12, smooth), ellipse, 1e-14);
}

// Theory 5.1: ∫ P_q(2u − 1) cos θ dΩ over a ring is (π/2) [Q_q − T_q], which it gives to 2e-14.
TEST(Apertures, RingsIntegrateLegendrePolynomialsAsTheClosedFormSays) {
  const auto legendre = [](int q, double x) { return q < 0 ? 1 : std::legendre(static_cast<unsigned>(q), x); };
  const auto big_q = [&](int q, double x) {
    return q == 0 ? x : (legendre(q + 1, x) - legendre(q - 1, x)) / (2 * q + 1);
  };
  const auto primitive = [&](int q, double x) {
    const double t = q == 0 ? big_q(1, x) : ((q + 1) * big_q(q + 1, x) + q * big_q(q - 1, x)) / (2 * q + 1);
    return big_q(q, x) - t;
  };
  for (const auto& [from, to] :
       {std::pair(0.0, 90.0), std::pair(0.0, 8.0), std::pair(40.0, 50.0), std::pair(75.0, 90.0)})
    for (int q = 0; q <= 20; ++q) {
      const double x1 = 1 - 2 * std::cos(radians(from)), x2 = 1 - 2 * std::cos(radians(to));
      const double expected = pi / 2 * (primitive(q, x2) - primitive(q, x1));
      const double sum = integral(Aperture::ring(radians(from), radians(to)), 11,
                                  [&](const Vector3& v) { return legendre(q, 1 - 2 * v[2]); });
      EXPECT_NEAR(sum, expected, 2e-14) << from << " to " << to << ", q = " << q;
    }
}

TEST(Apertures, DirectionsAndRingsWithoutWidthAreMeans) {
  const double theta = radians(45);
  EXPECT_EQ(integral(Aperture::direction(at(30, 70)), 5, one), 1);
  EXPECT_NEAR(integral(Aperture::ring(theta, theta), 3, one), 1, 1e-15);
  EXPECT_NEAR(integral(Aperture::ring(theta, theta), 3, [](const Vector3& v) { return v[0] * v[0]; }), 0.25, 1e-15);
}

TEST(Apertures, MeansHaveWeightsThatAddUpToOne) {
  double sum = 0;
  const Aperture receiver = Aperture::hemisphere().without(Aperture::cone(at(8, 180), radians(4)));
  for (const WeightedGeometry& term : mean_rule(Aperture::cone(at(8, 0), 0.02), receiver, 3)) {
    EXPECT_LE(term.geometry.incident.theta, radians(8) + 0.02);
    sum += term.weight;
  }
  EXPECT_NEAR(sum, 1, 1e-14);
}

RC_GTEST_PROP(Apertures, HaveNodesAboveTheHorizonAndBelowTheirLargestPolarAngle, ()) {
  const Direction axis{between(0, 1.5), between(-4, 4)};
  const double room = pi / 2 - axis.theta, half = room * between(0.1, 1), turn = between(-4, 4);
  for (const Aperture& aperture :
       {Aperture::cone(axis, half), Aperture::annulus(axis, 0.5 * half, half), Aperture::ring(axis.theta, pi / 2),
        Aperture::ellipse(axis, 0.9 * half, 0.6 * half, turn),
        Aperture::rectangle(axis, 0.5 * half, 0.4 * half, turn)}) {
    double largest = 0;
    for (const auto& [direction, weight] : aperture.quadrature(20)) {
      RC_ASSERT(weight > 0);
      largest = std::max(largest, direction.theta);
    }
    RC_ASSERT(largest <= aperture.largest_theta() + 1e-12 && aperture.largest_theta() <= pi / 2);
    RC_ASSERT(largest > aperture.largest_theta() - 0.02);  // the outermost node is 0.3 % of the width from the edge
  }
}

TEST(Apertures, MayTouchTheHorizonAndNotGoBelow) {
  EXPECT_NO_THROW(Aperture::cone(at(80, 0), radians(10)));
  EXPECT_EQ(message_of([] { Aperture::cone(at(80, 12), radians(15)); }),
            "a cone about 80,12 with half-angle 15 degrees reaches below the horizon");
  EXPECT_EQ(message_of([] { Aperture::annulus(at(80, 0), 0, radians(10.5)); }),
            "an annulus about 80,0 with half-angle 10.5 degrees reaches below the horizon");
  // Along the meridian an ellipse reaches as far as the cone; turned by 90 degrees its other half-angle does.
  EXPECT_NO_THROW(Aperture::ellipse(at(80, 0), radians(10), radians(40)));
  EXPECT_NO_THROW(Aperture::ellipse(at(80, 0), radians(40), radians(10), radians(90)));
  EXPECT_EQ(message_of([] { Aperture::ellipse(at(80, 0), radians(10.01), radians(40)); }),
            "an ellipse about 80,0 with half-angle 10.01 x 40 degrees reaches below the horizon");
  EXPECT_NO_THROW(Aperture::rectangle(at(80, 0), radians(10), radians(40)));
  EXPECT_EQ(message_of([] { Aperture::rectangle(at(80, 0), radians(10), radians(10), radians(1)); }),
            "a rectangle about 80,0 with half-angle 10 x 10 turned by 1 degrees reaches below the horizon");
  EXPECT_EQ(message_of([] { Aperture::ring(radians(45), radians(91)); }),
            "ring from 45 to 91 degrees: reaches below the horizon");
}

TEST(Apertures, RefuseSizesThatMakeNoSense) {
  EXPECT_EQ(message_of([] { Aperture::cone(at(8, 0), radians(-1)); }),
            "half-angle of a cone: -1 degrees, must be at least 5.73e-08");
  EXPECT_THROW(Aperture::cone(at(8, 0), 0), std::invalid_argument);
  EXPECT_THROW(Aperture::cone(at(8, 0), std::nan("")), std::invalid_argument);
  EXPECT_THROW(Aperture::cone(at(95, 0), 0.1), std::invalid_argument);
  EXPECT_EQ(message_of([] { Aperture::annulus(at(8, 0), radians(4), radians(2)); }),
            "outer less inner half-angle of an annulus: -2 degrees, must be at least 5.73e-08");
  EXPECT_THROW(Aperture::annulus(at(8, 0), -0.1, 0.1), std::invalid_argument);
  EXPECT_THROW(Aperture::ellipse(at(0, 0), radians(90), 0.1), std::invalid_argument);
  EXPECT_THROW(Aperture::ellipse(at(0, 0), 0.1, 0), std::invalid_argument);
  EXPECT_THROW(Aperture::rectangle(at(0, 0), 0.1, 0.1, INFINITY), std::invalid_argument);
  EXPECT_EQ(message_of([] { Aperture::ring(radians(50), radians(40)); }),
            "ring from 50 to 40 degrees: ends before it begins");
  EXPECT_THROW(Aperture::ring(radians(-1), radians(40)), std::invalid_argument);
  EXPECT_THROW(Aperture::cap(0), std::invalid_argument);
  EXPECT_THROW(Aperture::cap(0.1).quadrature(0), std::invalid_argument);
  EXPECT_THROW(Aperture::cap(0.1).quadrature(Aperture::most_nodes + 1), std::invalid_argument);
}

// Sums of some 1000 terms that come to 6.
TEST(Apertures, LosePortsAndNoMore) {
  const Aperture port = Aperture::cone(at(8, 180), radians(4)), other = Aperture::cone(at(30, 20), radians(5));
  for (const Aperture& whole : {Aperture::hemisphere(), Aperture::ring(0, radians(60)), Aperture::cone(at(15, 90), 0.6),
                                Aperture::rectangle(at(10, 45), 0.6, 0.5), Aperture::ellipse(at(10, 45), 0.6, 0.7)}) {
    const Aperture rest = whole.without(port).without(other);
    EXPECT_NEAR(integral(rest, 16, smooth),
                integral(whole, 16, smooth) - integral(port, 16, smooth) - integral(other, 16, smooth), 1e-13);
    EXPECT_NEAR(rest.projected_solid_angle(), integral(rest, 16, one), 1e-12);
  }
}

TEST(Apertures, HavePortsInsideAndApart) {
  const Aperture port = Aperture::cone(at(8, 180), radians(4));
  const auto refusal = [&](const Aperture& whole, const Aperture& cone) {
    return message_of([&] { whole.without(cone); });
  };
  const std::string name = "port about 8,180 with half-angle 4 degrees: ";
  EXPECT_EQ(refusal(Aperture::cap(radians(11.9)), port), name + "does not lie wholly inside the aperture");
  EXPECT_EQ(refusal(Aperture::cap(radians(12)), port), "nothing was thrown");
  EXPECT_EQ(refusal(Aperture::ring(radians(4.1), 1), port), name + "does not lie wholly inside the aperture");
  EXPECT_EQ(refusal(Aperture::annulus(at(8, 0), radians(11), 1), port), "nothing was thrown");
  EXPECT_EQ(refusal(Aperture::annulus(at(8, 0), radians(13), 1), port),
            name + "does not lie wholly inside the aperture");
  // The rim of a cone of 4 degrees about the axis touches that of the ellipse, and of the rectangle, across the axis.
  for (const double half : {4.01, 3.99}) {
    const std::string expected = half > 4 ? "nothing was thrown" : name + "does not lie wholly inside the aperture";
    EXPECT_EQ(refusal(Aperture::ellipse(at(8, 180), radians(half), radians(9), 1), port), expected);
    EXPECT_EQ(refusal(Aperture::rectangle(at(8, 180), radians(9), radians(half), 1), port), expected);
  }
  // Beside the axis in either direction, and far outside: half the aperture holds a cone, its edge and the other side do not.
  for (const double turn : {0.0, 90.0})
    for (const auto& shape : {&Aperture::rectangle, &Aperture::ellipse})
      for (const double theta : {3.0, 13.0, 60.0}) {
        const Aperture whole = shape(at(0, 0), radians(10), radians(10), radians(turn));
        EXPECT_EQ(refusal(whole, Aperture::cone(at(theta, 0), radians(4))) == "nothing was thrown", theta == 3)
            << theta;
        EXPECT_EQ(refusal(whole, Aperture::cone(at(theta, 90), radians(4))) == "nothing was thrown", theta == 3)
            << theta;
      }
  EXPECT_EQ(refusal(Aperture::direction(at(8, 180)), port), name + "does not lie wholly inside the aperture");
  const Aperture pierced = Aperture::hemisphere().without(port);
  EXPECT_EQ(refusal(pierced, Aperture::cone(at(15.9, 180), radians(4))),
            "port about 15.9,180 with half-angle 4 degrees: overlaps another port");
  EXPECT_EQ(refusal(pierced, Aperture::cone(at(0, 0), radians(4))), "nothing was thrown");
  EXPECT_EQ(refusal(port, port), name + "leaves nothing of the aperture");
  for (const Aperture& no_cone : {Aperture::cap(0.1), Aperture::annulus(at(30, 0), 0.01, 0.02),
                                  Aperture::cone(at(30, 0), 0.1).without(Aperture::cone(at(30, 0), 0.05))})
    EXPECT_EQ(refusal(pierced, no_cone), "a port must be a circular cone without ports");
}

}  // namespace
}  // namespace mmbrdf
