// SPDX-License-Identifier: BSD-3-Clause
#include "model/kernel/plan_germer2017.hpp"

// How modes of the published index sets become the coefficients of kernel_germer2017.hpp. An element above the diagonal
// is S-sum + D-sum; a product x = a(i) b(r) is (S + D)/2, the exchanged one (S − D)/2.
#include <algorithm>
#include <cstdlib>
#include <utility>

namespace mmbrdf {
namespace {

using L = Germer2017Layout;

/// K_n^k = norm × radial(t) × C_k or S_|k|.
struct Factor {
  int k;
  Radial radial;
  double norm;
  Factor(int n, int order)
      : k(order),
        radial(radial_polynomial(n, std::abs(order))),
        norm(radial_norm(n) * (order == 0 ? std::sqrt(0.5) : 1)) {}
};

/// The coefficients of an element above the diagonal.
class ElementShares {
 public:
  ElementShares(int first, int sums) : first_(first), sums_(sums) {}
  void add_s(int j, double value) { shares_.push_back({first_ + j, value}); }
  void add_d(int j, double value) { shares_.push_back({first_ + sums_ + j, value}); }
  /// value × x, or × the exchanged product; pairs j_s of S and j_d of D.
  void add(int j_s, int j_d, double value, bool exchanged) {
    add_s(j_s, value / 2);
    add_d(j_d, exchanged ? -value / 2 : value / 2);
  }
  Shares take() { return std::move(shares_); }

