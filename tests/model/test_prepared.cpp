// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/model/prepared.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <new>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "given/cases.hpp"
#include "given/random_model.hpp"
#include "given/reference_sum.hpp"
#include "mmbrdf/formats/projection.hpp"

// Every allocation of this program is counted. Not inlined: gcc would take the pair for a mismatch of new and free().
namespace {
std::atomic<long> allocations = 0;
}
void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(std::max<std::size_t>(size, 1))) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

using namespace mmbrdf;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::array every_family{Family::isotropic, Family::germer2017, Family::anisotropic};
constexpr std::array every_frame{Frame::xy, Frame::sp, Frame::scattering_plane};

// Of the largest element, for the symmetries of models of any order up to 12; the largest seen is 1.1e-14. This can be
// said of the largest element because f11 of the random models stays near 1/π: at a zero of f11 it is the terms that
// cancel there which are rounded.
constexpr double symmetry_error = 1e-13;

double largest(const Mueller& m) {
  double result = 0;
  for (const double element : m.elements) result = std::max(result, std::abs(element));
  return result;
}

/// The largest difference of two elements, relative to the largest element; infinite if a number is not finite.
double deviation(const Mueller& a, const Mueller& b) {
  for (const Mueller* m : {&a, &b})
    for (const double element : m->elements)
      if (!std::isfinite(element)) return infinity;
  return largest(a - b) / std::max(largest(a), largest(b));
}

// inRange() alone would begin with numbers near `low` only.
double any_theta() {
  const int kind = *rc::gen::inRange(0, 10);
  return kind == 8 ? 0 : kind == 9 ? radians(90) : between(0, pi / 2);
}

Direction any_direction() { return {any_theta(), between(-2 * pi, 2 * pi)}; }
Geometry any_geometry() { return {any_direction(), any_direction()}; }

Orders any_orders(int highest) { return {*rc::gen::inRange(0, highest + 1), *rc::gen::inRange(0, highest + 1)}; }
DiscMapping any_mapping() { return *rc::gen::element(DiscMapping::lambert, DiscMapping::projected); }

Model any_model(Family family, int highest_order, int highest_power = 0) {
  const Orders orders = any_orders(highest_order);
  const int powers = *rc::gen::inRange(0, highest_power + 1);
  return random_model(family, orders, powers, *rc::gen::arbitrary<std::uint64_t>(), any_mapping());
}

Geometry turned_geometry(const Geometry& g, double angle) {
  return {{g.incident.theta, g.incident.phi + angle}, {g.reflected.theta, g.reflected.phi + angle}};
}

Geometry mirrored_geometry(const Geometry& g) {
  return {{g.incident.theta, -g.incident.phi}, {g.reflected.theta, -g.reflected.phi}};
}

double f11_of(const Model& model, double wavelength) {
  return prepare(model, wavelength).f11(in_degrees(20, 30, 40, 50));
}

}  // namespace

// ---- symmetries -----------------------------------------------------------------------------------------------------

// Theory 1.2: turning the sample turns the axes.
RC_GTEST_PROP(Model, OfAnIsotropicSampleTurnsWithTheGeometry, ()) {
  const Family family = *rc::gen::element(Family::isotropic, Family::germer2017);
  const PreparedModel model = prepare(any_model(family, 12), 1);
  const Geometry geometry = any_geometry();
  const double angle = between(-pi, pi);
  RC_ASSERT(deviation(model.evaluate(turned_geometry(geometry, angle)), turned(model.evaluate(geometry), angle)) <=
            symmetry_error);
}

RC_GTEST_PROP(Model, OfAnIsotropicSampleDependsOnTheAzimuthDifferenceAloneInSp, ()) {
  const PreparedModel model = prepare(any_model(Family::isotropic, 12), 1);
  const Geometry geometry = any_geometry();
  RC_ASSERT(deviation(model.evaluate(turned_geometry(geometry, between(-pi, pi)), Frame::sp),
                      model.evaluate(geometry, Frame::sp)) <= symmetry_error);
}

