// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/model/batch.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "given/cases.hpp"
#include "given/random_model.hpp"
#include "given/reference_sum.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/samples/samples.hpp"

using namespace mmbrdf;

namespace {

constexpr std::array every_family{Family::isotropic, Family::germer2017, Family::anisotropic};
constexpr std::array every_frame{Frame::xy, Frame::sp, Frame::scattering_plane};
constexpr std::size_t many = 20000;  // enough for several threads

template <class Real>
struct Columns {
  std::array<std::vector<Real>, 6> in;
  explicit Columns(const std::vector<Geometry>& geometries) {
    for (const Geometry& g : geometries) {
      const Vector3 i = unit_vector(g.incident), r = unit_vector(g.reflected);
      for (std::size_t j = 0; j < 3; ++j) {
        in[j].push_back(static_cast<Real>(i[j]));
        in[3 + j].push_back(static_cast<Real>(r[j]));
      }
    }
  }
  UnitVectors<Real> incident() const { return {in[0], in[1], in[2]}; }
  UnitVectors<Real> reflected() const { return {in[3], in[4], in[5]}; }
  VectorGeometries<Real> geometries() const { return {incident(), reflected()}; }
};

template <class Real>
struct ElementColumns {
  std::array<std::vector<Real>, 16> values;
  MuellerColumns<Real> columns;
  explicit ElementColumns(std::size_t count) {
    for (std::size_t e = 0; e < 16; ++e) {
      values[e].resize(count);
      columns.elements[e] = values[e];
    }
  }
};

/// Matrix q of a list of numbers.
template <class Real>
Mueller matrix(const std::vector<Real>& rows, std::size_t q) {
  Mueller m;
  for (std::size_t e = 0; e < 16; ++e) m.elements[e] = static_cast<double>(rows[16 * q + e]);
  return m;
}

Model any_model(int powers = 0) {
  const Family family = *rc::gen::elementOf(every_family);
  Model model = random_model(family, *rc::gen::element(Orders{7, 4}, Orders{5, 5}, Orders{2, 3}), powers,
                             *rc::gen::arbitrary<std::uint64_t>(),
                             *rc::gen::element(DiscMapping::lambert, DiscMapping::projected));
  model.reflectance = {{0.4, 0.7}, {0.9, 0.5}};
  return model;
}

}  // namespace

TEST(Batch, DoesNotDependOnTheNumberOfThreads) {
  const PreparedModel model = prepare(random_model(Family::germer2017, {7, 4}, 0, 1), 0.5);
  const std::vector<Geometry> geometries = random_geometries(many, 1);
  const Columns<double> vectors(geometries);
  for (const Frame frame : every_frame) {
    std::vector<Mueller> from_angles(many), from_vectors(many);
    evaluate(model, geometries, from_angles, {.frame = frame});
    evaluate(model, vectors.geometries(), from_vectors, {.frame = frame});
    for (const int threads : {0, 2, 3, 7}) {
      std::vector<Mueller> out(many);
      evaluate(model, geometries, out, {.frame = frame, .threads = threads});
      EXPECT_EQ(out, from_angles) << threads;
      evaluate(model, vectors.geometries(), out, {.frame = frame, .threads = threads});
      EXPECT_EQ(out, from_vectors) << threads;
    }
  }
}

