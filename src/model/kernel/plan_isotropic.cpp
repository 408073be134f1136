// SPDX-License-Identifier: BSD-3-Clause
#include "model/kernel/plan_isotropic.hpp"

// How modes of the isotropic family become powers of t, s, p, d and c (kernel_isotropic.hpp).
#include <algorithm>
#include <cstdlib>

namespace mmbrdf {

namespace {

std::size_t size(int n) { return static_cast<std::size_t>(n); }

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
Polynomial operator+(Polynomial a, const Polynomial& b) {
  for (const auto& [i, x] : b) a[i] += x;
  return a;
}

namespace {

Polynomial monomial(int of_c, int of_s, int of_p) { return {{{of_c, of_s, of_p}, 1}}; }
const Polynomial& one() {
  static const Polynomial value = monomial(0, 0, 0);
  return value;
}
Polynomial times_c(const Polynomial& a) { return monomial(1, 0, 0) * a; }
Polynomial times_s(const Polynomial& a) { return monomial(0, 1, 0) * a; }
Polynomial times_p(const Polynomial& a) { return monomial(0, 0, 1) * a; }

/// X_k = 2c X_{k−1} − u_i u_r X_{k−2}: Re z^k from 1, c; Im z^k / e from 0, 1.
Polynomial power_of_z(int k, const Polynomial& zeroth, const Polynomial& first) {
  if (k == 0) return zeroth;
  if (k == 1) return first;
  const Polynomial before = power_of_z(k - 2, zeroth, first);
  const Polynomial radii_before = 0.25 * (before + times_s(before) + times_p(before));  // u_i u_r is (1 + s + p)/4
  return 2 * times_c(power_of_z(k - 1, zeroth, first)) + -1 * radii_before;
}
}  // namespace

Polynomial real_power(int k) { return power_of_z(k, one(), monomial(1, 0, 0)); }
Polynomial imaginary_power(int k) { return power_of_z(k, {}, one()); }

namespace {

/// t_i^j + t_r^j
Polynomial power_sum(int j) {
  if (j == 0) return 2 * one();
  if (j == 1) return monomial(0, 1, 0);
  return times_s(power_sum(j - 1)) + -1 * times_p(power_sum(j - 2));
}

}  // namespace

Polynomial symmetric_product(const Radial& a, const Radial& b) {
  Polynomial sum;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) {
      Polynomial both = power_sum(std::abs(static_cast<int>(i) - static_cast<int>(j)));
      for (std::size_t common = std::min(i, j); common > 0; --common) both = times_p(both);
      sum = sum + (a[i] * b[j]) * both;
    }
  return sum;
}

void add_symmetric(Shares& shares, int first, int order, const Polynomial& polynomial) {
  for (const auto& [exponents, value] : polynomial) {
    if (std::abs(value) < 1e-14) continue;  // terms that cancel
    const auto [power, of_s, of_p] = exponents;
    int at = first;
    for (int q = 0; q < power; ++q) at += ((order - q) / 2 + 1) * ((order - q) / 2 + 2) / 2;
    const int degree = of_s + of_p;
    shares.push_back({at + degree * (degree + 1) / 2 + of_p, value});
  }
}

namespace {

/// A mode with its radial polynomials.
struct Factors {
  int k, l;
  Radial a, b;
  double norm;
};

Shares shares_of_m14(const Factors& f) {
  Shares shares;
  const Polynomial angular = imaginary_power(f.k);
  add_symmetric(shares, IsotropicLayout::m14, 3, (0.5 * f.norm) * (symmetric_product(f.a, f.b) * angular));
  // What changes sign under exchange is d times a polynomial of c. There are no powers of t but t itself, and for k
  // ≤ 2.
  const double odd = (f.a.size() > 1 ? f.a[1] * f.b[0] : 0) - (f.b.size() > 1 ? f.a[0] * f.b[1] : 0);
  if (odd != 0)
    for (const auto& [exponents, value] : angular)
      shares.push_back({IsotropicLayout::m14 + 8 + exponents[0], 0.5 * f.norm * odd * value});
  return shares;
}

/// Of g and h, which begin at `first`.
Shares shares_of_spin_two(int first, const Factors& f) {
  Shares shares;
  const auto add = [&](int at, double value) { shares.push_back({first + at, f.norm * value}); };
  for (std::size_t i = 0; i < f.a.size(); ++i)
    for (std::size_t j = 0; j < f.b.size(); ++j) {
      const double value = f.a[i] * f.b[j];
      const int of_i = static_cast<int>(i), of_r = static_cast<int>(j);
      switch (f.k) {
        case 1:  // 1, s, p, d: t_i is (s + d)/2, t_r is (s − d)/2
          if (of_i == of_r) {
            add(of_i == 0 ? 0 : 2, value);
          } else {
            add(1, value / 2);
            add(3, of_i > of_r ? value / 2 : -value / 2);
          }
          break;
        case 2:
          add(4 + 2 * of_r + of_i, value);
          break;
        case 0:
          add(10 + 2 * of_i + of_r, value);
          break;
        case 3:
          add(16 + of_r, value);
          break;
        case -1:
          add(18 + of_i, value);
          break;
        case 4:
          add(20 + of_r, value);
          break;
        default:
          add(22 + of_i, value);
      }
    }
  return shares;
}

Shares shares_of_u(const Factors& f) {
  if (f.k == 2) {
    Shares shares;
    for (const auto& [exponents, value] : f.norm* symmetric_product(f.a, f.b))
      shares.push_back({IsotropicLayout::u + 5 + exponents[1] + 2 * exponents[2], value});
    return shares;
  }
  const Radial& high = f.k > f.l ? f.a : f.b;  // of the direction with k = 4 or 3: a constant
  const Radial& low = f.k > f.l ? f.b : f.a;
  const int first = IsotropicLayout::u + (std::max(f.k, f.l) == 4 ? 0 : 3);
  Shares shares;
  for (std::size_t j = 0; j < low.size(); ++j)
    shares.push_back({first + static_cast<int>(j), f.norm * high[0] * low[j]});
  return shares;
}

Shares shares_of_v(const Factors& f) {
  const int k = std::abs(f.k);
  const Polynomial radial = f.norm * symmetric_product(f.a, f.b);
  Shares shares;
  add_symmetric(shares, IsotropicLayout::v_re, 4, radial * real_power(k));
  add_symmetric(shares, IsotropicLayout::v_im, 3, (f.k < 0 ? -1.0 : 1.0) * (radial * imaginary_power(k)));
  return shares;
}

}  // namespace

Shares isotropic_shares(const Mode& mode) {
  const Factors f{mode.k, mode.l, radial_polynomial(mode.n, std::abs(mode.k)),
                  radial_polynomial(mode.m, std::abs(mode.l)), radial_norm(mode.n) * radial_norm(mode.m)};
  Shares shares;
  switch (mode.function) {
    case Function::m11:
      add_symmetric(shares, IsotropicLayout::f11, 7, f.norm * (symmetric_product(f.a, f.b) * real_power(f.k)));
      return shares;
    case Function::m44:
      add_symmetric(shares, IsotropicLayout::m44, 4, f.norm * (symmetric_product(f.a, f.b) * real_power(f.k)));
      return shares;
    case Function::m14:
      return shares_of_m14(f);
    case Function::g:
      return shares_of_spin_two(IsotropicLayout::g, f);
    case Function::h:
      return shares_of_spin_two(IsotropicLayout::h, f);
    case Function::u:
      return shares_of_u(f);
    default:
      return shares_of_v(f);
  }
}

}  // namespace mmbrdf
