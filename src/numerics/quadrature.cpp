// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/numerics/quadrature.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace mmbrdf {

std::vector<Node> gauss_legendre(int count) {
  if (count < 1) throw std::invalid_argument(std::to_string(count) + " nodes, at least 1 is needed");
  std::vector<Node> nodes;
  for (int i = 0; i < count; ++i) {  // Newton's method on the recurrence of the Legendre polynomials
    double x = std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5)), slope = 1;
    for (int step = 0; step < 100; ++step) {
      double p = 1, before = 0;
      for (int n = 1; n <= count; ++n) {
        const double next = ((2 * n - 1) * x * p - (n - 1) * before) / n;
        before = p;
        p = next;
      }
      slope = count * (x * p - before) / (x * x - 1);
      const double change = p / slope;
      x -= change;
      if (std::abs(change) < 1e-16) break;
    }
    nodes.push_back({(1 + x) / 2, 1 / ((1 - x * x) * slope * slope)});
  }
  return nodes;
}

}  // namespace mmbrdf