// Whatever is evaluated beside it, and in whatever layout: parallel beams, too, which are rare in the scattering plane.
RC_GTEST_PROP(Batch, HasTheBitsOfOneAtATime, ()) {
  const PreparedModel model = prepare(any_model(), 0.5);
  const Frame frame = *rc::gen::elementOf(every_frame);
  const BatchOptions options{.frame = frame};
  const int count = *rc::gen::inRange(1, 40);
  std::vector<Geometry> geometries = random_geometries(count, *rc::gen::arbitrary<unsigned long>());
  for (std::size_t q = 0; q < geometries.size(); q += 7) geometries[q].reflected = geometries[q].incident;
  const Columns<double> vectors(geometries);
  std::vector<Mueller> from_angles(geometries.size()), rows(geometries.size());
  std::vector<double> numbers(16 * geometries.size());
  ElementColumns<double> columns(geometries.size());
  evaluate(model, geometries, from_angles, options);
  evaluate(model, vectors.geometries(), rows, options);
  evaluate(model, vectors.geometries(), numbers, options);
  evaluate(model, vectors.geometries(), columns.columns, options);
  for (std::size_t q = 0; q < geometries.size(); ++q) {
    const Columns<double> alone({geometries[q]});
    Mueller one;
    evaluate(model, alone.geometries(), std::span(&one, 1), options);
    RC_ASSERT(rows[q] == one);
    RC_ASSERT(from_angles[q] == model.evaluate(geometries[q], frame));
    RC_ASSERT(deviation_of_m11(rows[q], from_angles[q]) <= evaluation_error);
    for (std::size_t e = 0; e < 16; ++e) {
      RC_ASSERT(rows[q].elements[e] == numbers[16 * q + e]);
      RC_ASSERT(rows[q].elements[e] == columns.values[e][q]);
    }
  }
}

RC_GTEST_PROP(Batch, InAnyFrameIsChangedFromXy, ()) {
  const PreparedModel model = prepare(either_way(any_model()), 0.5);
  const BatchOptions options{.frame = *rc::gen::elementOf(every_frame)};
  std::vector<Geometry> geometries = random_geometries(20, *rc::gen::arbitrary<unsigned long>());
  geometries[3].incident.phi += 2e7;  // more than the kernel takes
  geometries[3].reflected.phi += 2e7;
  geometries[9].reflected = geometries[9].incident;
  // To and from the plane change_frame() adds angles, and rounds them there.
  const double rounding = options.frame == Frame::scattering_plane ? 1e-7 : 0;
  std::vector<double> wavelengths(geometries.size(), 0.6);
  wavelengths.back() = 0.5;  // of one they would be folded
  BatchOptions with_wavelengths = options;
  with_wavelengths.wavelengths = wavelengths;
  std::vector<Mueller> found(20), at_wavelengths(20), reflected(20), xy(20), reflected_xy(20);
  std::vector<Direction> directions;
  for (const Geometry& g : geometries) directions.push_back(g.reflected);
  const PreparedIncidence at = model.at(geometries[3].incident);
  evaluate(model, geometries, found, options);
  evaluate(model, geometries, at_wavelengths, with_wavelengths);
  evaluate(model, geometries, xy);
  evaluate(at, directions, reflected, options);
  evaluate(at, directions, reflected_xy);
  for (std::size_t q = 0; q < geometries.size(); ++q) {
    const auto changed = [&](const Mueller& m, const Geometry& g) {
      return change_frame(m, g, Frame::xy, options.frame);
    };
    const double allowed = evaluation_error + (q == 3 ? rounding : 0);
    RC_ASSERT(deviation_of_m11(found[q], changed(xy[q], geometries[q])) <= allowed);
    const Geometry g{at.incident(), directions[q]};
    RC_ASSERT(deviation_of_m11(reflected[q], changed(reflected_xy[q], g)) <= evaluation_error + rounding);
    const Mueller other = changed(model.at(wavelengths[q]).evaluate(geometries[q]), geometries[q]);
    RC_ASSERT(deviation_of_m11(at_wavelengths[q], other) <= allowed);
  }
}

RC_GTEST_PROP(Batch, InSinglePrecisionKeepsItsPromise, ()) {
  const PreparedModel model = prepare(any_model(), 0.5);
  const std::vector<Geometry> geometries = random_geometries(20, *rc::gen::arbitrary<unsigned long>(), radians(89));
  const Columns<float> vectors(geometries);
  const Frame frame = *rc::gen::element(Frame::xy, Frame::sp);
  std::vector<float> rows(16 * geometries.size());
  ElementColumns<float> columns(geometries.size());
  evaluate(model, vectors.geometries(), rows, {.frame = frame});
  evaluate(model, vectors.geometries(), columns.columns, {.frame = frame});
  for (std::size_t q = 0; q < geometries.size(); ++q) {
    if (geometries[q].incident.theta < 0.05 || geometries[q].reflected.theta < 0.05) continue;  // azimuths lose digits
    RC_ASSERT(deviation_of_m11(matrix(rows, q), model.evaluate(geometries[q], frame)) <= single_precision_error);
    for (std::size_t e = 0; e < 16; ++e) RC_ASSERT(rows[16 * q + e] == columns.values[e][q]);
  }
}

