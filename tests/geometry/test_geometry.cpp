// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/geometry/geometry.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "given/cases.hpp"
#include "given/published.hpp"

using namespace mmbrdf;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double few_roundings = 1e-15;  // of numbers up to 1
/// What the rounding of φr − φi ≤ 2π (4.4e-16) does to an element up to 1, times |k_in × k_out|: two beams, twice the
/// angle, two elements mixed.
constexpr double azimuth_error = 8 * 4.4e-16;
constexpr Frame every_frame[] = {Frame::xy, Frame::sp, Frame::scattering_plane};

double largest(const Mueller& m) {
  double result = 0;
  for (double element : m.elements) result = std::max(result, std::abs(element));
  return result;
}

Direction any_direction() { return {between(0, pi / 2), between(-pi, pi)}; }
Geometry any_geometry() { return {any_direction(), any_direction()}; }

Mueller any_matrix() {
  Mueller m;
  for (double& element : m.elements) element = between(-1, 1);
  return m;
}

Mueller counting() { return {{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16}}; }

Geometry turned_geometry(const Geometry& g, double angle) {
  return {{g.incident.theta, g.incident.phi + angle}, {g.reflected.theta, g.reflected.phi + angle}};
}

Geometry mirrored_geometry(const Geometry& g) {
  return {{g.incident.theta, -g.incident.phi}, {g.reflected.theta, -g.reflected.phi}};
}

Geometry in_degrees(double theta_i, double phi_i, double theta_r, double phi_r) {
  return {{radians(theta_i), radians(phi_i)}, {radians(theta_r), radians(phi_r)}};
}

// The axes as docs/conventions.md defines them, vectors throughout and 64 bits of mantissa: what the closed forms must
// agree with.
using Long = long double;
using Long3 = std::array<Long, 3>;

Long dot(const Long3& a, const Long3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Long3 cross(const Long3& a, const Long3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Long length(const Long3& a) { return std::sqrt(dot(a, a)); }
Long3 unit(const Long3& a) { return {a[0] / length(a), a[1] / length(a), a[2] / length(a)}; }
Long3 away(const Direction& d) {
  const Long theta = d.theta, phi = d.phi;
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

struct Beams {
  Long3 k_in, k_out;
  explicit Beams(const Geometry& g) : k_in(away(g.incident)), k_out(away(g.reflected)) {
    for (Long& component : k_in) component = -component;
  }
  Long3 normal() const { return cross(k_in, k_out); }
};

struct Axes {
  Long3 e1, e2;
};

Axes axes(const Beams& beams, const Long3& k, Frame frame) {
  if (frame == Frame::xy) {
    const Long sign = k[2] > 0 ? 1 : -1, denominator = 1 + std::abs(k[2]);
    const Long3 x{1 - k[0] * k[0] / denominator, -k[0] * k[1] / denominator, -sign * k[0]};
    return {cross(x, k), x};
  }
  const Long3 e1 = unit(frame == Frame::sp ? cross({0, 0, 1}, k) : beams.normal());
  return {e1, cross(k, e1)};
}

/// R(γ) from one pair of axes to another, with γ = atan2(e1'·e2, e1'·e1).
Mueller rotator_between(const Axes& from, const Axes& to) {
  return rotator(static_cast<double>(std::atan2(dot(to.e1, from.e2), dot(to.e1, from.e1))));
}

Mueller by_vectors(const Mueller& m, const Geometry& g, Frame from, Frame to) {
  const Beams beams(g);
  return rotator_between(axes(beams, beams.k_out, from), axes(beams, beams.k_out, to)) * m *
         transpose(rotator_between(axes(beams, beams.k_in, from), axes(beams, beams.k_in, to)));
}

}  // namespace

TEST(Direction, PointsAwayFromTheSampleWithPhiFromXTowardsY) {
  const Vector3 v = unit_vector({radians(30), radians(90)});
  EXPECT_NEAR(v[0], 0, few_roundings);
  EXPECT_NEAR(v[1], 0.5, few_roundings);
  EXPECT_NEAR(v[2], std::sqrt(0.75), few_roundings);
}

RC_GTEST_PROP(Direction, ComesBackFromAVectorOfAnyLength, ()) {
  const Direction d{between(0.01, pi / 2), between(-pi, pi)};
  Vector3 v = unit_vector(d);
  const double factor = std::ldexp(1.0, *rc::gen::inRange(-900, 1000));
  for (double& component : v) component *= factor;
  const Direction back = direction(v);
  RC_ASSERT(std::abs(back.theta - d.theta) < few_roundings);
  RC_ASSERT(std::abs(std::sin(back.phi - d.phi)) < few_roundings);
  RC_ASSERT(back.phi > -pi && back.phi <= pi);
}

TEST(Direction, OfTheNormalHasPhiZero) {
  EXPECT_EQ(direction({0, 0, 2}), (Direction{0, 0}));
  EXPECT_EQ(direction({-0.0, -0.0, 2}), (Direction{0, 0}));
}

TEST(Direction, AlongMinusXHasPhiPlusPi) {
  EXPECT_EQ(direction({-1, 0, 0}), (Direction{pi / 2, pi}));
  EXPECT_EQ(direction({-1, -0.0, 1}), (Direction{pi / 4, pi}));
}

TEST(Direction, OfTheLongestVectorsDoesNotOverflow) {
  const double most = std::numeric_limits<double>::max();
  EXPECT_NEAR(direction({most, most, most}).theta, std::atan(std::numbers::sqrt2), few_roundings);
}

TEST(Direction, OfNoUsableVectorIsRefused) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const Vector3& v : {Vector3{0, 0, 0}, Vector3{1, 0, -1e-9}, Vector3{nan_value, 0, 1}, Vector3{0, infinity, 1}})
    EXPECT_THROW(direction(v), std::invalid_argument);
}

