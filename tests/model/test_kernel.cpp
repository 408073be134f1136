// SPDX-License-Identifier: BSD-3-Clause
// The evaluation kernels, each one that this machine can run: against the textbook sum in extended precision, and
// against each other.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "given/cases.hpp"
#include "given/random_model.hpp"
#include "given/reference_sum.hpp"
#include "mmbrdf/model/batch.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/model/sampling.hpp"
#include "model/kernel/kernels.hpp"
#include "model/kernel/plan.hpp"
#include "model/sampling_map.hpp"

using namespace mmbrdf;

namespace {

constexpr double pi = std::numbers::pi;

std::vector<const Kernel*> kernels_that_run_here() {
  std::vector<const Kernel*> list;
  for (const Kernel* kernel : kernels())
    if (kernel->runs_here()) list.push_back(kernel);
  return list;
}

Direction any_direction() {
  const int kind = *rc::gen::inRange(0, 10);
  const double theta = kind == 8 ? 0 : kind == 9 ? radians(90) : between(0, pi / 2);
  return {theta, between(-2 * pi, 2 * pi)};
}

std::vector<Geometry> any_geometries() {
  std::vector<Geometry> geometries(static_cast<std::size_t>(*rc::gen::inRange(1, 40)));
  for (Geometry& g : geometries) g = {any_direction(), any_direction()};
  return geometries;
}

/// Columns of unit vectors.
template <class T>
struct Vectors {
  std::array<std::vector<T>, 6> columns;
  explicit Vectors(const std::vector<Geometry>& geometries) {
    for (const Geometry& g : geometries) {
      const Vector3 i = unit_vector(g.incident), r = unit_vector(g.reflected);
      for (std::size_t j = 0; j < 3; ++j) {
        columns[j].push_back(static_cast<T>(std::max(j == 2 ? 0 : -1.0, i[j])));
        columns[3 + j].push_back(static_cast<T>(std::max(j == 2 ? 0 : -1.0, r[j])));
      }
    }
  }
  KernelPoints<T> points() const {
    KernelPoints<T> result{};
    for (std::size_t j = 0; j < 6; ++j) result.column[j] = columns[j].data();
    result.stride = 1;
    return result;
  }
};

KernelPoints<double> angles(const std::vector<Geometry>& g) {
  KernelPoints<double> result{};
  result.angles = true;
  result.column[0] = &g[0].incident.theta;
  result.column[1] = &g[0].incident.phi;
  result.column[2] = &g[0].reflected.theta;
  result.column[3] = &g[0].reflected.phi;
  result.stride = 4;
  return result;
}

void run(const Kernel& kernel, const KernelModel<double>& model, const KernelPoints<double>& points,
         const KernelMatrices<double>& out, std::size_t count) {
  kernel.evaluate(model, points, out, count);
}
void run(const Kernel& kernel, const KernelModel<float>& model, const KernelPoints<float>& points,
         const KernelMatrices<float>& out, std::size_t count) {
  kernel.evaluate_single(model, points, out, count);
}

/// With the coefficients of one wavelength.
template <class T>
struct Arranged {
  Plan plan;
  std::vector<T> coefficients;
  T scale = 1;