// Whether or not one is that of all; azimuths that the kernel does not take are done again.
RC_GTEST_PROP(Batch, AtTheWavelengthOfEachGeometryHasTheBitsOfThatPreparedThere, ()) {
  const PreparedModel model = prepare(any_model(*rc::gen::inRange(0, 4)), 0.5);
  std::vector<Geometry> geometries = random_geometries(20, *rc::gen::arbitrary<unsigned long>());
  geometries[7].reflected.phi = 1e9;
  const bool one = *rc::gen::arbitrary<bool>();
  std::vector<double> wavelengths(geometries.size(), 0.6);
  if (!one) std::ranges::generate(wavelengths, [] { return between(0.3, 1.2); });
  for (const Frame frame : every_frame) {
    std::vector<Mueller> out(geometries.size());
    evaluate(model, geometries, out, {.frame = frame, .wavelengths = wavelengths});
    for (std::size_t q = 0; q < geometries.size(); ++q)
      RC_ASSERT(out[q] == model.at(wavelengths[q]).evaluate(geometries[q], frame));
  }
}

RC_GTEST_PROP(Batch, InSinglePrecisionAtTheWavelengthOfEachGeometryAgreesWithThatPreparedThere, ()) {
  const PreparedModel model = prepare(any_model(*rc::gen::inRange(0, 4)), 0.5);
  const std::vector<Geometry> geometries = random_geometries(20, *rc::gen::arbitrary<unsigned long>());
  std::vector<double> wavelengths;
  for (std::size_t q = 0; q < geometries.size(); ++q) wavelengths.push_back(between(0.3, 1.2));
  const Columns<float> vectors(geometries);
  std::vector<float> rows(16 * geometries.size());
  evaluate(model, vectors.geometries(), rows, {.wavelengths = wavelengths});
  for (std::size_t q = 0; q < geometries.size(); ++q) {
    if (geometries[q].incident.theta < 0.05) continue;
    RC_ASSERT(deviation_of_m11(matrix(rows, q), model.at(wavelengths[q]).evaluate(geometries[q])) <=
              single_precision_error);
  }
}

RC_GTEST_PROP(Batch, ForOneIncidentDirectionAgrees, ()) {
  const PreparedModel model = prepare(either_way(any_model()), 0.5);
  const Direction incident{between(0.05, 1.5), between(-6, 6)};
  const PreparedIncidence prepared = model.at(incident);
  std::vector<Geometry> geometries = random_geometries(20, *rc::gen::arbitrary<unsigned long>());
  std::vector<Direction> reflected;
  for (Geometry& g : geometries) {
    g.incident = incident;
    reflected.push_back(g.reflected);
  }
  const Columns<double> vectors(geometries);
  const Columns<float> short_vectors(geometries);
  std::vector<Mueller> from_angles(20), from_vectors(20);
  std::vector<float> rows(16 * 20);
  evaluate(prepared, reflected, from_angles);
  evaluate(prepared, vectors.reflected(), from_vectors);
  evaluate(prepared, short_vectors.reflected(), rows);
  for (std::size_t q = 0; q < geometries.size(); ++q) {
    const Mueller expected = model.evaluate(geometries[q]);
    RC_ASSERT(deviation_of_m11(from_angles[q], expected) <= evaluation_error);
    RC_ASSERT(deviation_of_m11(from_vectors[q], expected) <= evaluation_error);
    RC_ASSERT(deviation_of_m11(matrix(rows, q), expected) <= single_precision_error);
  }
}