TEST(Geometry, DegreesAreUnfoldedWithoutRounding) {
  EXPECT_EQ(direction_from_degrees(-45, 0), (Direction{radians(45), radians(180)}));
  EXPECT_EQ(direction_from_degrees(-45, 150.1), (Direction{radians(45), radians(150.1 - 180)}));
  EXPECT_EQ(direction_from_degrees(90, -30), (Direction{radians(90), radians(-30)}));
  for (const double theta : {90.1, -91.0, std::nan("")})
    EXPECT_THROW(direction_from_degrees(theta, 0), std::invalid_argument) << theta;
}

TEST(Direction, WithNegativePolarAngleLiesAtTheOppositeAzimuth) {
  // The published data: theta_i = −15°, phi_i = 0 is a source at azimuth 180°.
  EXPECT_EQ(unfolded({radians(-15), 0}), (Direction{radians(15), pi}));
  EXPECT_EQ(unfolded({radians(15), 0.5}), (Direction{radians(15), 0.5}));
}

RC_GTEST_PROP(Direction, UnfoldedIsTheSamePointOfTheSphere, ()) {
  const Direction d{between(-pi / 2, pi / 2), between(-pi, pi)};
  const Vector3 folded = unit_vector(d), straight = unit_vector(unfolded(d));
  for (std::size_t i = 0; i < 3; ++i) RC_ASSERT(std::abs(folded[i] - straight[i]) < few_roundings);
}

TEST(Geometry, NamesTheInvalidAngleInDegrees) {
  const auto refusal = [](const Geometry& g) { return message_of([&] { require_valid(g, "row 7"); }); };
  EXPECT_EQ(refusal(in_degrees(95, 0, 0, 0)), "row 7: theta_i = 95 degrees, must be in 0...90");
  EXPECT_EQ(refusal(in_degrees(0, 0, 90.0000001, 0)), "row 7: theta_r = 90.0000001 degrees, must be in 0...90");
  EXPECT_EQ(refusal(in_degrees(-1, 0, 0, 0)), "row 7: theta_i = -1 degrees, must be in 0...90");
  EXPECT_EQ(refusal({{nan_value, 0}, {}}), "row 7: theta_i = nan degrees, must be in 0...90");
  EXPECT_EQ(refusal({{0, nan_value}, {}}), "row 7: phi_i = nan, must be finite");
  EXPECT_EQ(refusal({{}, {0, std::numeric_limits<double>::infinity()}}), "row 7: phi_r = inf, must be finite");
}