RC_GTEST_PROP(Model, OfAnIsotropicSampleLooksTheSameInAMirror, ()) {
  const Family family = *rc::gen::element(Family::isotropic, Family::germer2017);
  const PreparedModel model = prepare(any_model(family, 12), 1);
  const Geometry geometry = any_geometry();
  for (const Frame frame : {Frame::xy, Frame::sp})
    RC_ASSERT(deviation(model.evaluate(mirrored_geometry(geometry), frame),
                        mirrored(model.evaluate(geometry, frame))) <= symmetry_error);
}

// Source and detector change places. Published models have this as printed; evaluated at φi = 0 and turned they have
// not.
RC_GTEST_PROP(Model, IsReciprocal, ()) {
  const Family family = *rc::gen::elementOf(every_family);
  const PreparedModel model = prepare(as_printed(any_model(family, family == Family::anisotropic ? 5 : 12)), 1);
  const Geometry geometry = any_geometry();
  for (const Frame frame : {Frame::xy, Frame::sp})
    RC_ASSERT(deviation(model.evaluate(exchanged(geometry), frame), exchanged(model.evaluate(geometry, frame))) <=
              symmetry_error);
}

// Why as_printed is for comparison only: a sample that looks alike from all sides has another matrix from each.
TEST(Model, AsPrintedChangesWhenTheSampleIsTurned) {
  const Model germer = random_model(Family::germer2017, {7, 4}, 0, 1);
  const Geometry geometry = in_degrees(60, 0, 45, 120);
  const auto change = [&](Rotation rotation) {
    const PreparedModel model = prepare(rotation == Rotation::as_printed ? as_printed(germer) : germer, 1);
    return deviation(model.evaluate(turned_geometry(geometry, 0.5)), turned(model.evaluate(geometry), 0.5));
  };
  EXPECT_LE(change(Rotation::covariant), symmetry_error);
  EXPECT_GE(change(Rotation::as_printed), 0.01);
}

// 0° and 180° are the azimuths of the published measurement: there is no difference there.
RC_GTEST_PROP(Model, AsPrintedIsTheSameAtTheAzimuthsOfThePublishedGrid, ()) {
  const Model germer = any_model(Family::germer2017, 8);
  const Geometry geometry{{any_theta(), *rc::gen::element(0.0, pi)}, any_direction()};
  RC_ASSERT(deviation(prepare(as_printed(germer), 1).evaluate(geometry), prepare(germer, 1).evaluate(geometry)) <=
            symmetry_error);
}

RC_GTEST_PROP(Model, OfOtherFamiliesIsTheSameAsPrinted, ()) {
  const Model model = any_model(*rc::gen::element(Family::isotropic, Family::anisotropic), 4, 1);
  const Geometry geometry = any_geometry();
  RC_ASSERT(prepare(as_printed(model), 0.5).evaluate(geometry) == prepare(model, 0.5).evaluate(geometry));
}

// The xy axes do not know φi at the normal, and the spin-weighted functions do not either.
RC_GTEST_PROP(Model, OfTheIsotropicFamilyAtNormalIncidenceHasNoAzimuthOfIncidence, ()) {
  const PreparedModel model = prepare(any_model(Family::isotropic, 12), 1);
  const Direction reflected = any_direction();
  RC_ASSERT(model.evaluate({{0, between(-pi, pi)}, reflected}) == model.evaluate({{0, 0}, reflected}));
}

// With both directions along the normal nothing distinguishes an azimuth: turning must change nothing, and in xy that
// leaves diag(a, b, −b, c).
RC_GTEST_PROP(Model, OfTheIsotropicFamilyAlongTheNormalHasThreeNumbersLeft, ()) {
  const Mueller m =
      prepare(any_model(Family::isotropic, 12), 1).evaluate({{0, between(-pi, pi)}, {0, between(-pi, pi)}});
  RC_ASSERT(deviation(m, diagonal(m(0, 0), m(1, 1), -m(1, 1), m(3, 3))) <= symmetry_error);
}

// ---- ways to evaluate -----------------------------------------------------------------------------------------------

