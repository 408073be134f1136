// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/uncertainty/prediction.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "given/cases.hpp"
#include "given/least_squares.hpp"
#include "given/random_model.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/radiometry/certificate.hpp"
#include "mmbrdf/radiometry/reflectance_uncertainty.hpp"
#include "mmbrdf/samples/simulation.hpp"
#include "mmbrdf/uncertainty/draws.hpp"
#include "mmbrdf/uncertainty/expanded.hpp"
#include "uncertainty/variances.hpp"

namespace mmbrdf {
namespace {

constexpr std::array every_frame{Frame::xy, Frame::sp, Frame::scattering_plane};

/// Random coefficients with a random covariance of full rank.
Model with_covariance(Family family, DiscMapping mapping, std::uint64_t seed) {
  Model model = random_model(family, {4, 3}, 0, seed, mapping);
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal(0, 1e-3);
  for (FittedBlock& fitted : model.blocks) {
    const std::size_t size = fitted.coefficients.size();
    std::vector<double> errors(size * (size + 2));
    for (double& error : errors) error = normal(engine);
    fitted.covariance.assign(size * size, 0);
    for (std::size_t i = 0; i < size; ++i)
      for (std::size_t j = 0; j < size; ++j)
        for (std::size_t k = 0; k < size + 2; ++k)
          fitted.covariance[i * size + j] += errors[i * (size + 2) + k] * errors[j * (size + 2) + k];
    fitted.rank = static_cast<int>(size);
  }
  return model;
}

/// A fit of the mixed model, whose covariance is of other modes than it has, at two wavelengths.
Model of_sample(const Elements& not_measured = {}) {
  auto samples =
      simulate(random_model(Family::isotropic, {3, 2}, 0, 5), std::array{0.5, 0.6}, random_geometries(60, 3), 0.01, 1);
  for (Sample& sample : samples)
    for (std::size_t e = 0; e < 16; ++e)
      if (not_measured[e]) sample.normalized.elements[e] = std::nan("");
  return fit_sample(samples, {Family::isotropic, {3, 2}}).model;
}

Model without(std::string block, Model model) {
  const auto found = std::ranges::find(model.blocks, block, [](const FittedBlock& b) { return b.block.name; });
  for (const Element& element : found->block.elements) model.not_measured.set(element.index());
  model.blocks.erase(found);
  return model;
}

struct Case {
  std::string name;
  PreparedUncertainty u;
  Model model;
  double wavelength;
  Case(std::string what, Model of, double at)
      : name(std::move(what)), u(prepare_uncertainty(of, at)), model(std::move(of)), wavelength(at) {}
};

const std::vector<Case>& cases() {
  static const std::vector<Case> list = [] {
    std::vector<Case> result;
    for (const DiscMapping mapping : {DiscMapping::lambert, DiscMapping::projected})
      for (const Family family : {Family::isotropic, Family::germer2017, Family::anisotropic})
        result.emplace_back(to_string(family) + " " + to_string(mapping), with_covariance(family, mapping, 3), 0.5);
    Model printed = with_covariance(Family::germer2017, DiscMapping::lambert, 4);
    printed.rotation = Rotation::as_printed;
    result.emplace_back("as printed", printed, 0.5);
    result.emplace_back("noise", least_squares("ptfe-532"), 0.532);
    result.emplace_back("uncertain reflectance", least_squares("ptfe"), 0.6);
    const Model mixed = of_sample();
    result.emplace_back("sample", mixed, 0.5);
    result.emplace_back("sample between wavelengths", mixed, 0.56);
    result.emplace_back(
        "certified sample",
        certified(mixed, std::array{CertifiedReflectance{0.5, 0.9, 0.01}, CertifiedReflectance{0.6, 0.8, 0.01}}).model,
        0.53);
    result.emplace_back("unknown 14", without("14,41", least_squares("ptfe-532")), 0.532);
    result.emplace_back("unknown 23", without("23,32", with_covariance(Family::germer2017, DiscMapping::lambert, 3)),
                        0.5);
    result.emplace_back("unknown 12 of a sample", of_sample(Elements(0x0116)), 0.5);
    return result;
  }();
  return list;
}

/// Now and then at the normal, at the horizon, in retro-reflection, or with many turns: their rounding is too much for
/// the scattering plane near retro-reflection.
Geometry any_geometry(Frame frame) {
  const int most_turns = frame == Frame::scattering_plane ? 0 : 3000000;
  const auto any_direction = [&] {
    const double theta = *rc::gen::element(0.0, radians(90), between(0, 1.5), between(0, 1.5), between(0, 1.5));
    return Direction{theta, between(-4, 4) + 2 * std::numbers::pi * *rc::gen::element(0, 0, 0, most_turns)};
  };
  const Direction incident = any_direction();
  return {incident, *rc::gen::element(0, 1, 2) == 0 ? incident : any_direction()};
}

std::vector<Geometry> any_geometries(std::size_t most, Frame frame) {
  std::vector<Geometry> result(*rc::gen::inRange<std::size_t>(1, most + 1));
  for (Geometry& geometry : result) geometry = any_geometry(frame);
  return result;
}

/// What the parts of the computation say, one geometry at a time: gradient and the covariance of the coefficients.
MuellerCovariance one_at_a_time(const PreparedUncertainty& u, const Geometry& geometry, Frame frame) {
  const MuellerGradient gradient = u.gradient(geometry, frame);
  return u.covariance(gradient, gradient);
}

bool near(double found, double expected, double allowed) {
  return std::isnan(expected) ? std::isnan(found) : std::abs(found - expected) <= allowed;
}

/// Of a variance: the gradient has the rounding of phi_r - phi_i at millions of turns.
double allowed_error(const MuellerCovariance& expected, const Geometry& geometry) {
  double largest = 0;
  for (const double value : expected.values)
    if (!std::isnan(value)) largest = std::max(largest, std::abs(value));
  const double phi = std::max(std::abs(geometry.incident.phi), std::abs(geometry.reflected.phi));
  return (batch_error + 1e-15 * phi) * largest;
}

RC_GTEST_PROP(Variances, OfManyGeometriesAreThoseOfEachFromItsGradient, ()) {
  const Case& c = cases()[*rc::gen::inRange<std::size_t>(0, cases().size())];
  const Frame frame = *rc::gen::elementOf(every_frame);
  const std::vector<Geometry> geometries = any_geometries(60, frame);
  std::vector<MuellerCovariance> covariances(geometries.size());
  std::vector<Mueller> deviations(geometries.size());
  c.u.evaluate(geometries, frame, covariances);
  c.u.standard_uncertainty(geometries, frame, deviations);
  for (std::size_t g = 0; g < geometries.size(); ++g) {
    const MuellerCovariance expected = one_at_a_time(c.u, geometries[g], frame);
    const double allowed = allowed_error(expected, geometries[g]);
    RC_ASSERT(allowed > 0);
    for (std::size_t i = 0; i < 256; ++i)
      if (!near(covariances[g].values[i], expected.values[i], allowed)) RC_FAIL(c.name + " " + std::to_string(i));
    for (std::size_t e = 0; e < 16; ++e)
      if (const double u = deviations[g].elements[e]; !near(u * u, expected(e, e), allowed) || u < 0)
        RC_FAIL(c.name + " u of " + element_name(e));
  }
}

/// From those of the matrix: m = F / f11.
RC_GTEST_PROP(Variances, OfElementsDividedByF11AreThoseOfTheMatrixWithThatSlope, ()) {
  const Frame frame = *rc::gen::elementOf(every_frame);
  const Geometry geometry = any_geometry(frame);
  for (const Case& c : cases()) {
    const Mueller f = prepare(c.model, c.wavelength).evaluate(geometry, frame);
    if (unknown_elements(f).any() || c.model.posterior || !(f(0, 0) > 0.1)) continue;  // other modes: another f
    const MuellerCovariance found = c.u.normalized(geometry, frame),
                            expected = normalized(c.u.evaluate(geometry, frame), f);
    const double allowed = 100 * allowed_error(expected, geometry);  // differences of larger numbers
    for (std::size_t i = 0; i < 256; ++i)
      if (!near(found.values[i], expected.values[i], allowed)) RC_FAIL(c.name + " " + std::to_string(i));
  }
}

RC_GTEST_PROP(Variances, OfOneGeometryHaveTheBitsOfThatAmongOthers, ()) {
  const Frame frame = *rc::gen::elementOf(every_frame);
  const std::vector<Geometry> geometries = any_geometries(60, frame);
  const std::size_t one = *rc::gen::inRange<std::size_t>(0, geometries.size());
  const auto bits = [](double value) { return std::isnan(value) ? 0.5 : value; };
  for (const Case& c : cases()) {
    std::vector<MuellerCovariance> covariances(geometries.size());
    std::vector<Mueller> deviations(geometries.size());
    std::vector<Direction> incident;
    for (const Geometry& geometry : geometries) incident.push_back(geometry.incident);
    std::vector<double> reflectances(geometries.size());
    c.u.evaluate(geometries, frame, covariances);
    c.u.standard_uncertainty(geometries, frame, deviations);
    c.u.directional_hemispherical_reflectance(incident, reflectances);
    const MuellerCovariance covariance = c.u.evaluate(geometries[one], frame);
    const Mueller deviation = c.u.standard_uncertainty(geometries[one], frame);
    RC_ASSERT(std::ranges::equal(covariance.values, covariances[one].values, {}, bits, bits));
    RC_ASSERT(std::ranges::equal(deviation.elements, deviations[one].elements, {}, bits, bits));
    RC_ASSERT(c.u.directional_hemispherical_reflectance(incident[one]) == reflectances[one]);
  }
}

TEST(Variances, OfReflectancesAreThoseOfTheIntegralOfTheGradient) {
  const std::vector<Direction> incident{{0, 0}, {0.7, 1}, {radians(90), -2}};
  for (const Case& c : cases()) {
    std::vector<double> found(incident.size());
    c.u.directional_hemispherical_reflectance(incident, found);
    const UncertainModel model = uncertain(c.model, c.wavelength);
    for (std::size_t i = 0; i < incident.size(); ++i)  // gradients at many directions
      EXPECT_NEAR(found[i] / standard_uncertainty(directional_hemispherical_budget(model, incident[i])), 1, 1e-9)
          << c.name;
  }
}

TEST(Variances, AreRefusedForAnyInvalidGeometryAndForOtherRoom) {
  const PreparedUncertainty& u = cases().front().u;
  std::vector<Geometry> geometries = random_geometries(40, 1);
  std::vector<MuellerCovariance> covariances(40);
  std::vector<Mueller> deviations(40);
  std::vector<Direction> directions(40);
  std::vector<double> reflectances(39);
  EXPECT_NO_THROW(u.standard_uncertainty({}, Frame::xy, {}));
  EXPECT_NO_THROW(u.directional_hemispherical_reflectance({}, {}));
  EXPECT_EQ(message_of([&] { u.standard_uncertainty(geometries, Frame::xy, std::span(deviations).first(39)); }),
            "40 geometries, room for 39");
  EXPECT_EQ(message_of([&] { u.evaluate(geometries, Frame::xy, std::span(covariances).first(39)); }),
            "40 geometries, room for 39");
  EXPECT_EQ(message_of([&] { u.directional_hemispherical_reflectance(directions, reflectances); }),
            "40 directions, room for 39");
  geometries[37].reflected.theta = radians(95);
  directions[37].theta = radians(95);
  reflectances.resize(40);
  EXPECT_THROW(u.standard_uncertainty(geometries, Frame::sp, deviations), std::invalid_argument);
  EXPECT_THROW(u.evaluate(geometries, Frame::sp, covariances), std::invalid_argument);
  EXPECT_THROW(u.directional_hemispherical_reflectance(directions, reflectances), std::invalid_argument);
}

// As certain elements of a matrix are 0 by symmetry, so are their uncertainties: no root of a rounding.
TEST(Variances, OfWhatIsZeroBySymmetryAreZero) {
  for (const Geometry& geometry :
       {Geometry{{0.7, 0}, {0.4, 0}}, Geometry{{0, 0}, {0, 0}}, Geometry{{0.7, 0}, {0.7, 0}}}) {
    const Mueller u = prepare_uncertainty(least_squares("ptfe-532"), 0.532).standard_uncertainty(geometry);
    EXPECT_GT(u(0, 0), 0);
    for (const auto& [row, column] : {std::pair(0, 3), {3, 0}, {0, 2}, {2, 0}, {1, 2}})
      EXPECT_LT(u(row, column), 1e-15);
  }
}

// More draws than are worked out together, and more geometries.
TEST(DrawnMatrices, AreThoseOfTheDrawnModels) {
  for (const Case& c : cases()) {
    const Draws draws(c.model, static_cast<int>(DrawnMatrices::together) + 5, 1);
    const std::vector<PreparedModel> models = draws.at(c.wavelength);
    const DrawnMatrices matrices = draws.matrices_at(c.wavelength);
    ASSERT_EQ(matrices.count(), models.size());
    std::vector<Geometry> geometries = random_geometries(26, 4);
    geometries.push_back({{0, 3}, {0.7, 1e7}});
    for (const Frame frame : every_frame)
      for (const std::size_t first : {std::size_t{0}, DrawnMatrices::together}) {
        const std::size_t count = std::min(DrawnMatrices::together, models.size() - first);
        std::vector<Mueller> found(geometries.size() * count), alone(count);
        matrices.evaluate(first, geometries, frame, found);
        for (std::size_t g = 0; g < geometries.size(); ++g) {
          matrices.evaluate(first, {&geometries[g], 1}, frame, alone);
          for (std::size_t d = 0; d < count; d += 5) {
            const Mueller expected = models[first + d].evaluate(geometries[g], frame);
            for (std::size_t e = 0; e < 16; ++e)
              EXPECT_TRUE(near(found[g * count + d].elements[e], expected.elements[e], batch_error))
                  << c.name << ' ' << to_string(frame) << ' ' << g << ' ' << e << ": "
                  << found[g * count + d].elements[e] << ", not " << expected.elements[e];
            EXPECT_EQ(std::memcmp(&found[g * count + d], &alone[d], sizeof(Mueller)), 0) << c.name;
          }
        }
      }
  }
}

TEST(DrawnMatrices, RefuseRoomThatDoesNotFitAndWhatIsNoGeometry) {
  const DrawnMatrices matrices = Draws(least_squares("ptfe-532"), 3).matrices_at(0.532);
  std::vector<Mueller> out(4);
  const Geometry geometry{}, below{{0, 0}, {2, 0}};
  EXPECT_EQ(message_of([&] {
              matrices.evaluate(0, {&geometry, 1}, Frame::xy, out);
            }),
            "draws from 0 at 1 geometries, room for 4");
  EXPECT_THROW(matrices.evaluate(1, {&geometry, 1}, Frame::xy, std::span(out).first(3)), std::invalid_argument);
  EXPECT_THROW(matrices.evaluate(0, {&below, 1}, Frame::xy, std::span(out).first(3)), std::invalid_argument);
}

std::vector<double> random_numbers(std::size_t count, unsigned long seed) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  std::vector<double> result(count);
  for (double& x : result) x = any(engine);
  return result;
}

/// A sum of products, and of their sizes, in extended precision.
struct Sum {
  long double value = 0, size = 0;
  void add(long double term) { value += term, size += std::abs(term); }
};

// 7 products of numbers up to 2 are rounded. Columns are worked out 240 at a time.
TEST(VariancesKernel, MultipliesAsManyColumnsByASymmetricMatrixAsThereAre) {
  const std::vector<double> entries = random_numbers(49, 1);
  const Eigen::Map<const Eigen::MatrixXd> some(entries.data(), 7, 7);
  const Eigen::MatrixXd v = some + some.transpose();
  for (const long count : {1L, 9L, 240L, 241L, 500L}) {
    const std::vector<double> numbers = random_numbers(static_cast<std::size_t>(7 * count), 2);
    const Eigen::Map<const Eigen::MatrixXd> z(numbers.data(), 7, count);
    EXPECT_LT((symmetric_times(v, z) - v * z).cwiseAbs().maxCoeff(), 1e-14) << count;
  }
}

TEST(VariancesKernel, OfEveryInstructionSetAgreesWithSumsInExtendedPrecision) {
  constexpr long most = 40;  // columns; a whole number of registers of geometries, tiles and what is left of them
  for (const VariancesKernel* kernel : variances_kernels()) {
    if (!kernel->runs_here()) continue;
    for (const long columns : {4L, 12L, most})
      for (const long count : {1 * kernel->width, 3 * kernel->width, 24L}) {
        const std::vector<double> h = random_numbers(static_cast<std::size_t>(columns * count), 3);
        const auto n = static_cast<Eigen::Index>(columns);
        const std::vector<double> entries = random_numbers(static_cast<std::size_t>(n * n), 4);
        const Eigen::MatrixXd any = Eigen::Map<const Eigen::MatrixXd>(entries.data(), n, n), v = any + any.transpose();
        const Packed packed(v);
        std::vector<double> found(static_cast<std::size_t>(count)), products(h.size()), dots(found.size());
        kernel->variances(found.data(), h.data(), packed.view(), count, count);
        kernel->products(products.data(), count, h.data(), packed.view(), count, count);
        kernel->dots(dots.data(), h.data(), products.data(), columns, count, count);
        for (long g = 0; g < count; ++g) {
          Sum all;
          for (long j = 0; j < columns; ++j) {
            Sum row;
            for (long k = 0; k < columns; ++k)
              row.add(static_cast<long double>(v(j, k)) * h[static_cast<std::size_t>(k * count + g)]);
            const auto at = static_cast<std::size_t>(j * count + g);
            EXPECT_LE(std::abs(products[at] - row.value), static_cast<long double>(columns) * 0x1p-52L * row.size);
            all.add(row.value * h[at]);
            all.size += row.size * std::abs(h[at]);
          }
          const auto at = static_cast<std::size_t>(g);
          const long double rounding = static_cast<long double>(2 * columns) * 0x1p-52L * all.size;
          EXPECT_LE(std::abs(found[at] - all.value), rounding) << columns << ' ' << count;
          EXPECT_LE(std::abs(dots[at] - all.value), rounding) << columns << ' ' << count;
        }
      }
  }
}

TEST(VariancesKernel, OfEveryInstructionSetHasTheFunctionsAndAnglesOfTheLibrary) {
  constexpr int order = 7;
  constexpr long count = 24;
  const std::vector<double> numbers = random_numbers(3 * count, 5);
  std::vector<double> theta, phi;
  for (long g = 0; g < count; ++g) {
    theta.push_back(std::abs(numbers[static_cast<std::size_t>(g)]) * std::numbers::pi / 2);
    phi.push_back(10 * numbers[static_cast<std::size_t>(count + g)]);
  }
  for (const VariancesKernel* kernel : variances_kernels()) {
    if (!kernel->runs_here()) continue;
    for (const DiscMapping mapping : {DiscMapping::lambert, DiscMapping::projected}) {
      std::vector<double> k(static_cast<std::size_t>(zernike_count(order) * count));
      kernel->functions(k.data(), order, mapping == DiscMapping::projected, theta.data(), phi.data(), count, count);
      for (long g = 0; g < count; ++g)
        for (int n = 0; n <= order; ++n)
          for (int m = -n; m <= n; m += 2) {
            const auto at = static_cast<std::size_t>(g);
            const double norm = std::sqrt((n + 1) / std::numbers::pi / (m == 0 ? 2 : 1));
            EXPECT_NEAR(norm * k[static_cast<std::size_t>(zernike_index(n, m) * count + g)],
                        zernike(n, m, {theta[at], phi[at]}, mapping), 2 * table_error * norm)
                << n << ' ' << m;
          }
    }
    std::vector<double> cosine(count), sine(count);
    kernel->double_angles(cosine.data(), sine.data(), phi.data(), count);
    for (std::size_t g = 0; g < count; ++g) {
      EXPECT_NEAR(cosine[g], std::cos(2 * phi[g]), 1e-15);
      EXPECT_NEAR(sine[g], std::sin(2 * phi[g]), 1e-15);
    }
  }
}

}  // namespace
}  // namespace mmbrdf