TEST(Geometry, AtNormalAndGrazingDirectionsAndAnyAzimuthIsValid) {
  EXPECT_NO_THROW(require_valid(in_degrees(0, 1000, 90, -1000), "row"));
}

TEST(Geometry, ForwardScatteringIsAtTheAzimuthOppositeToTheSource) {
  const Vector3 source = unit_vector({radians(60), 0});
  const Direction specular = direction({-source[0], -source[1], source[2]});  // k_in with z reversed
  EXPECT_NEAR(degrees(specular.theta), 60, 1e-13);                            // a few roundings of 60
  EXPECT_EQ(specular.phi, pi);
}

TEST(Geometry, ExchangedHasTheDetectorWhereTheSourceWas) {
  EXPECT_EQ(exchanged(in_degrees(1, 2, 3, 4)), in_degrees(3, 4, 1, 2));
}

TEST(Frame, InvalidGeometryIsRefused) {
  EXPECT_THROW(change_frame(identity(), in_degrees(91, 0, 0, 0), Frame::xy, Frame::sp), std::invalid_argument);
  EXPECT_THROW(change_frame(identity(), in_degrees(91, 0, 0, 0), Frame::xy, Frame::xy), std::invalid_argument);
  EXPECT_THROW(angles_to_xy({}, static_cast<Frame>(3)), std::invalid_argument);
}

RC_GTEST_PROP(Frame, ChangesAgreeWithTheAxesAsVectors, ()) {
  const Geometry g = any_geometry();
  const Beams beams(g);
  RC_PRE(g.incident.theta > 0 && g.reflected.theta > 0 && length(beams.normal()) > 1e-6L);
  const Mueller m = any_matrix();
  const double plane_error = azimuth_error / static_cast<double>(length(beams.normal()));
  for (Frame from : every_frame)
    for (Frame to : every_frame) {
      const Mueller error = change_frame(m, g, from, to) - by_vectors(m, g, from, to);
      const bool plane = from == Frame::scattering_plane || to == Frame::scattering_plane;
      RC_ASSERT(largest(error) <= frame_error * largest(m) + (plane ? plane_error : 0));
    }
}

RC_GTEST_PROP(Frame, ChangesAgreeWithTheAxesAsVectorsCloseToRetroReflectionAndToStraightThrough, ()) {
  const double close = std::pow(10.0, -between(2, 7));
  const double a = between(-1, 1) * close, b = between(-1, 1) * close;
  const double theta = between(0.1, pi / 2 - 0.1), phi = between(-pi, pi);
  const Geometry retro{{theta, phi}, {theta + a, phi + b}};
  const Geometry through{{pi / 2 - std::abs(a), phi}, {pi / 2 - close, phi + pi + b}};
  const Mueller m = any_matrix();
  for (const Geometry& g : {retro, through}) {
    const double sine = static_cast<double>(length(Beams(g).normal()));
    RC_PRE(sine > 2 * parallel_limit);
    for (Frame from : {Frame::xy, Frame::sp}) {
      const Mueller error =
          change_frame(m, g, from, Frame::scattering_plane) - by_vectors(m, g, from, Frame::scattering_plane);
      // Close to retro-reflection φr − φi is exact, and what is left is the rounding of the vectors.
      const double rounding = g == through ? azimuth_error : 2e-18;
      RC_ASSERT(largest(error) <= frame_error * largest(m) + rounding / sine);
    }
  }
}