RC_GTEST_PROP(Model, IsTheSumOfItsModesToThePromisedError, ()) {
  const Family family = *rc::gen::elementOf(every_family);
  Model model = random_model(family, *rc::gen::element(Orders{7, 4}, Orders{3, 2}, Orders{0, 4}),
                             *rc::gen::inRange(0, 4), *rc::gen::arbitrary<std::uint64_t>(), any_mapping());
  model.reflectance = {{0.4, 0.7}, {0.9, 0.5}};
  const double wavelength = between(0.3, 1.2);
  const Geometry geometry = any_geometry();
  const Mueller expected = sum_in_extended_precision(model, wavelength, geometry);
  RC_ASSERT(deviation_of_m11(prepare(as_printed(model), wavelength).evaluate(geometry), expected) <= evaluation_error);
}

RC_GTEST_PROP(Model, PreparedForOneIncidentDirectionIsTheSame, ()) {
  const Family family = *rc::gen::elementOf(every_family);
  const PreparedModel model = prepare(either_way(any_model(family, 4, 2)), between(0.3, 1.2));
  const Direction incident = any_direction();
  const PreparedIncidence from_there = model.at(incident);
  RC_ASSERT(from_there.incident() == incident);
  std::vector<Direction> reflected;
  for (int q = 0; q < 5; ++q) reflected.push_back(any_direction());
  for (const Frame frame : every_frame) {
    std::vector<Mueller> all(reflected.size());
    from_there.evaluate(reflected, frame, all);
    for (std::size_t q = 0; q < all.size(); ++q) {
      RC_ASSERT(all[q] == from_there.evaluate(reflected[q], frame));
      RC_ASSERT(deviation_of_m11(all[q], model.evaluate({incident, reflected[q]}, frame)) <= evaluation_error);
    }
  }
}

RC_GTEST_PROP(Model, EvaluatesASpanOneByOne, ()) {
  const PreparedModel model = prepare(any_model(*rc::gen::elementOf(every_family), 4), 1);
  std::vector<Geometry> geometries;
  for (int q = *rc::gen::inRange(0, 8); q > 0; --q) geometries.push_back(any_geometry());
  for (const Frame frame : every_frame) {
    std::vector<Mueller> all(geometries.size());
    model.evaluate(geometries, frame, all);
    for (std::size_t q = 0; q < all.size(); ++q) RC_ASSERT(all[q] == model.evaluate(geometries[q], frame));
  }
}

RC_GTEST_PROP(Model, InAnotherFrameIsTheSameMatrixTurned, ()) {
  const PreparedModel model = prepare(any_model(*rc::gen::elementOf(every_family), 4), 1);
  const Geometry geometry = any_geometry();
  for (const Frame frame : every_frame)
    RC_ASSERT(deviation_of_m11(model.evaluate(geometry, frame),
                               change_frame(model.evaluate(geometry), geometry, Frame::xy, frame)) <= evaluation_error);
}

RC_GTEST_PROP(Model, TakesUnitVectorsForAngles, ()) {
  const PreparedModel model = prepare(any_model(*rc::gen::elementOf(every_family), 7), 1);
  // Away from the normal, where s hangs on the last digits of the azimuth, and from retro-reflection, where ⊥ does.
  const Geometry geometry{{between(0.1, pi / 2), between(-pi, pi)}, {between(0.1, pi / 2), between(-pi, pi)}};
  RC_PRE(std::abs(geometry.incident.theta - geometry.reflected.theta) > 0.01);
  const Vector3 incident = unit_vector(geometry.incident), reflected = unit_vector(geometry.reflected);
  for (const Frame frame : every_frame)
    RC_ASSERT(deviation(model.evaluate(incident, reflected, frame), model.evaluate(geometry, frame)) <= 1e-12);
}

TEST(Model, TakesTheNormalAsAUnitVectorWithAzimuthZero) {
  for (const Family family : every_family) {
    const PreparedModel model = prepare(random_model(family, {4, 4}, 0, 1), 1);
    for (const Frame frame : every_frame) {
      EXPECT_EQ(model.evaluate(Vector3{0, 0, 1}, Vector3{0, 0, 1}, frame),
                model.evaluate(in_degrees(0, 0, 0, 0), frame));
      EXPECT_LE(deviation(model.evaluate(Vector3{0, 0, 1}, unit_vector({0.7, 0.2}), frame),
                          model.evaluate({{0, 0}, {0.7, 0.2}}, frame)),
                symmetry_error);
    }
  }
}

