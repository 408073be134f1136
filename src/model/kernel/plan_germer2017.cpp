// SPDX-License-Identifier: BSD-3-Clause
#include "model/kernel/plan_parts.hpp"

// How modes of the published index sets become the coefficients of kernel_germer2017.hpp. An element above the diagonal
// is S-sum + D-sum; a product x = a(i) b(r) is (S + D)/2, the exchanged one (S − D)/2.
#include <algorithm>
#include <cstdlib>
#include <utility>

namespace mmbrdf {
namespace {

using G = Germer2017Layout;

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
  ElementShares(int first, const ProductList& sums) : first_(first), sums_(sums.count()) {}
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
  const bool exchanged = i.k > r.k;
  const int low = std::min(i.k, r.k), high = std::max(i.k, r.k);
  const int in_s = cosine_sums.begin(low, high), in_d = cosine_differences.begin(low, high);
  if (in_s < 0) return std::nullopt;
  ElementShares shares(first, cosine_sums);
  for_each_term(i, r, [&](int a, int b, double value) {
    const int j = exchanged ? b + powers_of_t(low) * a : a + powers_of_t(low) * b;
    if (low != high) return shares.add(in_s + j, in_d + j, value, exchanged);
    const auto add_odd = [&](double odd) { shares.add_d(in_d, odd); };
    add_with_d(
        a, b, value, [&](int of, double even) { shares.add_s(in_s + of, even); }, add_odd);
  });
  return shares.take();
}

/// Elements 14, 13, 24, 23: a cosine and a sine. Exchanged is the product with the sine on the incident side.
std::optional<Shares> sine_shares(int first, const ProductList& list, const Factor& i, const Factor& r) {
  const bool exchanged = i.k < 0;
  const Factor &cosine = exchanged ? r : i, &sine = exchanged ? i : r;
  const int begin = list.begin(cosine.k, -sine.k);
  if (begin < 0) return std::nullopt;
  ElementShares shares(first, list);
  for_each_term(i, r, [&](int a, int b, double value) {
    const int of_cosine = exchanged ? b : a, of_sine = exchanged ? a : b;
    const auto add = [&](int j, double x) { shares.add(begin + j, begin + j, x, exchanged); };
    if (cosine.k != -sine.k) return add(of_cosine + powers_of_t(cosine.k) * of_sine, value);
    add_with_d(a, b, value, add, [&](double odd) {  // times d: what is S becomes D
      shares.add_d(begin + monomial_count(1), odd / 2);
      shares.add_s(begin + monomial_count(1), (exchanged ? -odd : odd) / 2);
    });
  });
  return shares.take();
}

/// Elements 22, 33 and 44: symmetric products of cosines.
std::optional<Shares> diagonal_shares(int first, const ProductList& list, double weight, const Factor& i,
                                      const Factor& r) {
  const Factor &low = i.k < r.k ? i : r, &high = i.k < r.k ? r : i;
  const double norm = weight * i.norm * r.norm;
  const int begin = list.begin(low.k, high.k);
  if (begin < 0) return std::nullopt;
  if (low.k == high.k) return symmetric_shares(first + begin, 4, norm * symmetric_product(i.radial, r.radial));
  Shares shares;
  for (std::size_t b = 0; b < low.radial.size(); ++b)  // the higher order is constant
    shares.push_back({first + begin + static_cast<int>(b), norm * high.radial[0] * low.radial[b]});
  return shares;
}

}  // namespace

std::optional<Shares> germer2017_shares(const Mode& mode) {
  const Factor i(mode.n, mode.k), r(mode.m, mode.l);
  double weight = terms(mode, Family::germer2017).front().weight;
  if (mode.n == mode.m && mode.k == mode.l) weight /= 2;  // terms() adds equal products up
  switch (mode.function) {
    case Function::m11:  // I_nm^k of Eq. 9 is weight × Σ K_n^±k(i) K_m^±k(r) and exchanged
      return symmetric_shares(
          G::f11, 7, (weight * i.norm * r.norm) * (symmetric_product(i.radial, r.radial) * real_power(mode.k)));
    case Function::m22:
      return diagonal_shares(G::m22, diagonal_22_33, weight, i, r);
    case Function::m33:
      return diagonal_shares(G::m33, diagonal_22_33, weight, i, r);
    case Function::m44:
      return diagonal_shares(G::m44, diagonal_44, weight, i, r);
    case Function::m12:
      return cosine_shares(G::m12, i, r);
    case Function::m34:
      return cosine_shares(G::m34, i, r);
    case Function::m14:
      return sine_shares(G::m14, sines_14, i, r);
    case Function::m13:
      return sine_shares(G::m13, sines_13_24, i, r);
    case Function::m24:
      return sine_shares(G::m24, sines_13_24, i, r);
    default:
      return sine_shares(G::m23, sines_23, i, r);
  }
}

}  // namespace mmbrdf