TEST(Batch, RefusesWhatIsInvalidBeforeItWrites) {
  const PreparedModel model = prepare(random_model(Family::isotropic, {7, 4}, 0, 1), 0.5);
  const std::vector<Geometry> geometries = random_geometries(many, 1);
  std::vector<Geometry> with_bad = geometries;
  with_bad[17000].reflected.theta = radians(95);
  with_bad[18000].reflected.theta = radians(96);
  Columns<double> vectors(geometries);
  vectors.in[0][12345] = 3;
  vectors.in[1][12345] = vectors.in[2][12345] = 0;
  const std::vector<Mueller> untouched(many, identity());
  std::vector<Mueller> out = untouched;
  for (const int threads : {1, 2}) {
    const BatchOptions options{.threads = threads};
    EXPECT_EQ(message_of([&] { evaluate(model, with_bad, out, options); }), "theta_r = 95 degrees, must be in 0...90");
    EXPECT_EQ(message_of([&] { evaluate(model, vectors.geometries(), out, options); }),
              "incident vector 12346: (3, 0, 0) is not a unit vector with z >= 0");
  }
  EXPECT_EQ(out, untouched);
}

TEST(Batch, RefusesVectorsThatAreNoDirections) {
  const PreparedModel model = prepare(random_model(Family::isotropic, {7, 4}, 0, 1), 0.5);
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const Vector3 bad_vectors[] = {{0, 0, -1}, {0, 0, 0}, {0, 0, 1.00001}, {0, 0.6, -0.8}, {nan, 0, 1}, {infinity, 0, 0}};
  std::vector<Mueller> out(20);
  for (const Vector3& bad : bad_vectors)
    for (const std::size_t place : {0u, 7u, 19u}) {
      Columns<double> vectors(random_geometries(20, 1));
      for (std::size_t j = 0; j < 3; ++j) vectors.in[3 + j][place] = bad[j];
      EXPECT_THROW(evaluate(model, vectors.geometries(), out), std::invalid_argument) << bad[0] << bad[1] << bad[2];
    }
}

TEST(Batch, RefusesSizesThatDoNotAgree) {
  const PreparedModel model = prepare(random_model(Family::isotropic, {7, 4}, 0, 1), 0.5);
  const std::vector<Geometry> geometries = random_geometries(3, 1);
  const Columns<double> vectors(geometries);
  std::vector<Mueller> two(2), three(3);
  const std::vector<double> wavelengths(2, 0.5), negative(3, -0.5);
  EXPECT_EQ(message_of([&] { evaluate(model, geometries, two); }), "3 geometries, room for 2");
  EXPECT_EQ(message_of([&] { evaluate(model, vectors.geometries(), two); }), "3 geometries, room for 2");
  EXPECT_EQ(message_of([&] { evaluate(model, geometries, three, {.wavelengths = wavelengths}); }),
            "3 geometries, 2 wavelengths");
  EXPECT_EQ(message_of([&] { evaluate(model, geometries, three, {.wavelengths = negative}); }),
            "wavelength -500 nm is not positive");
  EXPECT_EQ(message_of([&] { evaluate(model, geometries, three, {.threads = -1}); }),
            "threads = -1, must be 0 or more");
  const VectorGeometries<double> uneven{vectors.incident(),
                                        {vectors.in[3], std::span(vectors.in[4]).first(2), vectors.in[5]}};
  EXPECT_EQ(message_of([&] { evaluate(model, uneven, three); }), "reflected vectors with 3 x, 2 y and 3 z");
}

TEST(Batch, RefusesWavelengthsWhosePowersAreTooLarge) {
  Model model = random_model(Family::isotropic, {2, 1}, max_power, 1);
  const std::vector<Geometry> geometries = random_geometries(2, 1);
  const PreparedModel prepared = prepare(model, 0.5);
  const std::vector<double> long_waves{0.5, 5e4};  // λ⁹ = 2e42: too much for a float
  BatchOptions options;
  options.wavelengths = long_waves;
  const Columns<float> vectors(geometries);
  std::vector<float> numbers(32, -1);
  EXPECT_THROW(evaluate(prepared, vectors.geometries(), numbers, options), std::invalid_argument);
  EXPECT_EQ(numbers, std::vector<float>(32, -1));
  std::vector<Mueller> out(2);
  EXPECT_NO_THROW(evaluate(prepared, geometries, out, options));
  for (FittedBlock& block : model.blocks)
    for (double& a : block.coefficients) a = 1e270;
  EXPECT_THROW(evaluate(prepare(model, 0.5), geometries, out, options), std::invalid_argument);
}

