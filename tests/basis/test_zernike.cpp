// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/basis/zernike.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "given/cases.hpp"

using namespace mmbrdf;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr DiscMapping both_mappings[] = {DiscMapping::lambert, DiscMapping::projected};

#if defined(__SIZEOF_FLOAT128__)
__extension__ using Wide = __float128;
#else
using Wide = long double;  // 113 bits of mantissa on 64-bit ARM
#endif
constexpr bool wide_enough = sizeof(Wide) == 16;

Wide factorial(int n) {
  Wide product = 1;
  for (int i = 2; i <= n; ++i) product *= i;
  return product;
}

/// Eq. 5 with (−1)^s. The terms reach 1e15 at n = 40: 128 bits leave 1e-19, 64 bits nothing.
Wide radial_by_factorials(int n, int k, double rho) {
  Wide sum = 0;
  for (int s = 0; s <= (n - k) / 2; ++s) {
    Wide term = factorial(n - s) / (factorial(s) * factorial((n + k) / 2 - s) * factorial((n - k) / 2 - s));
    for (int i = 0; i < n - 2 * s; ++i) term *= rho;
    sum += s % 2 ? -term : term;
  }
  return sum;
}

struct Node {
  double x, weight;
};

/// Gauss and Legendre's nodes on [0, 1], by Newton.
std::vector<Node> gauss_legendre(int count) {
  std::vector<Node> nodes;
  for (int i = 0; i < count; ++i) {
    double x = std::cos(pi * (i + 0.75) / (count + 0.5)), slope = 1;
    for (int step = 0; step < 50; ++step) {
      double before = 1, p = x;
      for (int n = 2; n <= count; ++n) {
        const double next = ((2 * n - 1) * x * p - (n - 1) * before) / n;
        before = p;
        p = next;
      }
      slope = count * (x * p - before) / (x * x - 1);
      x -= p / slope;
    }
    nodes.push_back({(1 + x) / 2, 1 / ((1 - x * x) * slope * slope)});
  }
  return nodes;
}

/// ∫ K_a K_b weight(cos θ) dΩ over the hemisphere for all pairs. The integrand is a polynomial in cos θ of degree
/// 2 · order + 1 times a trigonometric one of degree 2 · order: with these nodes there is no error but rounding.
std::vector<double> inner_products(int order, DiscMapping mapping, const std::function<double(double)>& weight) {
  const auto count = static_cast<std::size_t>(zernike_count(order));
  const int azimuths = 2 * order + 1;
  std::vector<double> sums(count * count), values(count);
  for (const Node& node : gauss_legendre(order + 1))
    for (int i = 0; i < azimuths; ++i) {
      const Direction d{std::atan2(std::sqrt(1 - node.x * node.x), node.x), 2 * pi * i / azimuths};
      zernike_table(order, disc_point(d, mapping), values.data());
      for (std::size_t a = 0; a < count; ++a)
        for (std::size_t b = 0; b < count; ++b)
          sums[a * count + b] += values[a] * values[b] * weight(node.x) * node.weight * 2 * pi / azimuths;
    }
  return sums;
}

double largest_difference_from_diagonal(const std::vector<double>& matrix, double diagonal) {
  const auto size = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(matrix.size()))));
  double result = 0;
  for (std::size_t a = 0; a < size; ++a)
    for (std::size_t b = 0; b < size; ++b)
      result = std::max(result, std::abs(matrix[a * size + b] - (a == b ? diagonal : 0)));
  return result;
}

}  // namespace

TEST(Zernike, RadialPolynomialAgreesWithTheFactorialSumIn128Bits) {
  if (!wide_enough) GTEST_SKIP() << "skipped: no arithmetic with 113 bits of mantissa here";
  double worst = 0;
  for (int n = 0; n <= max_order; ++n)
    for (int k = n % 2; k <= n; k += 2)
      for (int step = 0; step <= 40; ++step) {
        const double rho = step / 40.0;
        worst = std::max(worst, std::abs(static_cast<double>(radial(n, k, rho) - radial_by_factorials(n, k, rho))));
      }
  EXPECT_LE(worst, radial_error);
}

TEST(Zernike, RadialPolynomialsOfLowOrderAreTheTextbookOnes) {
  const double rho = 0.75, u = rho * rho;
  EXPECT_EQ(radial(0, 0, rho), 1);
  EXPECT_EQ(radial(1, 1, rho), rho);
  EXPECT_NEAR(radial(2, 0, rho), 2 * u - 1, radial_error);
  EXPECT_NEAR(radial(3, 1, rho), (3 * u - 2) * rho, radial_error);
  EXPECT_NEAR(radial(4, 0, rho), (6 * u - 6) * u + 1, radial_error);
  EXPECT_NEAR(radial(4, 2, rho), (4 * u - 3) * u, radial_error);
}

