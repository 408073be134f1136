// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/numerics/quadrature.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace mmbrdf {
namespace {

TEST(GaussLegendre, IsExactForPolynomialsUpToDegreeTwiceTheNodesLessOne) {
  for (const int count : {1, 2, 5, 16, 64}) {
    for (int degree = 0; degree < 2 * count; ++degree) {
      double sum = 0;
      for (const Node& node : gauss_legendre(count)) sum += node.weight * std::pow(node.x, degree);
      EXPECT_NEAR(sum, 1.0 / (degree + 1), 1e-14) << count << " nodes, degree " << degree;
    }
    double beyond = 0;
    for (const Node& node : gauss_legendre(count)) beyond += node.weight * std::pow(node.x, 2 * count);
    const double error = std::abs(beyond - 1.0 / (2 * count + 1));
    EXPECT_TRUE(count > 5 || error > 1e-8) << count << " nodes: " << error;
  }
  EXPECT_THROW(gauss_legendre(0), std::invalid_argument);
}

}  // namespace
}  // namespace mmbrdf