// A vector in single precision is off by 6e-8 in length, which does not change its direction.
TEST(Model, TakesTheDirectionOfAVectorThatIsNotQuiteAUnitVector) {
  const auto stretched = [](Vector3 v, double factor) { return Vector3{v[0] * factor, v[1] * factor, v[2] * factor}; };
  const Vector3 incident = unit_vector({0.5, 1}), reflected = unit_vector({1.2, -2});
  for (const Family family : every_family) {
    const PreparedModel model = prepare(random_model(family, {7, 4}, 0, 1), 1);
    for (const Frame frame : every_frame)
      EXPECT_LE(deviation(model.evaluate(stretched(incident, 1 + 9e-7), stretched(reflected, 1 - 9e-7), frame),
                          model.evaluate(incident, reflected, frame)),
                symmetry_error);
  }
}

RC_GTEST_PROP(Model, HasAnF11ThatIsTheFirstElement, ()) {
  const PreparedModel model =
      prepare(either_way(any_model(*rc::gen::elementOf(every_family), 8, 1)), between(0.3, 1.2));
  const Geometry geometry = any_geometry();
  for (const Frame frame : every_frame)
    RC_ASSERT(std::abs(model.f11(geometry) - model.evaluate(geometry, frame)(0, 0)) <= evaluation_error);
}

TEST(Model, EvaluatesWithoutAllocating) {
  for (const Family family : every_family) {
    const PreparedModel model = prepare(random_model(family, {7, 4}, 1, 1), 0.5);
    const PreparedIncidence incidence = model.at(Direction{0.5, 1});
    const std::vector<Geometry> geometries(20, in_degrees(10, 20, 30, 40));
    const std::vector<Direction> directions(20, Direction{1, 2});
    std::vector<Mueller> out(20);
    const long before = allocations;
    for (const Frame frame : every_frame) {
      model.evaluate(geometries, frame, out);
      incidence.evaluate(directions, frame, out);
      out[0] = model.evaluate(Vector3{0, 0, 1}, Vector3{1, 0, 0}, frame);
      out[1](0, 0) = model.outside(geometries[0]) == inside ? model.f11(geometries[0]) : 0;
    }
    EXPECT_EQ(allocations, before) << to_string(family);
  }
  EXPECT_GT(allocations, 0);  // they are counted
}

// ---- the wavelength -------------------------------------------------------------------------------------------------

// λ^p means that; another public implementation has λ² for p = 3.
TEST(Model, PowersOfTheWavelengthAreThosePowersOfMicrometres) {
  EXPECT_NEAR(f11_of(diffuser({1}), 0.5), 1, evaluation_error);
  EXPECT_NEAR(f11_of(diffuser({0, 1}), 0.5), 0.5, evaluation_error);
  EXPECT_NEAR(f11_of(diffuser({0, 0, 1}), 0.5), 0.25, evaluation_error);
  EXPECT_NEAR(f11_of(diffuser({0, 0, 0, 1}), 0.5), 0.125, evaluation_error);
  EXPECT_NEAR(f11_of(diffuser({1, 10, 100, 1000}), 2), 8421, 8421 * evaluation_error);
}

// Eq. 18: the elements but f11 are polynomials themselves and multiply f11.
TEST(Model, PowersOfTheWavelengthOfF11AndOfTheOtherElementsAreMultiplied) {
  Model model = diffuser({0, 1});
  model.blocks.push_back({blocks(model.family, {0, 0}).back(), {0, pi / 2}, {}, 0, 0});  // m44 = λ
  EXPECT_NEAR(prepare(model, 0.5).evaluate(in_degrees(1, 2, 3, 4))(3, 3), 0.25, evaluation_error);
}

RC_GTEST_PROP(Model, AtAnotherWavelengthIsAsIfPreparedThere, ()) {
  Model model = any_model(*rc::gen::elementOf(every_family), 4, 3);
  model.reflectance = {{0.4, 0.7}, {0.9, 0.5}};
  const double wavelength = between(0.3, 1.2);
  const PreparedModel moved = prepare(model, between(0.3, 1.2)).at(wavelength), there = prepare(model, wavelength);
  const Geometry geometry = any_geometry();
  RC_ASSERT(moved.wavelength() == wavelength);
  RC_ASSERT(moved.evaluate(geometry) == there.evaluate(geometry));
  RC_ASSERT(moved.f11(geometry) == there.f11(geometry));
}

