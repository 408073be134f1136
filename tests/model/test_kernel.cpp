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
#include <vector>

#include "given/cases.hpp"
#include "given/random_model.hpp"
#include "given/reference_sum.hpp"
#include "mmbrdf/model/batch.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "model/kernel/kernels.hpp"
#include "model/kernel/plan.hpp"

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

/// With the coefficients of all powers of the wavelength, or those of one wavelength.
template <class T>
struct Arranged {
  Plan plan;
  std::vector<T> coefficients;
  int powers = 0;
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
  KernelModel<T> model() const { return kernel_model<T>(plan, coefficients, powers, scale); }
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

TEST(Kernel, ListEndsWithOneThatRunsEverywhere) {
  EXPECT_STREQ(kernels().back()->name, "baseline");
  EXPECT_TRUE(kernels().back()->runs_here());
  EXPECT_TRUE(best_kernel().runs_here());
  for (const Kernel* kernel : kernels_that_run_here()) std::printf("runs here: %s\n", kernel->name);
}
