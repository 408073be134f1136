// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <random>
#include <vector>

#include "fitting/kernel/influence_kernels.hpp"
#include "mmbrdf/fitting/leverage.hpp"
#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf {
namespace {

constexpr Basis small{Family::isotropic, {3, 2}};

std::vector<Geometry> some_geometries(std::size_t count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> polar(0, 1.3), azimuth(-3, 3);
  std::vector<Geometry> result;
  for (std::size_t g = 0; g < count; ++g)
    result.push_back({{polar(random), azimuth(random)}, {polar(random), azimuth(random)}});
  return result;
}

/// f of sets of 16 elements, f11 near 0.3.
std::vector<double> some_values(std::size_t sets, std::size_t geometries) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  std::vector<double> result(16 * sets * geometries);
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = (i % 16 == 0 ? 0.3 : 0) + 0.02 * normal(random);
  return result;
}

// Each within 1e-12 of the largest: what a triangle and a product round differently.
TEST(Influence, GivesTheCoefficientsOfEachFit) {
  const std::vector<Geometry> where = some_geometries(300);
  const std::vector<double> values = some_values(50, 300);
  const Influence influence(where, 0.532, small);
  std::vector<double> coefficients(50 * influence.coefficients()), variances(50 * influence.model().blocks.size());
  influence.fit(values, coefficients, variances);
  for (const std::size_t set : {0U, 17U, 49U}) {
    std::vector<Sample> samples(300);
    for (std::size_t g = 0; g < 300; ++g) {
      const double* const f = values.data() + 16 * (300 * set + g);
      samples[g].wavelength = 0.532;
      samples[g].geometry = where[g];
      samples[g].f11 = f[0];
      for (std::size_t e = 0; e < 16; ++e) samples[g].normalized.elements[e] = f[e] / f[0];
    }
    const FitResult alone = fit(samples, small);
    std::size_t next = set * influence.coefficients();
    for (std::size_t b = 0; b < alone.model.blocks.size(); ++b) {
      for (const double expected : alone.model.blocks[b].coefficients)
        EXPECT_NEAR(coefficients[next++], expected, 1e-12);
      EXPECT_NEAR(variances[set * alone.model.blocks.size() + b] / alone.solutions[b].variance(), 1, 1e-10);
    }
  }
}

TEST(Influence, OfSingleValuesThreadsAndNeighboursIsThatOfOneSet) {
  const std::vector<Geometry> where = some_geometries(200);
  const std::vector<double> values = some_values(100, 200);
  const std::vector<float> single(values.begin(), values.end());
  const std::vector<double> same(single.begin(), single.end());
  const Influence influence(where, 0.532, small);
  const std::size_t n = influence.coefficients(), blocks = influence.model().blocks.size();
  std::vector<double> a(100 * n), b(100 * n), c(n), v(100 * blocks), w(blocks);
  influence.fit(single, a, v, 3);
  influence.fit(same, b, v, 1);
  EXPECT_EQ(a, b);
  influence.fit(std::span(same).subspan(16 * 200 * 77, 16 * 200), c, w);
  EXPECT_TRUE(std::equal(c.begin(), c.end(), a.begin() + static_cast<std::ptrdiff_t>(77 * n)));
}

/// What a kernel makes of some geometries of all its sets.
struct Taken {
  std::vector<double> values, squares;
  std::array<double*, 16> to{}, square{};

  Taken(std::size_t count, std::initializer_list<std::size_t> left_out)
      : values(16 * count * influence_sets, 9), squares(16 * influence_sets, 0.5) {
    for (std::size_t e = 0; e < 16; ++e) {
      to[e] = std::ranges::find(left_out, e) == left_out.end() ? values.data() + e * count * influence_sets : nullptr;
      square[e] = squares.data() + e * influence_sets;
    }
  }
};

template <class Number>
auto taker(const InfluenceKernel& kernel) {
  if constexpr (sizeof(Number) == 4)
    return kernel.take_float;
  else
    return kernel.take_double;
}