TEST(Model, PreparedDoesNotNeedTheModelAnyMore) {
  std::optional<Model> model = random_model(Family::isotropic, {4, 3}, 1, 1);
  model->reflectance = {{0.5}, {0.25}};
  std::optional<PreparedModel> first = prepare(*model, 0.5);
  const Geometry geometry = in_degrees(10, 20, 30, 40);
  const Mueller expected = first->at(0.7).evaluate(geometry);
  model.reset();
  const PreparedModel second = first->at(0.7);
  const PreparedIncidence third = second.at(geometry.incident);
  first.reset();
  EXPECT_EQ(second.evaluate(geometry), expected);
  EXPECT_LE(deviation(third.evaluate(geometry.reflected), expected), evaluation_error);
}

TEST(ReflectanceTable, MultipliesEveryElementOfTheMatrix) {
  Model model = random_model(Family::isotropic, {4, 3}, 0, 1);
  const Geometry geometry = in_degrees(10, 20, 30, 40);
  const Mueller plain = prepare(model, 0.5).evaluate(geometry);
  model.reflectance = {{0.4, 0.6}, {0.2, 0.3}};
  EXPECT_LE(deviation(prepare(model, 0.5).evaluate(geometry), 0.25 * plain), evaluation_error);
}

// ---- the published form ---------------------------------------------------------------------------------------------

RC_GTEST_PROP(Model, InPublishedFormIsTheSameModel, ()) {
  Model model = either_way(any_model(Family::isotropic, 6, 1));
  model.reflectance = {{0.4, 0.7}, {0.9, 0.5}};
  const Model published_form = in_published_form(model);
  RC_ASSERT(published_form.family == Family::germer2017);
  RC_ASSERT(published_form.rotation == Rotation::covariant);
  RC_ASSERT(published_form.mapping == model.mapping);
  RC_ASSERT(published_form.powers == model.powers);
  RC_ASSERT(published_form.name == model.name);
  const double wavelength = between(0.3, 1.2);
  const Geometry geometry = any_geometry();
  for (const Frame frame : every_frame)
    RC_ASSERT(deviation(prepare(published_form, wavelength).evaluate(geometry, frame),
                        prepare(model, wavelength).evaluate(geometry, frame)) <= symmetry_error);
}

TEST(Model, InPublishedFormOfOrders7And4HasModesOfThePublishedSetOnly) {
  const Model model = in_published_form(random_model(Family::isotropic, {7, 4}, 0, 1));
  const auto allowed = blocks(Family::germer2017, {7, 4});
  for (const FittedBlock& fitted : model.blocks)
    for (const Mode& mode : fitted.block.modes) {
      const auto block =
          std::find_if(allowed.begin(), allowed.end(), [&](const Block& b) { return b.name == fitted.block.name; });
      ASSERT_NE(block, allowed.end());
      EXPECT_NE(std::find(block->modes.begin(), block->modes.end(), mode), block->modes.end()) << to_string(mode);
    }
}

TEST(Model, InPublishedFormIsKeptIfItHasItAndRefusedIfItCannotHaveIt) {
  const Model germer = random_model(Family::germer2017, {4, 2}, 1, 1);
  const Model kept = in_published_form(germer);
  EXPECT_EQ(in_published_form(as_printed(germer)).rotation, Rotation::as_printed);
  ASSERT_EQ(kept.blocks.size(), germer.blocks.size());
  for (std::size_t b = 0; b < kept.blocks.size(); ++b)
    EXPECT_EQ(kept.blocks[b].coefficients, germer.blocks[b].coefficients);
  EXPECT_EQ(message_of([] {
              in_published_form(random_model(Family::anisotropic, {2, 2}, 0, 1));
            }),
            "a model of the anisotropic family has no published form");
}

// ---- models with little in them ------------------------------------------------------------------------------------

TEST(Model, MayHaveF11Alone) {
  EXPECT_EQ(prepare(diffuser({0.25}), 1).evaluate(in_degrees(80, 70, 60, 50), Frame::sp),
            diagonal(f11_of(diffuser({0.25}), 1), 0, 0, 0));
}

