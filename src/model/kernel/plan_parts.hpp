// SPDX-License-Identifier: BSD-3-Clause
/// Polynomials in which plans are written.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "model/kernel/plan.hpp"

namespace mmbrdf {

using Shares = std::vector<Plan::Share>;
using Radial = std::vector<double>;  ///< coefficients by powers of t

/// Q of R_n^k = ρ^k Q(t), t = 2ρ² − 1, k ≥ 0.
Radial radial_polynomial(int n, int k);

/// √((n+1)/π), which K_n^k has besides R and the azimuthal function; K_n^0 has another 1/√2.
inline double radial_norm(int n) { return std::sqrt((n + 1) / std::numbers::pi); }

/// A polynomial of c, s and p (kernel_isotropic.hpp), by their exponents.
using Polynomial = std::map<std::array<int, 3>, double>;
Polynomial operator*(const Polynomial& a, const Polynomial& b);
Polynomial operator*(double factor, const Polynomial& a);

/// a(t_i) b(t_r) + b(t_i) a(t_r)
Polynomial symmetric_product(const Radial& a, const Radial& b);

/// Re z^k, and Im z^k / e.
Polynomial real_power(int k);
Polynomial imaginary_power(int k);

/// Shares of a polynomial in the list of a symmetric function of some order that begins at `first`.
void add_symmetric(Shares& shares, int first, int order, const Polynomial& polynomial);

}  // namespace mmbrdf