/// Against one number after the other; f11 and rounding are those of every kernel but for the last digit of a product.
template <class Number>
void expect_takes(const InfluenceKernel& kernel, std::size_t each) {
  constexpr std::size_t count = 11;  // more than stand in a register, and not a multiple
  const std::vector<double> some = some_values(influence_sets, count);
  const std::vector<Number> f(some.begin(), some.end());
  std::array<const Number*, influence_sets> from;
  for (std::size_t s = 0; s < influence_sets; ++s) from[s] = f.data() + s * each * count;
  std::vector<double> weights(16 * count);
  for (std::size_t k = 0; k < weights.size(); ++k) weights[k] = k % 5 == 3 ? 0. : 1. / static_cast<double>(1 + k % 7);
  Taken taken(count, {3, 12});
  taker<Number>(kernel)(from.data(), each, count, weights.data(), taken.to.data(), taken.square.data());
  for (std::size_t e = 0; e < each; ++e)
    for (std::size_t s = 0; s < influence_sets; ++s) {
      double square = 0.5;
      for (std::size_t g = 0; g < count && taken.to[e]; ++g) {
        const Number* const set = from[s] + each * g;
        const double weight = weights[16 * g + e], f11 = static_cast<double>(set[0]);
        const double value = weight == 0 ? 0 : e == 0 ? f11 : static_cast<double>(set[e]) / f11;
        EXPECT_NEAR(taken.to[e][g * influence_sets + s], value, 1e-15) << kernel.name << ' ' << e << ' ' << s;
        square += weight * value * value;
      }
      EXPECT_NEAR(taken.squares[e * influence_sets + s], square, 1e-14) << kernel.name << ' ' << e << ' ' << s;
    }
}

TEST(Influence, OfEveryInstructionSetTakesMatricesAndF11AsOneNumberAfterTheOther) {
  for (const InfluenceKernel* kernel : influence_kernels()) {
    if (!kernel->runs_here()) continue;
    for (const std::size_t each : std::array<std::size_t, 2>{1, 16}) {
      expect_takes<float>(*kernel, each);
      expect_takes<double>(*kernel, each);
    }
  }
}

TEST(Influence, OfEveryInstructionSetMultipliesTilesByRowsOfSets) {
  constexpr std::size_t rows = 2 * influence_tile, count = 5;
  const std::vector<double> p = some_values(1, 3), values = some_values(influence_sets, 1);
  for (const InfluenceKernel* kernel : influence_kernels()) {
    if (!kernel->runs_here()) continue;
    std::vector<double> sums(rows * influence_sets, 0.25);
    kernel->multiply(p.data(), rows, count, values.data(), sums.data());
    for (std::size_t r = 0; r < rows; ++r)
      for (std::size_t s = 0; s < influence_sets; ++s) {
        double sum = 0.25;
        for (std::size_t g = 0; g < count; ++g)
          sum += p[(r / influence_tile * count + g) * influence_tile + r % influence_tile] *
                 values[g * influence_sets + s];
        EXPECT_NEAR(sums[r * influence_sets + s], sum, 1e-15) << kernel->name << ' ' << r << ' ' << s;
      }
  }
}

// 8 geometries are as many rows as f11 has coefficients; the other 15 elements have more rows in each block.
TEST(Influence, DoesNotKnowAVarianceWithoutDegreesOfFreedom) {
  const std::vector<Geometry> where = some_geometries(8);
  const Influence influence(where, 0.532, small);
  std::vector<double> a(2 * influence.coefficients()), v(2 * influence.model().blocks.size());
  influence.fit(some_values(2, 8), a, v);
  for (const double coefficient : a) EXPECT_TRUE(std::isfinite(coefficient));
  ASSERT_EQ(influence.model().blocks.front().coefficients.size(), 8U);
  EXPECT_TRUE(std::isnan(v[0]));
  EXPECT_GT(v[1], 0);
}

TEST(Influence, HasNoNumbersForSetsWithAValueThatCounts) {
  const std::vector<Geometry> where = some_geometries(200);
  std::vector<double> values = some_values(2, 200);
  values[16 * 5] = std::numeric_limits<double>::quiet_NaN();
  std::vector<Mueller> weights(200);
  for (std::size_t g = 0; g < 200; ++g) weights[g].elements.fill(g == 5 ? 0 : 1);
  const Influence plain(where, 0.532, small), weighted(where, 0.532, small, weights);
  const std::size_t n = plain.coefficients();
  std::vector<double> a(2 * n), v(2 * plain.model().blocks.size());
  plain.fit(values, a, v);
  for (std::size_t i = 0; i < 2 * n; ++i) EXPECT_EQ(std::isnan(a[i]), i < n);
  weighted.fit(values, a, v);
  for (const double coefficient : a) EXPECT_TRUE(std::isfinite(coefficient));
}

TEST(Influence, RefusesWhatItCannotFit) {
  EXPECT_THROW(Influence(some_geometries(300), 0.532, Basis{Family::germer2017, {3, 2}}), std::invalid_argument);
  EXPECT_THROW(Influence(some_geometries(3), 0.532, small), std::invalid_argument);
  const Influence influence(some_geometries(300), 0.532, small);
  std::vector<double> a(influence.coefficients()), v(influence.model().blocks.size());
  EXPECT_THROW(influence.fit(std::vector<double>(16 * 299), a, v), std::invalid_argument);
}

}  // namespace
}  // namespace mmbrdf
