// SPDX-License-Identifier: BSD-3-Clause
/// The plans of the straight lines, and the polynomials in which they are written.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <vector>

#include "model/kernel/layouts.hpp"
#include "model/kernel/plan.hpp"

namespace mmbrdf {

inline std::size_t size(int n) { return static_cast<std::size_t>(n); }

using Shares = std::vector<Plan::Share>;

/// What a mode gives to the coefficients of Form::isotropic, or of Form::germer2017: nothing if that form does not have
/// the mode. Its orders must be within 7, 4.
Shares isotropic_shares(const Mode& mode);
std::optional<Shares> germer2017_shares(const Mode& mode);

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

/// Adds those of a polynomial among the coefficients of a symmetric function of some order, which begin at `first`.
Shares symmetric_shares(int first, int order, const Polynomial& polynomial, Shares shares = {});

/// value × t_i^a t_r^b, a, b ≤ 1, as shares of the monomials 1, s, p (number, value) and of d (value).
template <class Even, class Odd>
void add_with_d(int a, int b, double value, Even add_even, Odd add_odd) {
  if (a == b) return add_even(monomial(0, a), value);
  add_even(monomial(1, 0), value / 2);  // t_i is (s + d)/2, t_r is (s − d)/2
  add_odd(a > b ? value / 2 : -value / 2);
}

}  // namespace mmbrdf
