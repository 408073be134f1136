// SPDX-License-Identifier: BSD-3-Clause
/// Parts of arrangement(): for arrangement*.cpp alone.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <vector>

#include "model/kernel/kernels.hpp"

namespace mmbrdf {

using Shares = std::vector<Arrangement::Share>;
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

/// What a mode gives to the coefficients of Form::isotropic. Its orders must be within 7, 4.
Shares isotropic_shares(const Mode& mode);

/// The same for Form::germer2017; nothing if that form does not have the mode.
std::optional<Shares> germer2017_shares(const Mode& mode);

/// K without its norm is what Form::pairs and Form::functions have; the norm by the position in the table.
double table_norm(int index);

}  // namespace mmbrdf
