// SPDX-License-Identifier: BSD-3-Clause
#include "numerics/gram.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <random>
#include <vector>

namespace mmbrdf {
namespace {

std::vector<double> random_numbers(std::size_t count, unsigned long seed) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  std::vector<double> result(count);
  for (double& x : result) x = any(engine);
  return result;
}

/// x a, each beginning so many numbers behind a line of the cache.
std::vector<double> product_at(std::size_t offset, const std::vector<double>& x, const std::vector<double>& a,
                               std::size_t rows, std::size_t n) {
  struct alignas(64) Line {
    double numbers[8];
  };
  std::vector<Line> lines((2 * rows * n + n * n) / 8 + 2);
  double* const y = lines.front().numbers + offset;
  double* const x_there = y + rows * n;
  double* const a_there = x_there + rows * n;
  std::ranges::copy(x, x_there);
  std::ranges::copy(a, a_there);
  gram_kernel().multiply(y, x_there, a_there, static_cast<long>(rows), static_cast<long>(n));
  return {y, y + rows * n};
}

// So draws of the same seed are the same whatever memory they are given.
TEST(Gram, ProductsHaveTheSameBitsWhereverTheirNumbersAre) {
  for (const std::size_t n : {1U, 3U, 5U, 6U, 7U, 30U})
    for (const std::size_t rows : {n, n + 1}) {
      const std::vector<double> x = random_numbers(rows * n, 1), a = random_numbers(n * n, 2);
      const std::vector<double> first = product_at(0, x, a, rows, n);
      for (std::size_t offset = 1; offset < 8; ++offset)
        EXPECT_EQ(product_at(offset, x, a, rows, n), first) << rows << " x " << n << " at " << offset;
    }
}

}  // namespace
}  // namespace mmbrdf