 private:
  int first_, sums_;
  Shares shares_;
};

/// Calls add(powers of t_i and t_r, value) for each term of the product of two radial polynomials.
template <class Add>
void for_each_term(const Factor& i, const Factor& r, Add add) {
  for (std::size_t a = 0; a < i.radial.size(); ++a)
    for (std::size_t b = 0; b < r.radial.size(); ++b)
      add(static_cast<int>(a), static_cast<int>(b), i.norm * r.norm * i.radial[a] * r.radial[b]);
}

/// Elements 12 and 34: cosines on both sides.
std::optional<Shares> cosine_shares(int first, const Factor& i, const Factor& r) {
  const int low = std::min(i.k, r.k), high = std::max(i.k, r.k);
  ElementShares shares(first, 18);
  if (low > 0 && low == high) {
    for_each_term(i, r, [&](int a, int b, double value) {
      const int j = low <= 2 ? 3 * (low - 1) : low + 3;
      if (a == b) return shares.add_s(j + 2 * a, value);
      shares.add_s(j + 1, value / 2);  // t_i is (s + d)/2, t_r is (s − d)/2
      shares.add_d(low - 1, a > b ? value / 2 : -value / 2);
    });
  } else if (low > 0 && high == low + 2) {
    for_each_term(i, r, [&](int a, int b, double value) {
      const int j = 6 + 2 * low + std::max(a, b);  // of the lower order; the higher is constant
      shares.add(j, j - 6, value, i.k == high);
    });
  } else if (low == 0 && high == 2) {
    for_each_term(i, r, [&](int a, int b, double value) {
      const bool exchanged = i.k == high;
      const int j = exchanged ? 3 * a + b : 3 * b + a;
      shares.add(12 + j, 6 + j, value, exchanged);
    });
  } else {
    return std::nullopt;
  }
  return shares.take();
}

/// |k| = |l| = 1 and 2: the pairs times 1, s, p, and those of the other symmetry times d.
void add_equal_orders(ElementShares& shares, int j, int a, int b, double value, bool exchanged) {
  if (a == b) return shares.add(j + 2 * a, j + 2 * a, value, exchanged);
  const double sign = exchanged ? -1 : 1, odd = a > b ? 1 : -1;
  shares.add_s(j + 1, value / 4);
  shares.add_d(j + 1, sign * value / 4);
  shares.add_d(j + 3, odd * value / 4);
  shares.add_s(j + 3, odd * sign * value / 4);
}

/// Elements 14, 13, 24, 23: a cosine and a sine. Exchanged is the product with the sine on the incident side.
std::optional<Shares> sine_shares(Function function, int first, const Factor& i, const Factor& r) {
  const bool exchanged = i.k < 0;
  if ((i.k < 0) == (r.k < 0)) return std::nullopt;
  const int of_cosine = exchanged ? r.k : i.k, of_sine = -(exchanged ? i.k : r.k);
  const int extra = function == Function::m13 || function == Function::m24 ? 2 : function == Function::m23 ? 4 : -1;
  ElementShares shares(first, function == Function::m14 ? 18 : function == Function::m23 ? 21 : 24);
  bool known = true;
  for_each_term(i, r, [&](int a, int b, double value) {
    const int with_cosine = exchanged ? b : a, with_sine = exchanged ? a : b;
    if (of_cosine == of_sine && of_sine <= 2)
      add_equal_orders(shares, 4 * (of_sine - 1), a, b, value, exchanged);
    else if (of_cosine == of_sine)
      shares.add(5 + of_sine, 5 + of_sine, value, exchanged);
    else if (of_cosine > 0 && of_sine == of_cosine + 2)
      shares.add(6 + 4 * of_cosine + with_cosine, 6 + 4 * of_cosine + with_cosine, value, exchanged);
    else if (of_cosine == of_sine + 2)
      shares.add(8 + 4 * of_sine + with_sine, 8 + 4 * of_sine + with_sine, value, exchanged);
    else if (of_cosine == 0 && of_sine == extra)
      shares.add(18 + 3 * with_sine + with_cosine, 18 + 3 * with_sine + with_cosine, value, exchanged);
    else
      known = false;
  });
  return known ? std::optional(shares.take()) : std::nullopt;
}

/// Elements 22, 33 and 44: symmetric products of cosines.
std::optional<Shares> diagonal_shares(int first, double weight, const Factor& i, const Factor& r) {
  const int low = std::min(i.k, r.k), high = std::max(i.k, r.k);
  const double norm = weight * i.norm * r.norm;
  const bool is_44 = first == L::m44;
  Shares shares;
  if (low < 0 || (is_44 && low != high)) return std::nullopt;
  if (low == high && low == 0) {
    add_symmetric(shares, first + (is_44 ? 8 : 12), 4, norm * symmetric_product(i.radial, r.radial));
  } else if (low == high) {
    add_symmetric(shares, first + (low <= 2 ? 3 * (low - 1) : low + 3), 2,
                  norm * symmetric_product(i.radial, r.radial));
  } else {
    const Radial& of_low = i.k == low ? i.radial : r.radial;  // the higher order is constant
    const Radial& of_high = i.k == low ? r.radial : i.radial;
    if (!(low > 0 && high == low + 2) && !(low == 0 && high == 4)) return std::nullopt;
    const int at = low == 0 ? 18 : 6 + 2 * low;
    for (std::size_t b = 0; b < of_low.size(); ++b)
      shares.push_back({first + at + static_cast<int>(b), norm * of_high[0] * of_low[b]});
  }
  return shares;
}

/// I_nm^k of Eq. 9 is weight × Σ K_n^±k(i) K_m^±k(r) and exchanged, see terms().
Shares f11_shares(const Mode& mode, double weight, const Factor& i, const Factor& r) {
  Shares shares;
  add_symmetric(shares, L::f11, 7,
                (weight * i.norm * r.norm) * (symmetric_product(i.radial, r.radial) * real_power(mode.k)));
  return shares;
}

}  // namespace

std::optional<Shares> germer2017_shares(const Mode& mode) {
  const Factor i(mode.n, mode.k), r(mode.m, mode.l);
  const double weight = terms(mode, Family::germer2017).front().weight;
  const double halved = mode.n == mode.m && mode.k == mode.l ? weight / 2 : weight;  // terms() adds equal products up
  switch (mode.function) {
    case Function::m11:
      return f11_shares(mode, mode.k > 0 ? (mode.n == mode.m ? weight / 2 : weight) : halved, i, r);
    case Function::m22:
      return diagonal_shares(L::m22, halved, i, r);
    case Function::m33:
      return diagonal_shares(L::m33, halved, i, r);
    case Function::m44:
      return diagonal_shares(L::m44, halved, i, r);
    case Function::m12:
    case Function::m34:
      if (mode.k < 0 || mode.l < 0) return std::nullopt;
      return cosine_shares(mode.function == Function::m12 ? L::m12 : L::m34, i, r);
    case Function::m14:
      return sine_shares(mode.function, L::m14, i, r);
    case Function::m13:
      return sine_shares(mode.function, L::m13, i, r);
    case Function::m24:
      return sine_shares(mode.function, L::m24, i, r);
    default:
      return sine_shares(mode.function, L::m23, i, r);
  }
}

}  // namespace mmbrdf