TEST(Zernike, RadialPolynomialIsOneAtTheRim) {
  for (int n = 0; n <= max_order; ++n)
    for (int k = -n; k <= n; k += 2) EXPECT_EQ(radial(n, k, 1), 1);  // 1 · (1 + 1) − 1: nothing to round
}

TEST(Zernike, RadialPolynomialAtTheCentreIsPlusOrMinusOneForKZeroAndZeroElsewhere) {
  for (int n = 0; n <= max_order; ++n)
    for (int k = n % 2; k <= n; k += 2) EXPECT_EQ(radial(n, k, 0), k != 0 ? 0 : n % 4 == 0 ? 1 : -1);
}

TEST(Zernike, RadialPolynomialsOfOppositeAzimuthalOrderAreEqual) {
  for (int n = 0; n <= max_order; ++n)
    for (int k = n % 2; k <= n; k += 2) EXPECT_EQ(radial(n, -k, 0.6), radial(n, k, 0.6));
}

TEST(Zernike, RadialPolynomialIsZeroOutsideItsOrders) {
  EXPECT_EQ(radial(3, 5, 0.5), 0);
  EXPECT_EQ(radial(3, -5, 0.5), 0);
  EXPECT_EQ(radial(3, 2, 0.5), 0);
  EXPECT_EQ(radial(40, 41, 0.5), 0);
}