  Arranged(const Model& model, double wavelength)
      : plan(mmbrdf::plan(model)), scale(static_cast<T>(model.reflectance.at(wavelength))) {
    const std::vector<double> all = by_powers(model);
    const std::size_t modes = all.size() / static_cast<std::size_t>(model.powers + 1);
    std::vector<double> folded(modes);
    for (std::size_t i = 0; i < all.size(); ++i)
      folded[i % modes] += all[i] * std::pow(wavelength, static_cast<double>(i / modes));
    for (const double a : plan.coefficients(folded)) coefficients.push_back(static_cast<T>(a));
  }
  KernelModel<T> model() const { return kernel_model<T>(plan, coefficients, 0, scale); }
};

/// Row by row.
template <class T>
std::vector<Mueller> matrices(const Kernel& kernel, const KernelModel<T>& model, const KernelPoints<T>& points,
                              std::size_t count) {
  std::vector<T> values(16 * count);
  KernelMatrices<T> out{{}, 16};
  for (std::size_t e = 0; e < 16; ++e) out.element[e] = values.data() + e;
  run(kernel, model, points, out, count);
  std::vector<Mueller> result(count);
  for (std::size_t i = 0; i < values.size(); ++i) result[i / 16].elements[i % 16] = static_cast<double>(values[i]);
  return result;
}

Mueller reference(const Model& model, double wavelength, const Geometry& g) {
  if (!turns(model)) return sum_in_extended_precision(model, wavelength, g);
  const Geometry at_zero{{g.incident.theta, 0}, {g.reflected.theta, g.reflected.phi - g.incident.phi}};
  return turned(sum_in_extended_precision(model, wavelength, at_zero), g.incident.phi);
}

/// Beside random ones all that are singular in a frame, and their neighbours.
std::vector<Geometry> singular_geometries() {
  const double phi = between(-pi, pi), other = between(-pi, pi), theta = between(0.05, 1.5);
  const double close = std::pow(10.0, -between(1, 7));  // the limit of parallel beams is 1e-8
  const Direction d{theta, phi}, normal{0, phi}, grazing{pi / 2, phi};
  std::vector<Geometry> result{{normal, d},
                               {d, normal},
                               {normal, {0, other}},
                               {d, d},
                               {d, {theta, phi + 2e-9}},
                               {d, {theta - 2e-9, phi}},
                               {grazing, grazing},
                               {grazing, {pi / 2, phi + pi}},
                               {{pi / 2 - 3e-9, phi}, {pi / 2, phi + pi - 2e-9}},
                               {d, {theta, phi + close}},
                               {d, {theta + close / 20, phi}},
                               {grazing, {pi / 2 - close, phi + pi}},
                               {grazing, {pi / 2, phi + pi + close}},
                               {d, {theta, phi + pi}},
                               {d, {theta, phi + pi / 2}}};
  for (const double tiny : {1e-9, 1e-30, 1e-130, 1e-250})
    for (const Direction& end : {d, normal, Direction{tiny, other}})
      result.insert(result.end(), {{{tiny, phi}, end}, {end, {tiny, phi}}});
  return result;
}

double sine_between(const Geometry& g) {
  const Vector3 i = unit_vector(g.incident), r = unit_vector(g.reflected);
  return std::hypot(i[1] * r[2] - i[2] * r[1], i[2] * r[0] - i[0] * r[2], i[0] * r[1] - i[1] * r[0]);
}

/// Geometries as the columns have them.
template <class T>
std::vector<Geometry> geometries_of(const Vectors<T>& vectors) {
  std::vector<Geometry> result;
  for (std::size_t q = 0; q < vectors.columns[0].size(); ++q) {
    const auto at = [&](std::size_t first) {
      return direction({vectors.columns[first][q], vectors.columns[first + 1][q], vectors.columns[first + 2][q]});
    };
    result.push_back({at(0), at(3)});
  }
  return result;
}

/// Of azimuths up to 3π and of vectors: it turns the plane of nearly parallel beams (change_frame in geometry.hpp).
constexpr double azimuth_rounding = 1e-14;

/// Every frame against change_frame() of xy. `rounding` is divided by the sine of the angle between the beams.
template <class T>
void expect_frames(const Kernel& kernel, KernelModel<T> model, const KernelPoints<T>& points,
                   const std::vector<Geometry>& geometries, double error, double rounding) {
  const std::vector<Mueller> in_xy = matrices(kernel, model, points, geometries.size());
  for (const auto& [frame, asked] :
       {std::pair(Frame::sp, KernelFrame::sp), std::pair(Frame::scattering_plane, KernelFrame::scattering_plane)}) {
    model.frame = asked;
    const std::vector<Mueller> found = matrices(kernel, model, points, geometries.size());
    for (std::size_t q = 0; q < geometries.size(); ++q) {
      const double sine = sine_between(geometries[q]);
      const bool is_plane = frame == Frame::scattering_plane && sine > parallel_limit / 2;
      const Mueller expected = change_frame(in_xy[q], geometries[q], Frame::xy, frame);
      EXPECT_LE(deviation_of_m11(found[q], expected), error + (is_plane ? rounding / sine : 0))
          << kernel.name << ' ' << to_string(frame) << ' ' << geometries[q].incident.theta << ' '
          << geometries[q].incident.phi << ' ' << geometries[q].reflected.theta << ' ' << geometries[q].reflected.phi
          << ' ' << sine;
      if (::testing::Test::HasFailure()) return;
    }
  }
}

struct Case {
  Model model;
  double wavelength;
};

Case any_case() {
  const Family family = *rc::gen::element(Family::isotropic, Family::germer2017, Family::anisotropic);
  const Orders orders = *rc::gen::element(Orders{7, 4}, Orders{7, 4}, Orders{3, 2}, Orders{0, 4}, Orders{6, 5});
  const int powers = *rc::gen::inRange(0, 3);
  Case result{random_model(family, orders, powers, *rc::gen::arbitrary<std::uint64_t>(),
                           *rc::gen::element(DiscMapping::lambert, DiscMapping::projected)),
              between(0.3, 1.2)};
  result.model = either_way(std::move(result.model));
  result.model.reflectance = {{0.4, 0.7}, {0.9, 0.5}};
  return result;
}

}  // namespace