RC_GTEST_PROP(Frame, ChangesComposeAndComeBack, ()) {
  const double theta = between(0, pi / 2), phi = between(-pi, pi);
  const Geometry g = *rc::gen::element(any_geometry(), Geometry{{0, phi}, {theta, 0}}, Geometry{{theta, phi}, {0, 1}},
                                       Geometry{{theta, phi}, {theta, phi}}, Geometry{{0, phi}, {0, 2}},
                                       Geometry{{pi / 2, phi}, {pi / 2, phi + pi}});
  const Mueller m = any_matrix();
  for (Frame a : every_frame)
    for (Frame b : every_frame) {
      const Mueller there = change_frame(m, g, a, b);
      RC_ASSERT(largest(change_frame(there, g, b, a) - m) <= frame_error * largest(m));
      for (Frame c : every_frame)
        RC_ASSERT(largest(change_frame(there, g, b, c) - change_frame(m, g, a, c)) <= frame_error * largest(m));
    }
}

RC_GTEST_PROP(Frame, ChangesArePairsOfRotatorsWithTheAnglesToXy, ()) {
  const Geometry g = any_geometry();
  const Mueller m = any_matrix();
  for (Frame frame : every_frame) {
    const FrameAngles a = angles_to_xy(g, frame);
    const Mueller expected = rotator(a.scattered) * m * transpose(rotator(a.incident));
    RC_ASSERT(largest(change_frame(m, g, frame, Frame::xy) - expected) <= frame_error * largest(m));
  }
}

RC_GTEST_PROP(Frame, SpFollowsFromXyByTheAzimuthsAlone, ()) {  // theory 1.1
  const Geometry g = any_geometry();
  const Mueller m = any_matrix(), expected = rotator(g.reflected.phi) * m * rotator(g.incident.phi);
  RC_ASSERT(largest(change_frame(m, g, Frame::xy, Frame::sp) - expected) <= frame_error * largest(m));
}

RC_GTEST_PROP(Frame, InThePlaneOfIncidenceSpAndScatteringPlaneAgree, ()) {
  const double phi = between(-pi, pi);
  const Geometry g{{between(0, 1.5), phi}, {between(0, 1.5), *rc::gen::element(phi, phi + pi)}};
  RC_PRE(static_cast<double>(length(Beams(g).normal())) > 1e-3);
  const Mueller m = any_matrix();
  const Mueller difference =
      change_frame(m, g, Frame::xy, Frame::sp) - change_frame(m, g, Frame::xy, Frame::scattering_plane);
  RC_ASSERT(largest(difference) <= frame_error + azimuth_error / 1e-3);
}

TEST(Frame, YIsMinusYOfTheLaboratoryForScatteredAndPlusYForIncidentLightAtTheNormal) {
  // Scattered light at azimuth 90° has s along −x of the laboratory, incident light from there +x: all of it is −S2 in
  // xy.
  const Geometry g = in_degrees(0, 90, 0, 90);
  EXPECT_NEAR(change_frame(diagonal(0, 1, 0, 0), g, Frame::sp, Frame::xy)(1, 1), 1, few_roundings);
  EXPECT_NEAR(change_frame(diagonal(1, 1, 0, 0), in_degrees(0, 0, 0, 90), Frame::sp, Frame::xy)(1, 1), -1,
              few_roundings);
  // 45° on: the diagonal of sp is the first axis of xy, with opposite signs since y × x = k has opposite k.
  Mueller third_row, third_column;
  third_row(2, 0) = third_column(0, 2) = 1;
  EXPECT_NEAR(change_frame(third_row, in_degrees(0, 0, 0, 45), Frame::sp, Frame::xy)(1, 0), -1, few_roundings);
  EXPECT_NEAR(change_frame(third_column, in_degrees(0, 45, 0, 0), Frame::sp, Frame::xy)(0, 1), 1, few_roundings);
}