TEST(Batch, RefusesAFrameThatIsNoneOnAnyNumberOfThreads) {
  const std::vector<Geometry> geometries = random_geometries(20000, 1);
  std::vector<Mueller> out(geometries.size());
  for (const int threads : {1, 2}) {
    BatchOptions options;
    options.frame = static_cast<Frame>(7);
    options.threads = threads;
    EXPECT_THROW(evaluate(prepare(material("ptfe"), 0.532), geometries, out, options), std::invalid_argument);
  }
}

TEST(Batch, OfNothingIsNothing) {
  const PreparedModel model = prepare(random_model(Family::isotropic, {7, 4}, 0, 1), 0.5);
  evaluate(model, std::span<const Geometry>{}, std::span<Mueller>{});
  evaluate(model, VectorGeometries<float>{}, std::span<float>{}, {.frame = Frame::sp, .threads = 2});
  evaluate(model.at(Direction{}), std::span<const Direction>{}, std::span<Mueller>{});
}

// Single precision ends at 3e38.
// They are taken to have length 1 to 1e-6, and are made so.
TEST(Batch, OfVectorsOfNearlyUnitLengthIsThatOfTheirDirections) {
  for (const Family family : every_family)
    for (const DiscMapping mapping : {DiscMapping::lambert, DiscMapping::projected})
      for (const Orders& orders : {Orders{7, 4}, Orders{9, 3}}) {
        const PreparedModel model = prepare(random_model(family, orders, 0, 5, mapping), 0.5);
        const Columns<double> exact(random_geometries(100, 6));
        std::vector<Mueller> expected(100), found(100);
        evaluate(model, exact.geometries(), expected);
        for (const double length : {1 - 9e-7, 1 + 9e-7}) {
          Columns<double> scaled = exact;
          for (std::vector<double>& column : scaled.in)
            for (double& component : column) component *= length;
          evaluate(model, scaled.geometries(), found);
          for (std::size_t q = 0; q < 100; ++q)
            for (std::size_t e = 0; e < 16; ++e)
              ASSERT_NEAR(found[q].elements[e], expected[q].elements[e], 1e-12 * std::abs(expected[q](0, 0)));
        }
      }
}

// Squares of such sines are 0, but the azimuth from which one comes is not.
TEST(Batch, TendsToItsLimitAtTheNormal) {
  for (const Family family : every_family)
    for (const Rotation rotation : {Rotation::covariant, Rotation::as_printed}) {
      if (family != Family::germer2017 && rotation == Rotation::as_printed) continue;
      Model random = random_model(family, {7, 4}, 0, 5);
      random.rotation = rotation;
      const PreparedModel model = prepare(random, 0.5);
      const Direction reflected{0.7, 2};
      const Mueller limit = model.evaluate({{1e-9, 0.6}, reflected}),
                    turned_to = model.evaluate({reflected, {1e-9, 0.6}});
      for (const double theta : {1e-30, 1e-130, 1e-170, 1e-250})
        for (std::size_t e = 0; e < 16; ++e) {
          EXPECT_NEAR(model.evaluate({{theta, 0.6}, reflected}).elements[e], limit.elements[e], 1e-7) << theta;
          EXPECT_NEAR(model.evaluate({reflected, {theta, 0.6}}).elements[e], turned_to.elements[e], 1e-7) << theta;
        }
    }
}

TEST(Batch, RefusesCoefficientsThatAreTooLargeForSinglePrecision) {
  const PreparedModel model = prepare(diffuser({1e39}), 0.5);
  const Columns<float> vectors(random_geometries(1, 1));
  std::vector<float> out(16);
  EXPECT_THROW(evaluate(model, vectors.geometries(), out), std::invalid_argument);
}
