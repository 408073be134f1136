// SPDX-License-Identifier: BSD-3-Clause
/// Gauss–Legendre quadrature of one variable.
#pragma once

#include <vector>

namespace mmbrdf {

/// A node of a quadrature rule.
struct Node {
  double x, weight;
};

/// Gauss–Legendre nodes on [0, 1], falling: exact for polynomials up to degree 2 count − 1.
/// Throws std::invalid_argument unless count ≥ 1.
std::vector<Node> gauss_legendre(int count);

}  // namespace mmbrdf