RC_GTEST_PROP(Frame, XyIsSmoothAcrossTheNormal, ()) {
  // The plane's axes do not depend on how a direction close to the normal is written, so neither may xy.
  const double tiny = 1e-7, phi = between(-pi, pi);
  const Direction other{1, 0.3};
  const Mueller m = any_matrix();
  const auto xy = [&](const Geometry& g) { return change_frame(m, g, Frame::scattering_plane, Frame::xy); };
  RC_ASSERT(largest(xy({{tiny, phi}, other}) - xy({{0, 0}, other})) < 20 * tiny);
  RC_ASSERT(largest(xy({other, {tiny, phi}}) - xy({other, {0, 0}})) < 20 * tiny);
}

RC_GTEST_PROP(Frame, AtTheNormalScatteringPlaneDoesNotDependOnTheAzimuthGiven, ()) {
  const Direction other{between(0.1, pi / 2), between(-pi, pi)};
  const double phi = between(-pi, pi);
  const Mueller m = any_matrix();
  const auto plane = [&](const Geometry& g) { return change_frame(m, g, Frame::xy, Frame::scattering_plane); };
  RC_ASSERT(largest(plane({{0, phi}, other}) - plane({{0, 0}, other})) <= 2 * frame_error);
  RC_ASSERT(largest(plane({other, {0, phi}}) - plane({other, {0, 0}})) <= 2 * frame_error);
}

RC_GTEST_PROP(Frame, RetroReflectionHasTheIncidentSAxisInBothBeams, ()) {
  const Direction d = *rc::gen::element(any_direction(), Direction{0, between(-pi, pi)}, Direction{pi / 2, 1});
  const Mueller m = any_matrix();
  const Mueller sp = change_frame(m, {d, d}, Frame::xy, Frame::sp);
  RC_ASSERT(largest(change_frame(m, {d, d}, Frame::xy, Frame::scattering_plane) - sp) <= 2 * frame_error);
  // The limit within the plane of incidence, from both sides. θ + 1e-7 is beyond the threshold, and exactly in plane.
  if (d.theta > 1e-6 && d.theta < pi / 2 - 1e-6)
    for (double step : {-1e-7, 1e-7}) {
      const Geometry close{d, {d.theta + step, d.phi}};
      RC_ASSERT(largest(change_frame(m, close, Frame::xy, Frame::scattering_plane) - sp) <= 2 * frame_error);
    }
}

TEST(Frame, AtTheNormalRetroReflectionFollowsTheIncidentAzimuthAlone) {
  const auto plane = [](double phi_r) {
    return change_frame(counting(), in_degrees(0, 25, 0, phi_r), Frame::xy, Frame::scattering_plane);
  };
  EXPECT_LE(largest(plane(25) - change_frame(counting(), in_degrees(0, 25, 0, 25), Frame::xy, Frame::sp)),
            16 * frame_error);
  EXPECT_LE(largest(plane(25) - plane(140)), 16 * frame_error);
}

TEST(Frame, StraightThroughHasTheIncidentSAxisInBothBeams) {
  const Geometry through = in_degrees(90, 20, 90, 200), nearly = in_degrees(90 - 1e-5, 20, 90, 200);
  const Mueller sp = change_frame(counting(), through, Frame::xy, Frame::sp);
  EXPECT_LE(largest(change_frame(counting(), through, Frame::xy, Frame::scattering_plane) - sp), 16 * frame_error);
  const double sine = radians(1e-5);
  EXPECT_LE(largest(change_frame(counting(), nearly, Frame::xy, Frame::scattering_plane) - sp),
            16 * azimuth_error / sine);
}

RC_GTEST_PROP(Frame, EachOneKeepsReciprocity, ()) {
  const Geometry g = any_geometry();
  const Mueller m = any_matrix();
  for (Frame to : every_frame) {
    const Mueller there = change_frame(exchanged(m), exchanged(g), Frame::xy, to);
    RC_ASSERT(largest(there - exchanged(change_frame(m, g, Frame::xy, to))) <= frame_error);
  }
}