// ---- questions that are none ----------------------------------------------------------------------------------------

TEST(Model, RefusesWavelengthsThatAreNotPositive) {
  const Model model = diffuser({1, 1});
  const PreparedModel prepared = prepare(model, 0.5);
  EXPECT_EQ(message_of([&] { prepare(model, -0.001); }), "wavelength -1 nm is not positive");
  EXPECT_EQ(message_of([&] { prepared.at(-0.001); }), "wavelength -1 nm is not positive");
  for (const double bad : {-1.0, 0.0, -0.0, nan_value, infinity, -infinity}) {
    EXPECT_THROW(prepare(model, bad), std::invalid_argument) << bad;
    EXPECT_THROW(prepared.at(bad), std::invalid_argument) << bad;
  }
}

// A finite question has a finite answer or none.
TEST(Model, RefusesWavelengthsBeyondAMetre) {
  const Model cubic = diffuser({1, 0, 0, 1});
  EXPECT_THROW(prepare(cubic, 1.001 * max_wavelength), std::invalid_argument);
  EXPECT_THROW(prepare(cubic, 1).at(1e200), std::invalid_argument);
  EXPECT_TRUE(std::isfinite(f11_of(diffuser({1, 0, 0, 0, 0, 0, 0, 0, 0, 1}), max_wavelength)));
  EXPECT_TRUE(std::isfinite(f11_of(cubic, 1e-300)));
}

// λ⁹ is 1e54 at a metre: only a coefficient beyond all reason makes it infinite.
TEST(Model, RefusesWavelengthsWhosePowersOverflow) {
  EXPECT_THROW(prepare(diffuser({1, 0, 0, 0, 0, 0, 0, 0, 0, 1e300}), max_wavelength), std::invalid_argument);
}

TEST(Model, RefusesDirectionsBelowTheHorizonAndAnglesThatAreNone) {
  const PreparedModel model = prepare(diffuser({1}), 1);
  EXPECT_EQ(message_of([&] { model.evaluate(in_degrees(95, 0, 0, 0)); }), "theta_i = 95 degrees, must be in 0...90");
  EXPECT_EQ(message_of([&] { model.f11(in_degrees(0, 0, 95, 0)); }), "theta_r = 95 degrees, must be in 0...90");
  EXPECT_EQ(message_of([&] { model.at(Direction{radians(95), 0}); }), "theta_i = 95 degrees, must be in 0...90");
  const Direction bad_directions[] = {{radians(95), 0}, {-1e-9, 0},     {nan_value, 0},
                                      {infinity, 0},    {0, nan_value}, {0, infinity}};
  const PreparedIncidence incidence = model.at(Direction{});
  for (const Direction& bad : bad_directions) {
    for (const Geometry& geometry : {Geometry{bad, {}}, Geometry{{}, bad}}) {
      for (const Frame frame : every_frame) EXPECT_THROW(model.evaluate(geometry, frame), std::invalid_argument);
      EXPECT_THROW(model.f11(geometry), std::invalid_argument);
    }
    EXPECT_THROW(model.at(bad), std::invalid_argument);
    EXPECT_THROW(incidence.evaluate(bad), std::invalid_argument);
  }
}

TEST(Model, RefusesVectorsThatAreNoDirections) {
  for (const Family family : every_family) {
    const PreparedModel model = prepare(random_model(family, {2, 2}, 0, 1), 1);
    const Vector3 up{0, 0, 1};
    const Vector3 bad_vectors[] = {{0, 0, -1},        {0, 0, 0},         {0, 0, 1.00001}, {0, 0.6, -0.8},
                                   {nan_value, 0, 1}, {0, 0, nan_value}, {infinity, 0, 0}};
    for (const Vector3& bad : bad_vectors)
      for (const Frame frame : every_frame) {
        EXPECT_THROW(model.evaluate(bad, up, frame), std::invalid_argument);
        EXPECT_THROW(model.evaluate(up, bad, frame), std::invalid_argument);
      }
  }
}