// At the normal the azimuth of a vector is 0, and the published modes, turned, know the difference.
RC_GTEST_PROP(Kernel, OfEveryInstructionSetAgreesWithTheTextbookSum, ()) {
  const Case c = any_case();
  const std::vector<Geometry> geometries = any_geometries();
  const Arranged<double> arranged(c.model, c.wavelength);
  const Arranged<float> in_single(c.model, c.wavelength);
  const Vectors<double> vectors(geometries);
  const Vectors<float> short_vectors(geometries);
  for (const Kernel* kernel : kernels_that_run_here()) {
    const auto from_angles = matrices(*kernel, arranged.model(), angles(geometries), geometries.size());
    const auto from_vectors = matrices(*kernel, arranged.model(), vectors.points(), geometries.size());
    const auto from_short = matrices(*kernel, in_single.model(), short_vectors.points(), geometries.size());
    for (std::size_t q = 0; q < geometries.size(); ++q) {
      Geometry g = geometries[q];
      RC_ASSERT(deviation_of_m11(from_angles[q], reference(c.model, c.wavelength, g)) <= evaluation_error);
      if (g.incident.theta == 0) g.incident.phi = 0;
      if (g.incident.theta < 1e-3 && g.incident.theta > 0) continue;  // rounding of a vector turns the axes there
      const Mueller expected = reference(c.model, c.wavelength, g);
      RC_ASSERT(deviation_of_m11(from_vectors[q], expected) <= evaluation_error);
      RC_ASSERT(deviation_of_m11(from_short[q], expected) <= single_precision_error);
    }
  }
}

// A fused multiply-add rounds once wherever it is: AVX2 and AVX-512 have the same bits.
RC_GTEST_PROP(Kernel, WithFusedMultiplyAddsHasTheSameBitsForEveryWidth, ()) {
  const Case c = any_case();
  const std::vector<Geometry> geometries = any_geometries();
  const Arranged<double> arranged(c.model, c.wavelength);
  const Vectors<double> vectors(geometries);
  std::vector<const Kernel*> fused;
  for (const Kernel* kernel : kernels_that_run_here())
    if (std::strcmp(kernel->name, "baseline") != 0) fused.push_back(kernel);
  for (const Kernel* kernel : fused)
    for (const KernelPoints<double>& points : {angles(geometries), vectors.points()})
      RC_ASSERT(matrices(*kernel, arranged.model(), points, geometries.size()) ==
                matrices(*fused.front(), arranged.model(), points, geometries.size()));
}

