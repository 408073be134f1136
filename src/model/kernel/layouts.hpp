// SPDX-License-Identifier: BSD-3-Clause
/// Where the coefficients of the straight lines are: for those who write them (plan_*.cpp) and who read them
/// (kernel_*.hpp). Internal linkage and nothing of the standard library, like pack.hpp.
///
/// All follows from the orders, 7 of f11 and 4 of all else. R_n^k is ρ^k times a polynomial of t of degree (n − k)/2:
///   powers_of_t      of a function of azimuthal order k; those of one direction follow each other
///   product          of functions of orders k, l of the two directions: each power of one with each of the other
///   equal, odd       of two functions of order k: what is symmetric under exchange, a polynomial of s and p, and the
///                    rest, such a polynomial times d
///   symmetric_count  of Σ_q c^q × polynomial of s and p of degree (order − q)/2, by rising q
/// Names t, s, p, d, c are those of kernel_isotropic.hpp.
#pragma once

namespace mmbrdf {
namespace {

constexpr int powers_of_t(int k, int order = 4) { return (order - (k < 0 ? -k : k)) / 2 + 1; }

/// Monomials of s and p up to a degree: 1; s, p; s², sp, p²; … And where s^a p^b is among them.
constexpr int monomial_count(int degree) { return (degree + 1) * (degree + 2) / 2; }
constexpr int monomial(int a, int b) { return monomial_count(a + b - 1) + b; }

/// Where the polynomial with c^q begins.
constexpr int symmetric_begin(int order, int q) {
  int begin = 0;
  for (int lower = 0; lower < q; ++lower) begin += monomial_count((order - lower) / 2);
  return begin;
}
constexpr int symmetric_count(int order) { return symmetric_begin(order, order + 1); }

/// `count` coefficients of functions of azimuthal orders k and l.
struct OrderPair {
  int k, l, count;
};
constexpr OrderPair product(int k, int l) { return {k, l, powers_of_t(k) * powers_of_t(l)}; }
constexpr OrderPair equal(int k) { return {k, k, monomial_count(powers_of_t(k) - 1)}; }
constexpr OrderPair odd(int k) { return {k, k, product(k, k).count - equal(k).count}; }

/// Products that follow each other.
struct ProductList {
  OrderPair products[9];
  /// Where those of k, l begin; −1 if there are none.
  constexpr int begin(int k, int l) const {
    int at = 0;
    for (const OrderPair& of : products) {
      if (of.k == k && of.l == l && of.count > 0) return at;
      at += of.count;
    }
    return -1;
  }
  constexpr int count() const {
    int sum = 0;
    for (const OrderPair& of : products) sum += of.count;
    return sum;
  }
};

/// w_i^k w_r^l of the isotropic family: k + l = 2 of g and h, 4 of u. The powers of the higher order run faster; those of
/// k = l = 1 are 1, s, p, d.
constexpr ProductList g_products{
    {product(1, 1), product(2, 0), product(0, 2), product(3, -1), product(-1, 3), product(4, -2), product(-2, 4)}};
constexpr ProductList u_products{{product(4, 0), product(3, 1), equal(2)}};

struct IsotropicLayout {
  static constexpr int f11 = 0, m44 = f11 + symmetric_count(7), m14 = m44 + symmetric_count(4);
  static constexpr int m14_d = m14 + symmetric_count(3);  // d times 1, c
  static constexpr int g = m14_d + 2, h = g + g_products.count(), u = h + g_products.count();
  static constexpr int v_re = u + u_products.count(), v_im = v_re + symmetric_count(4);
  static constexpr int count = v_im + symmetric_count(3);
};
static_assert(IsotropicLayout::count == 142);  // of modes, too

/// Products of the published index sets, by |k|, |l|; of sines the cosine is first. The powers of the first run faster.
/// Elements above the diagonal have a list for their sums over S, then one for those over D: of sines the same, where
/// k = l ≤ 2 has 1, s, p and the pair of the other symmetry times d; of cosines only d for k = l.
constexpr ProductList cosine_sums{
    {equal(1), equal(2), equal(3), equal(4), product(1, 3), product(2, 4), product(0, 2)}};
constexpr ProductList cosine_differences{{odd(1), odd(2), product(1, 3), product(2, 4), product(0, 2)}};
constexpr ProductList diagonal_22_33{
    {equal(1), equal(2), equal(3), equal(4), product(1, 3), product(2, 4), equal(0), product(0, 4)}};
constexpr ProductList diagonal_44{{equal(1), equal(2), equal(3), equal(4), equal(0)}};
constexpr ProductList sines(const OrderPair& last) {
  return {{product(1, 1), product(2, 2), product(3, 3), product(4, 4), product(1, 3), product(3, 1), product(2, 4),
           product(4, 2), last}};
}
constexpr ProductList sines_14 = sines({}), sines_13_24 = sines(product(0, 2)), sines_23 = sines(product(0, 4));

struct Germer2017Layout {
  static constexpr int cosines = cosine_sums.count() + cosine_differences.count();
  static constexpr int f11 = 0, m12 = f11 + symmetric_count(7), m34 = m12 + cosines, m14 = m34 + cosines;
  static constexpr int m13 = m14 + 2 * sines_14.count(), m24 = m13 + 2 * sines_13_24.count();
  static constexpr int m23 = m24 + 2 * sines_13_24.count(), m22 = m23 + 2 * sines_23.count();
  static constexpr int m33 = m22 + diagonal_22_33.count(), m44 = m33 + diagonal_22_33.count();
  static constexpr int count = m44 + diagonal_44.count();
};
static_assert(Germer2017Layout::count == 330);  // of modes, too

/// Real or imaginary parts of w^k of one direction, by rising k, with their powers of t.
struct HarmonicList {
  int begin[9];  ///< of each k; of order + 1: how many coefficients there are
};
constexpr HarmonicList harmonics(int order, int lowest) {
  HarmonicList list{};
  for (int k = lowest; k <= order; ++k) list.begin[k + 1] = list.begin[k] + powers_of_t(k, order);
  return list;
}
constexpr HarmonicList f11_cosines = harmonics(7, 0), even_cosines = harmonics(4, 0), odd_sines = harmonics(4, 1);

/// One incident direction at phi_i = 0: elements even in phi_r, then odd ones.
struct PlaneLayout {
  static constexpr int even = even_cosines.begin[5], odd = odd_sines.begin[5];
  static constexpr int f11 = 0, m12 = f11 + f11_cosines.begin[8], m21 = m12 + even, m34 = m21 + even;
  static constexpr int m43 = m34 + even, m44 = m43 + even, u_re = m44 + even, v_re = u_re + even;
  static constexpr int m13 = v_re + even, m31 = m13 + odd, m14 = m31 + odd, m41 = m14 + odd, m24 = m41 + odd;
  static constexpr int m42 = m24 + odd, u_im = m42 + odd, v_im = u_im + odd, count = v_im + odd;
};
static_assert(PlaneLayout::count == 131);

}  // namespace
}  // namespace mmbrdf
