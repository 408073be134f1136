// SPDX-License-Identifier: BSD-3-Clause
// Readings of many pixels to matrices, beside one at a time and beside sums in extended precision.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "given/cases.hpp"
#include "mmbrdf/polarimetry/reduction.hpp"
#include "polarimetry/kernel/reduction_kernels.hpp"

namespace mmbrdf {
namespace {

/// Random elliptical states and the pairs of them that are read.
Polarimeter random_instrument(std::size_t readings, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> uniform(0, 6.28);
  std::vector<double> azimuths;
  for (int k = 0; k < 12; ++k) azimuths.push_back(uniform(engine));
  Polarimeter result = ideal_polarimeter(1.8 + 0.1 * uniform(engine), azimuths);
  std::vector<StatePair> all;
  for (std::size_t k = 0; k < 144; ++k) all.push_back({k / 12, k % 12});
  std::ranges::shuffle(all, engine);
  all.resize(readings);
  return reading(result, all);
}

template <class Number>
std::vector<Number> random_readings(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<Number> uniform(-1, 1);
  std::vector<Number> result(count);
  for (Number& number : result) number = uniform(engine);
  return result;
}

template <class Number>
std::vector<Number> batch(const Reduction& reduction, const std::vector<Number>& readings, std::size_t n,
                          const MatricesOptions& options = {}) {
  std::vector<Number> result(readings.size() / n * 16);
  reduction.muellers(readings, std::span<Number>(result), options);
  return result;
}

/// NaN as NaN, whatever its bits.
template <class Number>
bool same(Number a, Number b) {
  return (std::isnan(a) && std::isnan(b)) || (a == b && std::signbit(a) == std::signbit(b));
}

std::vector<Polarimeter> instruments() {
  const std::vector<std::string> linear{"s", "p", "+45", "-45"}, six{"s", "p", "+45", "-45", "L", "R"}, one{"s"};
  std::vector<Polarimeter> result{ideal_polarimeter(linear, linear), ideal_polarimeter(six, six),
                                  ideal_polarimeter(one, one), ideal_polarimeter(six, linear)};
  for (const std::size_t n : {16U, 36U, 61U, 144U}) result.push_back(random_instrument(n, n));
  return result;
}

constexpr std::size_t some = 77;  // a multiple of no vector and of no block

TEST(ReductionBatch, HasTheBitsOfOnePixelAtATime) {
  for (const Polarimeter& p : instruments()) {
    const std::size_t n = p.readings();
    const Reduction reduction(p);
    for (const std::size_t pixels : {std::size_t{0}, std::size_t{1}, std::size_t{7}, some}) {
      const std::vector<double> readings = random_readings<double>(n * pixels, 1), all = batch(reduction, readings, n);
      for (std::size_t q = 0; q < pixels; ++q) {
        const Mueller m = reduction.mueller(std::span(readings).subspan(n * q, n));
        for (std::size_t e = 0; e < 16; ++e) EXPECT_TRUE(same(m.elements[e], all[16 * q + e])) << n << " " << q;
      }
    }
  }
}

TEST(ReductionBatch, InSinglePrecisionIsThatInDoublePrecisionRounded) {
  for (const Polarimeter& p : instruments()) {
    const std::size_t n = p.readings();
    const Reduction reduction(p);
    const std::vector<float> readings = random_readings<float>(n * some, 2), found = batch(reduction, readings, n);
    const std::vector<double> exact = batch(reduction, std::vector<double>(readings.begin(), readings.end()), n);
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_TRUE(same(found[i], static_cast<float>(exact[i])));
  }
}

TEST(ReductionBatch, DoesNotDependOnTheNumberOfThreads) {
  const Reduction reduction(random_instrument(16, 3));
  std::vector<double> readings = random_readings<double>(16 * 20011, 3);
  readings[16 * 9000] = std::numeric_limits<double>::quiet_NaN();
  const auto found = [&](int threads) {
    return batch(reduction, readings, 16, {.threads = threads, .refused = Refused::nan});
  };
  const std::vector<double> one = found(1);
  for (const int threads : {0, 2, 3, 7}) EXPECT_TRUE(std::ranges::equal(one, found(threads), same<double>)) << threads;
}

// The weights x_j from columns of the unit matrix; the promise of reduction.hpp for the sum of x_j B_j, and for the
// matrix whose readings they are: Σ |x_j B_j| for each of the roundings, those of the readings among them.
TEST(ReductionBatch, GivesTheMatrixOfItsReadingsWithinRoundingOfEachTerm) {
  for (const std::size_t n : {16U, 36U, 61U})
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      const Polarimeter p = random_instrument(n, 1000 * n + seed);
      const Reduction reduction(p);
      if (reduction.undetermined().any()) continue;
      Mueller m;
      const std::vector<double> elements = random_readings<double>(16, seed);
      std::ranges::copy(elements, m.elements.begin());
      std::vector<double> readings(n), unit(n * n), weights;
      for (std::size_t j = 0; j < n; ++j) {
        unit[j * n + j] = 1;
        long double b = 0;
        const auto [g, a] = p.pair(j);
        for (std::size_t e = 0; e < 16; ++e)
          b += static_cast<long double>(p.analyzer[a][e / 4]) * m.elements[e] * p.generator[g][e % 4];
        readings[j] = static_cast<double>(b);
      }
      weights = batch(reduction, unit, n);
      const Mueller found = reduction.mueller(readings);
      for (std::size_t e = 0; e < 16; ++e) {
        double bound = 0;
        for (std::size_t j = 0; j < n; ++j) bound += std::abs(weights[16 * j + e] * readings[j]);
        // One rounding more for the readings.
        EXPECT_LE(std::abs(found.elements[e] - m.elements[e]), 0x1p-53 * static_cast<double>(n + 3) * bound)
            << n << ", condition " << reduction.condition();
      }
    }
}

TEST(ReductionBatch, RefusesPixelsWithAReadingThatIsNotFinite) {
  const Reduction reduction(random_instrument(16, 5));
  const std::vector<float> good = random_readings<float>(16 * some, 5);
  const std::vector<float> expected = batch(reduction, good, 16);
  std::vector<float> readings = good, found(16 * some);
  readings[16 * 40 + 15] = std::numeric_limits<float>::infinity();
  readings[16 * 71] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(reduction.muellers(readings, std::span<float>(found), {.refused = Refused::nan}), 2U);
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_TRUE(i / 16 == 40 || i / 16 == 71 ? std::isnan(found[i]) : same(found[i], expected[i])) << i;
  EXPECT_EQ(message_of([&] { reduction.muellers(readings, std::span<float>(found)); }),
            "pixel 40, counted from 0: a reading is not finite (2 of 77 are refused)");
}

TEST(ReductionBatch, RefusesSizesThatAreNotThoseOfAsManyPixels) {
  const Reduction reduction(random_instrument(36, 6));
  std::vector<double> elements(32);
  EXPECT_EQ(message_of([&] { reduction.muellers(std::vector<double>(71), std::span<double>(elements)); }),
            "71 readings and 32 elements, the instrument has 36 readings of 16 elements");
  EXPECT_THROW(reduction.muellers(std::vector<double>(36), std::span<double>(elements)), std::invalid_argument);
  EXPECT_THROW(reduction.muellers(std::vector<double>(36), std::span<double>(elements).first(15)),
               std::invalid_argument);
  EXPECT_THROW(reduction.muellers(std::vector<double>(72), std::span<double>(elements), {.threads = -1}),
               std::invalid_argument);
}

// Elements of random sums: n roundings of the largest partial sum, with and without fused multiply-adds.
TEST(ReductionKernel, OfEveryInstructionSetAgreesWithTheSumInExtendedPrecision) {
  for (const std::size_t n : {1U, 3U, 16U, 36U, 61U})
    for (const std::size_t pixels : {1U, 2U, 3U, 8U, 77U}) {
      const std::vector<double> inverse = random_readings<double>(16 * n, 8);
      const std::vector<float> readings = random_readings<float>(n * pixels, 9);
      const std::vector<double> same_readings(readings.begin(), readings.end());
      for (const ReductionKernel* kernel : reduction_kernels()) {
        if (!kernel->runs_here()) continue;
        std::vector<double> found(16 * pixels), room(n * pixels);
        std::vector<float> single(16 * pixels);
        EXPECT_TRUE(kernel->run_double(inverse.data(), n, same_readings.data(), pixels, found.data()));
        EXPECT_TRUE(kernel->run_float(inverse.data(), n, readings.data(), pixels, single.data(), room.data()));
        for (std::size_t i = 0; i < found.size(); ++i) {
          long double sum = 0, size = 0;
          for (std::size_t j = 0; j < n; ++j) {
            const long double term = static_cast<long double>(inverse[16 * j + i % 16]) * readings[i / 16 * n + j];
            sum += term;
            size += std::abs(term);
          }
          EXPECT_LE(std::abs(found[i] - sum), static_cast<long double>(n + 1) * 0x1p-53L * size) << kernel->name;
          EXPECT_EQ(single[i], static_cast<float>(found[i])) << kernel->name;
        }
      }
    }
}

}  // namespace
}  // namespace mmbrdf