RC_GTEST_PROP(Kernel, OfEveryInstructionSetFoldsAWavelengthAsItIsInEachPoint, ()) {
  const Case c = any_case();
  const std::vector<Geometry> geometries = any_geometries();
  const Plan plan = mmbrdf::plan(c.model);
  std::vector<double> all, folded(static_cast<std::size_t>(plan.count));
  const std::vector<double> of_modes = by_powers(c.model);
  const std::size_t modes = of_modes.size() / static_cast<std::size_t>(c.model.powers + 1);
  for (std::size_t first = 0; first < of_modes.size(); first += modes)
    for (const double a : plan.coefficients(std::span(of_modes).subspan(first, modes))) all.push_back(a);
  const std::vector<double> wavelengths(geometries.size(), c.wavelength), scales(geometries.size(), 0.7);
  KernelPoints<double> points = angles(geometries);
  for (const Kernel* kernel : kernels_that_run_here()) {
    const KernelModel<double> spectral = kernel_model<double>(plan, all, c.model.powers, 0.7);
    kernel->fold(spectral, c.wavelength, folded.data());
    const auto once = matrices(*kernel, kernel_model<double>(plan, folded, 0, 0.7), points, geometries.size());
    points.wavelength = wavelengths.data();
    points.scale = scales.data();
    RC_ASSERT(matrices(*kernel, spectral, points, geometries.size()) == once);
    points.wavelength = points.scale = nullptr;
  }
}

RC_GTEST_PROP(Kernel, OfEveryInstructionSetIsInTheFrameAskedFor, ()) {
  const Case c = any_case();
  std::vector<Geometry> geometries = any_geometries();
  const std::vector<Geometry> singular = singular_geometries();
  geometries.insert(geometries.begin() + *rc::gen::inRange<std::ptrdiff_t>(0, 5) % std::ssize(geometries),
                    singular.begin(), singular.end());
  const Arranged<double> arranged(c.model, c.wavelength);
  const Arranged<float> in_single(c.model, c.wavelength);
  const Vectors<double> vectors(geometries);
  const Vectors<float> short_vectors(geometries);
  for (const Kernel* kernel : kernels_that_run_here()) {
    expect_frames(*kernel, arranged.model(), angles(geometries), geometries, evaluation_error, azimuth_rounding);
    expect_frames(*kernel, arranged.model(), vectors.points(), geometries_of(vectors), evaluation_error,
                  azimuth_rounding);
    const bool fused = std::strcmp(kernel->name, "baseline") != 0;  // no digits of ⊥ are lost then
    expect_frames(*kernel, in_single.model(), short_vectors.points(), geometries_of(short_vectors),
                  single_precision_error, fused ? 0 : 1e-6);
  }
  RC_ASSERT(!::testing::Test::HasFailure());
}

RC_GTEST_PROP(Kernel, ForOneIncidentDirectionIsInTheFrameAskedFor, ()) {
  const Case c = any_case();
  const PreparedModel prepared = prepare(c.model, c.wavelength);
  for (Geometry g : singular_geometries()) {
    if (g.incident.theta > 0.1) g.incident.phi += *rc::gen::element(0.0, 2 * pi, 1e7);
    const PreparedIncidence at = prepared.at(g.incident);
    std::vector<Geometry> geometries = any_geometries();
    geometries.push_back(g);
    for (Geometry& one : geometries) one.incident = g.incident;
    const Vectors<double> vectors(geometries);
    std::vector<Geometry> of_vectors = geometries_of(vectors);
    for (Geometry& one : of_vectors) one.incident = g.incident;
    KernelPoints<double> from_angles = angles(geometries), from_vectors = vectors.points();
    for (std::size_t j = 0; j < 3; ++j) {
      from_angles.column[j] = angles(geometries).column[(2 + j) % 4];
      from_vectors.column[j] = vectors.points().column[3 + j];
    }
    // Azimuths of 1e7 are rounded to 1e-9.
    const double rounding = std::abs(g.incident.phi) > max_azimuth ? 1e-8 : azimuth_rounding;
    for (const Kernel* kernel : kernels_that_run_here()) {
      expect_frames(*kernel, Evaluation::model(at), from_angles, geometries, evaluation_error, rounding);
      expect_frames(*kernel, Evaluation::model(at), from_vectors, of_vectors, evaluation_error, rounding);
    }
  }
  RC_ASSERT(!::testing::Test::HasFailure());
}