TEST(Zernike, RefusesOrdersAndRadiiOutsideTheirRanges) {
  EXPECT_EQ(message_of([] { radial(41, 1, 0.5); }), "n = 41, must be in 0...40");
  EXPECT_EQ(message_of([] { radial(-1, 1, 0.5); }), "n = -1, must be in 0...40");
  EXPECT_EQ(message_of([] { radial(2, 0, 1 + eps); }), "rho = 1.0000000000000002, must be in [0, 1]");
  EXPECT_EQ(message_of([] { radial(2, 0, -0.5); }), "rho = -0.5, must be in [0, 1]");
  EXPECT_THROW(radial(2, 0, std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
}

TEST(Zernike, RefusesDirectionsBelowTheSurfaceInBothMappings) {
  for (DiscMapping mapping : both_mappings) {
    EXPECT_EQ(message_of([&] { zernike(2, 0, {radians(100), 0}, mapping); }), "theta = 100 degrees, must be in 0...90");
    EXPECT_THROW(zernike(41, 1, {0.5, 0}, mapping), std::invalid_argument);
    EXPECT_THROW(zernike(2, 0, {-0.5, 0}, mapping), std::invalid_argument);
    EXPECT_THROW(zernike(2, 0, {std::numeric_limits<double>::quiet_NaN(), 0}, mapping), std::invalid_argument);
    EXPECT_NO_THROW(zernike(2, 0, {radians(90), 0}, mapping));
  }
}

TEST(Zernike, AzimuthalFunctionIsCosineForPositiveAndSineForNegativeOrder) {
  const double phi = 0.4, theta = radians(60), rho = std::numbers::sqrt2 * 0.5;  // √2 sin 30°
  const double scale = std::sqrt(4 / pi), error = 8 * eps;  // of a few multiplications of numbers up to 1.2
  EXPECT_NEAR(zernike(3, 3, {theta, phi}), scale * rho * rho * rho * std::cos(3 * phi), error);
  EXPECT_NEAR(zernike(3, -3, {theta, phi}), scale * rho * rho * rho * std::sin(3 * phi), error);
  EXPECT_NEAR(zernike(0, 0, {theta, phi}), std::sqrt(1 / (2 * pi)), error);
}

TEST(Zernike, FunctionsAreOrthonormalInSolidAngleForTheLambertMapping) {
  const int order = 12;
  const auto matrix = inner_products(order, DiscMapping::lambert, [](double) { return 1.0; });
  // A sum of 325 terms, each the product of two values below 2.1 with an error of table_error times 2.1.
  EXPECT_LE(largest_difference_from_diagonal(matrix, 1), 2 * 2.1 * 2.1 * table_error * 2 * pi);
}

TEST(Zernike, FunctionsAreOrthogonalWithNormOneHalfInProjectedSolidAngleForTheProjectedMapping) {
  const int order = 12;
  const auto matrix = inner_products(order, DiscMapping::projected, [](double cosine) { return cosine; });
  EXPECT_LE(largest_difference_from_diagonal(matrix, 0.5), 2 * 2.1 * 2.1 * table_error * pi);  // as above, over π sr
}

TEST(Zernike, TableHoldsTheSameValuesAsTheSingleFunctions) {
  std::array<double, zernike_count(max_order)> table;
  for (DiscMapping mapping : both_mappings)
    for (int i = 0; i <= 9; ++i)
      for (int j = -4; j <= 4; ++j) {
        const Direction d{radians(10 * i), 0.7 * j};
        zernike_table(max_order, disc_point(d, mapping), table.data());
        for (int n = 0; n <= max_order; ++n)
          for (int k = -n; k <= n; k += 2) {
            // The point of the disc is rounded by eps, which counts up to n² times at the rim (the slope of R_n^k).
            const double error = (table_error + radial_error + n * n * eps) * std::sqrt((n + 1) / pi);
            EXPECT_NEAR(table[static_cast<std::size_t>(zernike_index(n, k))], zernike(n, k, d, mapping), error);
          }
      }
}

TEST(Zernike, TableIsExactToItsErrorAgainst128Bits) {
  if (!wide_enough) GTEST_SKIP() << "skipped: no arithmetic with 113 bits of mantissa here";
  std::array<double, zernike_count(max_order)> table;
  for (int step = 0; step <= 20; ++step)
    for (bool diagonal : {false, true}) {  // else along x
      const double x = step / 20.0 * (diagonal ? 0.7 : 1), y = diagonal ? x : 0;
      const double rho = std::hypot(x, y), phi = std::atan2(y, x);
      zernike_table(max_order, {x, y}, table.data());
      for (int n = 0; n <= max_order; ++n)
        for (int k = n % 2; k <= n; k += 2) {
          const double scale = std::sqrt((n + 1) / pi), norm = k == 0 ? scale / std::numbers::sqrt2 : scale;
          const double value = norm * static_cast<double>(radial_by_factorials(n, k, rho)) * std::cos(k * phi);
          // Off the x axis rho itself is rounded, which counts up to n² times (the slope of R_n^k at the rim).
          const double error = (table_error + (diagonal ? n * n * eps : 0)) * scale;
          EXPECT_NEAR(table[static_cast<std::size_t>(zernike_index(n, k))], value, error);
        }
    }
}

TEST(Zernike, TableOfALowerOrderIsTheBeginningOfThatOfAHigherOne) {
  std::array<double, zernike_count(10)> high;
  zernike_table(10, {0.3, -0.4}, high.data());
  for (int order = 0; order < 10; ++order) {
    std::array<double, zernike_count(10)> low;
    zernike_table(order, {0.3, -0.4}, low.data());
    EXPECT_TRUE(std::equal(low.begin(), low.begin() + zernike_count(order), high.begin())) << order;
  }
}

TEST(Zernike, TablePositionsAreCountedWithoutGaps) {
  int next = 0;
  for (int n = 0; n <= max_order; ++n) {
    for (int k = -n; k <= n; k += 2) EXPECT_EQ(zernike_index(n, k), next++);
    EXPECT_EQ(zernike_count(n), next);
  }
}

TEST(DiscMapping, LambertGivesEqualAreasToEqualSolidAngles) {
  for (int degree = 0; degree <= 90; ++degree) {
    const DiscPoint p = disc_point(Direction{radians(degree), 0.3}, DiscMapping::lambert);
    EXPECT_NEAR(p.x * p.x + p.y * p.y, 1 - std::cos(radians(degree)), 4 * eps);  // ρ² = 1 − cos θ
  }
}

TEST(DiscMapping, ProjectedIsTheShadowOnTheSurface) {
  const Direction d{radians(40), radians(-110)};
  const Vector3 v = unit_vector(d);
  const DiscPoint p = disc_point(d, DiscMapping::projected);
  EXPECT_NEAR(p.x, v[0], 2 * eps);
  EXPECT_NEAR(p.y, v[1], 2 * eps);
}

TEST(DiscMapping, PutsGrazingDirectionsOnTheRim) {
  for (DiscMapping mapping : both_mappings) {
    const DiscPoint p = disc_point(Direction{radians(90), radians(90)}, mapping);
    EXPECT_NEAR(p.x, 0, 2 * eps);
    EXPECT_NEAR(p.y, 1, 2 * eps);
  }
}

TEST(DiscMapping, OfAVectorIsThatOfItsAngles) {
  for (DiscMapping mapping : both_mappings)
    for (int i = 0; i <= 18; ++i)
      for (int j = 0; j < 24; ++j) {
        const Direction d{radians(5 * i), radians(15 * j)};
        const DiscPoint from_angles = disc_point(d, mapping), from_vector = disc_point(unit_vector(d), mapping);
        EXPECT_NEAR(from_angles.x, from_vector.x, 4 * eps);  // of numbers up to 1, each rounded four times
        EXPECT_NEAR(from_angles.y, from_vector.y, 4 * eps);
      }
}