RC_GTEST_PROP(Frame, EachOneKeepsMirrorSymmetry, ()) {
  const Geometry g = any_geometry();
  const Mueller m = any_matrix();
  for (Frame to : every_frame) {
    const Mueller there = change_frame(mirrored(m), mirrored_geometry(g), Frame::xy, to);
    RC_ASSERT(largest(there - mirrored(change_frame(m, g, Frame::xy, to))) <= frame_error);
  }
}

RC_GTEST_PROP(Frame, TurningAnIsotropicSampleShowsInXyOnly, ()) {  // theory 1.2
  const Geometry g = any_geometry();
  RC_PRE(static_cast<double>(length(Beams(g).normal())) > 1e-3);
  const double angle = between(-pi, pi);
  const Mueller m = any_matrix();
  for (Frame frame : {Frame::sp, Frame::scattering_plane}) {
    const Mueller before = change_frame(m, g, Frame::xy, frame);
    const Mueller after = change_frame(turned(m, angle), turned_geometry(g, angle), Frame::xy, frame);
    RC_ASSERT(largest(before - after) <= frame_error + 3 * azimuth_error / 1e-3);  // both φ + angle are rounded too
  }
  RC_ASSERT(largest(turned(m, angle) - rotator(-angle) * m * rotator(-angle)) <= frame_error);
}

namespace {

struct Golden {
  double theta_i, phi_i, theta_r, phi_r;  // degrees
  Mueller xy, sp, plane;                  // normalised, 12 decimals
};

// The published 532 nm coefficients, evaluated at phi_i = 0 and turned, by an independent program in Python.
// clang-format off
const Golden golden[] = {
    {60, 0, 45, 120,
     {{1, 0.002517430512, 0.023142930473, 0.000342580865,
       0.025409294563, 0.004796009712, 0.057158950312, 0.017200566187,
       -0.010246663579, -0.029055495502, -0.026348632867, 0.019747148488,
       -0.000440116628, 0.027017788058, -0.018028006648, 0.029543344349}},
     {{1, 0.002517430512, 0.023142930473, 0.000342580865,
       -0.003830776318, 0.022764792368, -0.005760889738, -0.025701815337,
       0.027128426374, 0.018681213998, 0.062675419458, 0.005022553033,
       -0.000440116628, 0.027017788058, -0.018028006648, 0.029543344349}},
     {{1, 0.023043199532, 0.003308117682, 0.000342580865,
       0.027395453832, 0.06480836958, 0.000482412967, 0.008259289475,
       0.000339814763, -0.008405981892, 0.023613588489, 0.024851428288,
       -0.000440116628, -0.010754483627, -0.03064818065, 0.029543344349}}},
    {60, 40, 45, 160,
     {{1, 0.023228484578, 0.001539542617, 0.000342580865,
       0.014503271432, 0.040442280316, -0.022770096233, -0.016460297958,
       0.023243955827, 0.050873551043, 0.009297637737, 0.020368307286,
       -0.000440116628, -0.013062531057, -0.02973785765, 0.029543344349}},
     {{1, 0.002517430512, 0.023142930473, 0.000342580865,
       -0.003830776318, 0.022764792368, -0.005760889738, -0.025701815337,
       0.027128426374, 0.018681213998, 0.062675419458, 0.005022553033,
       -0.000440116628, 0.027017788058, -0.018028006648, 0.029543344349}},
     {{1, 0.023043199532, 0.003308117682, 0.000342580865,
       0.027395453832, 0.06480836958, 0.000482412967, 0.008259289475,
       0.000339814763, -0.008405981892, 0.023613588489, 0.024851428288,
       -0.000440116628, -0.010754483627, -0.03064818065, 0.029543344349}}},
    {75, 0, 70, 180,
     {{1, 0.027088401482, 0, 0,
       0.028085143769, 0.389287364953, 0, 0,
       0, 0, 0.369598836992, 0.048066165001,
       0, 0, -0.050891694684, 0.306271081062}},
     {{1, 0.027088401482, 0, 0,
       0.028085143769, 0.389287364953, 0, 0,
       0, 0, 0.369598836992, 0.048066165001,
       0, 0, -0.050891694684, 0.306271081062}},
     {{1, 0.027088401482, 0, 0,
       0.028085143769, 0.389287364953, 0, 0,
       0, 0, 0.369598836992, 0.048066165001,
       0, 0, -0.050891694684, 0.306271081062}}},
};
// clang-format on

}  // namespace