TEST(Model, RefusesVectorsBelowTheSurfaceAsTheyWereGivenInEveryFrame) {
  const PreparedModel model = prepare(diffuser({1}), 1);
  const Vector3 up{0, 0, 1}, down{0, 0.6, -0.8}, hardly_down{1, 0, -1e-12};
  for (const Frame frame : every_frame) {
    const auto refusal = [&](const Vector3& i, const Vector3& r) {
      return message_of([&] { model.evaluate(i, r, frame); });
    };
    EXPECT_EQ(refusal(down, up), "(0, 0.6, -0.8) is not a unit vector with z >= 0");
    EXPECT_EQ(refusal(up, hardly_down), "(1, 0, -1e-12) is not a unit vector with z >= 0");
  }
}

TEST(Model, RefusesASpanWithAnotherSizeBeforeItWrites) {
  const PreparedModel model = prepare(diffuser({1}), 1);
  const PreparedIncidence incidence = model.at(Direction{});
  const std::vector<Geometry> geometries(3);
  const std::vector<Direction> directions(3);
  std::vector<Mueller> out(2, identity());
  EXPECT_EQ(message_of([&] { model.evaluate(geometries, Frame::xy, out); }), "3 geometries, room for 2");
  EXPECT_EQ(message_of([&] { incidence.evaluate(directions, Frame::xy, out); }), "3 directions, room for 2");
  EXPECT_EQ(out, std::vector<Mueller>(2, identity()));
}

// ---- awkward numbers ------------------------------------------------------------------------------------------------

TEST(Model, IsFiniteAtTheHorizonAndAtTheNormal) {
  for (const Family family : every_family) {
    const PreparedModel model = prepare(random_model(family, {12, 5}, 0, 1), 1);
    for (const double theta_i : {0.0, 1e-300, 1e-9, 45.0, 90.0})
      for (const double theta_r : {0.0, 1e-300, 1e-9, 45.0, 90.0})
        for (const double phi_r : {0.0, 90.0, 180.0})
          for (const Frame frame : every_frame)
            for (const double element : model.evaluate(in_degrees(theta_i, 0, theta_r, phi_r), frame).elements)
              EXPECT_TRUE(std::isfinite(element)) << theta_i << " " << theta_r << " " << phi_r;
  }
}

// In xy there is no singularity: a tiny angle moves the matrix by as little.
TEST(Model, IsSmoothAtTheNormal) {
  const PreparedModel model = prepare(random_model(Family::isotropic, {12, 12}, 0, 1), 1);
  for (const double theta : {1e-300, 1e-16})
    EXPECT_LE(deviation(model.evaluate({{theta, 1}, {theta, 2}}), model.evaluate({{0, 0}, {0, 0}})), symmetry_error);
}

// 10⁶ radians, reduced with the 64 bits of π that long double has. Numbers of that size are 1.2e-10 apart, and the
// frames add such angles up.
TEST(Model, TakesAzimuthsOfManyTurns) {
  const double far = 1e6, near = static_cast<double>(std::remainder(1e6L, 2 * std::numbers::pi_v<long double>));
  for (const Family family : every_family) {
    const PreparedModel model = prepare(random_model(family, {7, 4}, 0, 1), 1);
    const auto deviation_in = [&](Frame frame) {
      return deviation(model.evaluate({{0.7, far}, {1.1, far + 2}}, frame),
                       model.evaluate({{0.7, near}, {1.1, near + 2}}, frame));
    };
    EXPECT_LE(deviation_in(Frame::xy), symmetry_error);
    EXPECT_LE(deviation_in(Frame::sp), symmetry_error);
    EXPECT_LE(deviation_in(Frame::scattering_plane), 1e-9);
  }
}

// As the C library reduces them, whose sine and cosine of any number are right.
TEST(Model, TakesAzimuthsOfAnySize) {
  const PreparedModel model = prepare(random_model(Family::isotropic, {7, 4}, 0, 1), 1);
  for (const double far : {1e7, -1e15, 1e300}) {
    const std::vector<Geometry> geometries(20, Geometry{{0.7, far}, {1.1, 2}});
    std::vector<Mueller> out(20);
    model.evaluate(geometries, Frame::xy, out);
    const Mueller near = model.evaluate({{0.7, std::atan2(std::sin(far), std::cos(far))}, {1.1, 2}});
    for (const Mueller& m : out) EXPECT_LE(deviation(m, near), symmetry_error);
  }
}