/// Some incident directions, and points that are not next to steps of the tables.
SamplingBlock any_block(bool angles) {
  SamplingBlock block{};
  block.angles = angles;
  for (std::size_t q = 0; q < SamplingBlock::size; ++q) {
    const Direction incident = any_direction();
    const Vector3 vector = unit_vector(incident);
    const std::array<double, 3> from = angles ? std::array{incident.theta, incident.phi, 0.0} : vector;
    for (std::size_t c = 0; c < 3; ++c) block.incident[c][q] = from[c];
    for (auto& u : block.u) u[q] = (*rc::gen::inRange(0, 64) + between(0.1, 0.9)) / 64;
  }
  return block;
}

// 2e-15 and 4e-14 are seen.
RC_GTEST_PROP(Kernel, OfEveryInstructionSetDrawsTheSameDirections, ()) {
  static const SamplingMap isotropic(prepare(random_model(Family::isotropic, {4, 3}, 0, 3), 0.5));
  static const SamplingMap anisotropic(prepare(random_model(Family::anisotropic, {4, 3}, 0, 3), 0.5));
  const SamplingTables tables = (*rc::gen::arbitrary<bool>() ? isotropic : anisotropic).tables();
  const SamplingBlock asked = any_block(*rc::gen::arbitrary<bool>());
  SamplingBlock expected = asked;
  kernels().back()->draw(tables, expected, SamplingBlock::size);
  std::vector<SamplingBlock> fused;
  for (const Kernel* kernel : kernels_that_run_here()) {
    SamplingBlock found = asked;
    kernel->draw(tables, found, SamplingBlock::size);
    for (std::size_t q = 0; q < SamplingBlock::size; ++q) {
      for (std::size_t c = 0; c < 3; ++c) RC_ASSERT(std::abs(found.reflected[c][q] - expected.reflected[c][q]) < 1e-13);
      RC_ASSERT(std::abs(found.pdf[q] / expected.pdf[q] - 1) < 1e-12);
    }
    if (std::strcmp(kernel->name, "baseline") != 0) fused.push_back(found);
    kernel->pdf(tables, found);
    RC_ASSERT(std::abs(found.pdf[0] / expected.pdf[0] - 1) < sampling_error);
  }
  for (const SamplingBlock& block : fused) {
    RC_ASSERT(std::memcmp(block.reflected, fused.front().reflected, sizeof block.reflected) == 0);
    RC_ASSERT(std::memcmp(block.pdf, fused.front().pdf, sizeof block.pdf) == 0);
  }
}

// Weights of four tables sum to 1 but for rounding: without a bound some of a thousand azimuths are 4e-16 beyond.
TEST(Kernel, DrawsAzimuthsWithinHalfATurnOnEitherSide) {
  const SamplingMap anisotropic(prepare(random_model(Family::anisotropic, {4, 3}, 0, 3), 0.5));
  for (const Kernel* kernel : kernels_that_run_here())
    for (int n = 0; n < 200; ++n) {
      SamplingBlock block{};
      block.angles = true;
      for (std::size_t q = 0; q < SamplingBlock::size; ++q) {
        const double number = static_cast<double>(q) + 64 * n;
        block.incident[0][q] = number / 12800 * radians(90);
        block.incident[1][q] = 2.4 * number;
        block.u[0][q] = std::fmod(0.618 * number, 1);
        block.u[1][q] = n % 8 == 0 ? 0 : 1 - 0x1p-53;
      }
      kernel->draw(anisotropic.tables(), block, SamplingBlock::size);
      for (const double azimuth : block.reflected[1]) ASSERT_LE(std::abs(azimuth), pi) << kernel->name << ' ' << n;
    }
}

TEST(Kernel, ListEndsWithOneThatRunsEverywhere) {
  EXPECT_STREQ(kernels().back()->name, "baseline");
  EXPECT_TRUE(kernels().back()->runs_here());
  EXPECT_TRUE(best_kernel().runs_here());
  for (const Kernel* kernel : kernels_that_run_here()) std::printf("runs here: %s\n", kernel->name);
}