TEST(Frame, ChangesAgreeWithAnIndependentProgram) {
  const double printed = 4 * 0.5e-12;  // 12 decimals, and a rotation on each side adds up to two of the rounding errors
  for (const Golden& c : golden) {
    const Geometry g = in_degrees(c.theta_i, c.phi_i, c.theta_r, c.phi_r);
    EXPECT_LE(largest(change_frame(c.xy, g, Frame::xy, Frame::sp) - c.sp), printed);
    EXPECT_LE(largest(change_frame(c.sp, g, Frame::sp, Frame::scattering_plane) - c.plane), printed);
    EXPECT_LE(largest(change_frame(c.plane, g, Frame::scattering_plane, Frame::xy) - c.xy), printed);
  }
}

TEST(Frame, TurnedMatrixAgreesWithAnIndependentProgram) {
  const double printed = 4 * 0.5e-12;  // as above
  EXPECT_LE(largest(turned(golden[0].xy, radians(40)) - golden[1].xy), printed);
}

namespace {

/// A row of a SCATMECH file: lambda, four angles in degrees, 16 elements.
Mueller matrix(const std::vector<double>& row) {
  Mueller m;
  std::copy_n(row.begin() + 5, 16, m.elements.begin());
  return m;
}

/// The row's geometry, turned so that the source is at azimuth 180°, where these files were evaluated.
Geometry source_at_180(const std::vector<double>& row) {
  return in_degrees(row[1], 180, row[3], row[4] - row[2] + 180);
}

struct ScatmechFiles {
  std::vector<std::vector<double>> xy, other;  // the same models and geometries: what differs is the frame alone
};

}  // namespace

TEST(Frame, ChangesFromXyToSpAgreeWithScatmech) {
  const std::string xy_file = reference("scatmech/PTFE.xyxy.rotation0.csv");
  const std::string sp_file = reference("scatmech/PTFE.psps.rotation0.csv");
  const ScatmechFiles files{read_numbers(xy_file), read_numbers(sp_file)};
  ASSERT_GE(files.xy.size(), 40U);
  ASSERT_EQ(files.xy.size(), files.other.size());
  for (std::size_t i = 0; i < files.xy.size(); ++i) {
    Geometry g = source_at_180(files.xy[i]);
    if (files.xy[i][3] == 0) g.reflected.phi = 0;  // at theta_r = 0 SCATMECH takes s = (0, 1, 0)
    const Mueller m = matrix(files.xy[i]), error = change_frame(m, g, Frame::xy, Frame::sp) - matrix(files.other[i]);
    EXPECT_LE(largest(error), frame_error * std::abs(m(0, 0))) << "row " << i + 1;
  }
}

TEST(Frame, ChangesFromXyToScatteringPlaneAgreeWithScatmech) {
  const std::string xy_file = reference("scatmech/PTFE.xyxy.rotation0.csv");
  const std::string plane_file = reference("scatmech/PTFE.plane.rotation0.csv");
  const ScatmechFiles files{read_numbers(xy_file), read_numbers(plane_file)};
  ASSERT_GE(files.xy.size(), 40U);
  ASSERT_EQ(files.xy.size(), files.other.size());
  for (std::size_t i = 0; i < files.xy.size(); ++i) {
    const Geometry g = source_at_180(files.xy[i]);
    const Mueller m = matrix(files.xy[i]);
    const Mueller error = change_frame(m, g, Frame::xy, Frame::scattering_plane) - matrix(files.other[i]);
    EXPECT_LE(largest(error), frame_error * std::abs(m(0, 0))) << "row " << i + 1;
  }
}
