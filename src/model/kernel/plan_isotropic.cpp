// SPDX-License-Identifier: BSD-3-Clause
#include "model/kernel/plan_parts.hpp"

// How modes of the isotropic family become powers of t, s, p, d and c (kernel_isotropic.hpp).
#include <algorithm>
#include <cstdlib>

namespace mmbrdf {
namespace {

using L = IsotropicLayout;

int powers(const Radial& polynomial) { return static_cast<int>(polynomial.size()); }

Polynomial one() { return {{{0, 0, 0}, 1}}; }
Polynomial c() { return {{{1, 0, 0}, 1}}; }
Polynomial s() { return {{{0, 1, 0}, 1}}; }
Polynomial p() { return {{{0, 0, 1}, 1}}; }
Polynomial operator+(Polynomial a, const Polynomial& b) {
  for (const auto& [i, x] : b) a[i] += x;
  return a;
}

/// X_k = 2c X_{k−1} − u_i u_r X_{k−2}: Re z^k from 1, c; Im z^k / e from 0, 1.
Polynomial power_of_z(int k, const Polynomial& zeroth, const Polynomial& first) {
  if (k == 0) return zeroth;
  if (k == 1) return first;
  const Polynomial before = power_of_z(k - 2, zeroth, first);
  const Polynomial radii_before = 0.25 * (before + s() * before + p() * before);  // u_i u_r is (1 + s + p)/4
  return 2 * (c() * power_of_z(k - 1, zeroth, first)) + -1 * radii_before;
}

/// t_i^j + t_r^j
Polynomial power_sum(int j) {
  if (j == 0) return 2 * one();
  if (j == 1) return s();
  return s() * power_sum(j - 1) + -1 * (p() * power_sum(j - 2));
}

/// A mode with its radial polynomials.
struct Factors {
  int k, l;
  Radial a, b;
  double norm;
};

Shares shares_of_m14(const Factors& f) {
  const Polynomial angular = imaginary_power(f.k);
  Shares shares = symmetric_shares(L::m14, 3, (0.5 * f.norm) * (symmetric_product(f.a, f.b) * angular));
  // What changes sign under exchange is d times a polynomial of c. There are no powers of t but t itself, and for k
  // ≤ 2.
  const double odd = (f.a.size() > 1 ? f.a[1] * f.b[0] : 0) - (f.b.size() > 1 ? f.a[0] * f.b[1] : 0);
  if (odd != 0)
    for (const auto& [exponents, value] : angular)
      shares.push_back({L::m14_d + exponents[0], 0.5 * f.norm * odd * value});
  return shares;
}

/// Of g and h, which begin at `first`.
Shares shares_of_spin_two(int first, const Factors& f) {
  Shares shares;
  const int begin = first + g_products.begin(f.k, f.l);
  const auto add = [&](int at, double value) { shares.push_back({begin + at, f.norm * value}); };
  for (int i = 0; i < powers(f.a); ++i)
    for (int j = 0; j < powers(f.b); ++j) {
      const double value = f.a[size(i)] * f.b[size(j)];
      if (f.k == f.l)
        add_with_d(i, j, value, add, [&](double of_d) { add(monomial_count(1), of_d); });
      else
        add(f.k > f.l ? i + powers_of_t(f.k) * j : j + powers_of_t(f.l) * i, value);
    }
  return shares;
}

Shares shares_of_u(const Factors& f) {
  const int begin = L::u + u_products.begin(std::max(f.k, f.l), std::min(f.k, f.l));
  if (f.k == f.l) return symmetric_shares(begin, 2, f.norm * symmetric_product(f.a, f.b));
  const Radial& high = f.k > f.l ? f.a : f.b;  // of the direction with k = 4 or 3: a constant
  const Radial& low = f.k > f.l ? f.b : f.a;
  Shares shares;
  for (int j = 0; j < powers(low); ++j) shares.push_back({begin + j, f.norm * high[0] * low[size(j)]});
  return shares;
}

Shares shares_of_v(const Factors& f) {
  const int k = std::abs(f.k);
  const Polynomial radial = f.norm * symmetric_product(f.a, f.b);
  return symmetric_shares(L::v_im, 3, (f.k < 0 ? -1.0 : 1.0) * (radial * imaginary_power(k)),
                          symmetric_shares(L::v_re, 4, radial * real_power(k)));
}

}  // namespace

/// Q_n^k = Q_{n−1}^{k−1} + u Q_{n−1}^{k+1} − Q_{n−2}^k with u = (1 + t)/2, twice the
/// second term alone for k = 0.
Radial radial_polynomial(int n, int k) {
  if (k > n) return {0};
  if (n == 0) return {1};
  Radial sum(size((n - k) / 2) + 1);
  if (k > 0) {
    const Radial below = radial_polynomial(n - 1, k - 1);
    for (std::size_t a = 0; a < below.size(); ++a) sum[a] += below[a];
  }
  if (k < n) {
    const Radial above = radial_polynomial(n - 1, k + 1), before = radial_polynomial(n - 2, k);
    const double half = k == 0 ? 1 : 0.5;
    for (std::size_t a = 0; a < above.size(); ++a) {
      sum[a] += half * above[a];
      sum[a + 1] += half * above[a];
    }
    for (std::size_t a = 0; a < before.size(); ++a) sum[a] -= before[a];
  }
  return sum;
}

Polynomial operator*(const Polynomial& a, const Polynomial& b) {
  Polynomial result;
  for (const auto& [i, x] : a)
    for (const auto& [j, y] : b) result[{i[0] + j[0], i[1] + j[1], i[2] + j[2]}] += x * y;
  return result;
}
Polynomial operator*(double factor, const Polynomial& a) { return Polynomial{{{0, 0, 0}, factor}} * a; }

Polynomial real_power(int k) { return power_of_z(k, one(), c()); }
Polynomial imaginary_power(int k) { return power_of_z(k, {}, one()); }

Polynomial symmetric_product(const Radial& a, const Radial& b) {
  Polynomial sum;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) {
      Polynomial both = power_sum(std::abs(static_cast<int>(i) - static_cast<int>(j)));
      for (std::size_t common = std::min(i, j); common > 0; --common) both = p() * both;
      sum = sum + (a[i] * b[j]) * both;
    }
  return sum;
}

Shares symmetric_shares(int first, int order, const Polynomial& polynomial, Shares shares) {
  for (const auto& [exponents, value] : polynomial) {
    if (std::abs(value) < 1e-14) continue;  // terms that cancel
    const auto [power, of_s, of_p] = exponents;
    shares.push_back({first + symmetric_begin(order, power) + monomial(of_s, of_p), value});
  }
  return shares;
}

Shares isotropic_shares(const Mode& mode) {
  const Factors f{mode.k, mode.l, radial_polynomial(mode.n, std::abs(mode.k)),
                  radial_polynomial(mode.m, std::abs(mode.l)), radial_norm(mode.n) * radial_norm(mode.m)};
  switch (mode.function) {
    case Function::m11:
      return symmetric_shares(L::f11, 7, f.norm * (symmetric_product(f.a, f.b) * real_power(f.k)));
    case Function::m44:
      return symmetric_shares(L::m44, 4, f.norm * (symmetric_product(f.a, f.b) * real_power(f.k)));
    case Function::m14:
      return shares_of_m14(f);
    case Function::g:
      return shares_of_spin_two(L::g, f);
    case Function::h:
      return shares_of_spin_two(L::h, f);
    case Function::u:
      return shares_of_u(f);
    default:
      return shares_of_v(f);
  }
}

}  // namespace mmbrdf
