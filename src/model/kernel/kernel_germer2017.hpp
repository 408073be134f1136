// SPDX-License-Identifier: BSD-3-Clause
/// The published index sets up to orders 7, 4 as one straight line.
///
/// With x = a(i) b(r) and y = b(i) a(r), an element above the diagonal is a sum over S = x + y and one over D = x − y,
/// and its transpose is ± their difference: one fma for each coefficient gives both. Names t, s, p, d are those of
/// kernel_isotropic.hpp; C_k and S_k are the real and imaginary parts of w^k.
#pragma once

#include "model/kernel/kernel_isotropic.hpp"

namespace mmbrdf::MMBRDF_ISA {
namespace {

/// w … w⁴ of a direction, and powers of t.
template <class R>
struct Direction {
  R t, tt;
  Complex<R> w1, w2, w3, w4;

  MMBRDF_INLINE explicit Direction(Complex<R> w) : w1(w), w2(square(w)), w3(w2 * w), w4(square(w2)) {
    t = fma(w.re + w.re, w.re, fms(w.im + w.im, w.im, R(1)));
    tt = t * t;
  }
};

template <class R>
struct Both {
  R s, d;
};
/// a_i b_r ± b_i a_r
template <class R>
MMBRDF_INLINE Both<R> both(R a_i, R b_r, R b_i, R a_r) {
  const R x = a_i * b_r;
  return {fma(b_i, a_r, x), fnma(b_i, a_r, x)};
}
template <class R>
MMBRDF_INLINE Both<R> operator*(R factor, Both<R> a) {
  return {factor * a.s, factor * a.d};
}

/// 1, t, t² of one direction with f, t f of the other; f is C_2 or S_2.
template <class R>
struct SixPairs {
  Both<R> pair[6];
  MMBRDF_INLINE SixPairs(const Direction<R>& i, const Direction<R>& r, R p, R f_i, R f_r) {
    const R tf_i = i.t * f_i, tf_r = r.t * f_r;
    pair[0] = {f_r + f_i, f_r - f_i};
    pair[1] = both(i.t, f_r, f_i, r.t);
    pair[2] = both(i.tt, f_r, f_i, r.tt);
    pair[3] = {tf_r + tf_i, tf_r - tf_i};
    pair[4] = p * pair[0];
    pair[5] = p * pair[1];
  }
};

/// An element above the diagonal while it is summed.
template <class R, class C>
struct Element {
  const C& a;
  int at_s, at_d;  // first coefficients
  R s, d;

  MMBRDF_INLINE Element(const C& coefficients, int first, const ProductList& sums)
      : a(coefficients), at_s(first), at_d(first + sums.count()), s(R(0)), d(R(0)) {}
  MMBRDF_INLINE void add(int j_s, int j_d, const Both<R>& pair) {
    s = fma(a(at_s + j_s), pair.s, s);
    d = fma(a(at_d + j_d), pair.d, d);
  }
};

/// Elements 22, 33, 44, 12 and 34: products of cosines.
template <class R, class C>
struct Cosines {
  const C& a;
  const Monomials<R>& m;
  R m22, m33, m44;
  Element<R, C> m12, m34;
  using L = Germer2017Layout;

  MMBRDF_INLINE Cosines(const C& coefficients, const Monomials<R>& monomials)
      : a(coefficients),
        m(monomials),
        m22(m.template sum<2>(a, L::m22 + diagonal_22_33.begin(0, 0))),
        m33(m.template sum<2>(a, L::m33 + diagonal_22_33.begin(0, 0))),
        m44(m.template sum<2>(a, L::m44 + diagonal_44.begin(0, 0))),
        m12(coefficients, L::m12, cosine_sums),
        m34(coefficients, L::m34, cosine_sums) {}

  /// C_k(i) C_k(r) with polynomials of t.
  template <int k>
  MMBRDF_INLINE void add_equal(R product, R d) {
    constexpr int degree = powers_of_t(k) - 1, in_s = cosine_sums.begin(k, k), in_d = cosine_differences.begin(k, k);
    const auto add_above = [&](Element<R, C>& e) {
      e.s = fma(product, m.template sum<degree>(a, e.at_s + in_s), e.s);
      if constexpr (in_d >= 0) e.d = fma(a(e.at_d + in_d), product * d, e.d);
    };
    const auto add_diagonal = [&](R& e, int at) { e = fma(product, m.template sum<degree>(a, at), e); };
    add_above(m12);
    add_above(m34);
    add_diagonal(m22, L::m22 + diagonal_22_33.begin(k, k));
    add_diagonal(m33, L::m33 + diagonal_22_33.begin(k, k));
    add_diagonal(m44, L::m44 + diagonal_44.begin(k, k));
  }
  /// Pair number j of C_k with C_l.
  template <int k, int l>
  MMBRDF_INLINE void add(int j, const Both<R>& pair) {
    constexpr int s = cosine_sums.begin(k, l), d = cosine_differences.begin(k, l), at = diagonal_22_33.begin(k, l);
    m12.add(s + j, d + j, pair);
    m34.add(s + j, d + j, pair);
    if constexpr (at >= 0) {
      m22 = fma(a(L::m22 + at + j), pair.s, m22);
      m33 = fma(a(L::m33 + at + j), pair.s, m33);
    }
  }
  MMBRDF_INLINE void add_all(const Direction<R>& i, const Direction<R>& r, R d) {
    add_equal<1>(i.w1.re * r.w1.re, d);
    add_equal<2>(i.w2.re * r.w2.re, d);
    add_equal<3>(i.w3.re * r.w3.re, d);
    add_equal<4>(i.w4.re * r.w4.re, d);
    add<1, 3>(0, both(i.w1.re, r.w3.re, i.w3.re, r.w1.re));
    add<1, 3>(1, both(i.t * i.w1.re, r.w3.re, i.w3.re, r.t * r.w1.re));
    add<2, 4>(0, both(i.w2.re, r.w4.re, i.w4.re, r.w2.re));
    add<2, 4>(1, both(i.t * i.w2.re, r.w4.re, i.w4.re, r.t * r.w2.re));
    const SixPairs<R> six(i, r, m.p, i.w2.re, r.w2.re);
    for (int j = 0; j < 6; ++j) add<0, 2>(j, six.pair[j]);
    const R with_0 = r.w4.re + i.w4.re, with_t = fma(i.t, r.w4.re, i.w4.re * r.t),
            with_tt = fma(i.tt, r.w4.re, i.w4.re * r.tt);
    const auto with_4 = [&](int at, R sum) {
      return fma(a(at + 2), with_tt, fma(a(at + 1), with_t, fma(a(at), with_0, sum)));
    };
    m22 = with_4(L::m22 + diagonal_22_33.begin(0, 4), m22);
    m33 = with_4(L::m33 + diagonal_22_33.begin(0, 4), m33);
  }
};

/// Elements 14, 13, 24 and 23: cosines with sines.
template <class R, class C>
struct Sines {
  const Monomials<R>& m;
  Element<R, C> m14, m13, m24, m23;
  using L = Germer2017Layout;

  MMBRDF_INLINE Sines(const C& a, const Monomials<R>& monomials)
      : m(monomials),
        m14(a, L::m14, sines_14),
        m13(a, L::m13, sines_13_24),
        m24(a, L::m24, sines_13_24),
        m23(a, L::m23, sines_23) {}

  /// Pair number j of C_k with S_l, where the element has them.
  template <int k, int l>
  MMBRDF_INLINE void add(int j, const Both<R>& pair) {
    constexpr int in_14 = sines_14.begin(k, l), in_13 = sines_13_24.begin(k, l), in_23 = sines_23.begin(k, l);
    if constexpr (in_14 >= 0) m14.add(in_14 + j, in_14 + j, pair);
    if constexpr (in_13 >= 0) m13.add(in_13 + j, in_13 + j, pair);
    if constexpr (in_13 >= 0) m24.add(in_13 + j, in_13 + j, pair);
    if constexpr (in_23 >= 0) m23.add(in_23 + j, in_23 + j, pair);
  }
  /// C_k with S_k and polynomials of t, k = 1 and 2: pairs times 1, s, p; those of the other symmetry times d.
  template <int k>
  MMBRDF_INLINE void add_equal(const Both<R>& pair, R d) {
    add<k, k>(3, {pair.d * d, pair.s * d});
    constexpr int at = sines_14.begin(k, k);
    const auto polynomials = [&](Element<R, C>& e) {
      e.s = fma(pair.s, m.template sum<1>(e.a, e.at_s + at), e.s);
      e.d = fma(pair.d, m.template sum<1>(e.a, e.at_d + at), e.d);
    };
    polynomials(m14);
    polynomials(m13);
    polynomials(m24);
    polynomials(m23);
  }
  /// C_k with S_l and t times the first, and C_l with S_k and t times the second, k < l.
  template <int k, int l>
  MMBRDF_INLINE void add_different(R t_i, R t_r, Complex<R> low_i, Complex<R> low_r, Complex<R> high_i,
                                   Complex<R> high_r) {
    add<k, l>(0, both(low_i.re, high_r.im, high_i.im, low_r.re));
    add<k, l>(1, both(t_i * low_i.re, high_r.im, high_i.im, t_r * low_r.re));
    add<l, k>(0, both(high_i.re, low_r.im, low_i.im, high_r.re));
    add<l, k>(1, both(high_i.re, t_r * low_r.im, t_i * low_i.im, high_r.re));
  }
  MMBRDF_INLINE void add_all(const Direction<R>& i, const Direction<R>& r, R d) {
    add_equal<1>(both(i.w1.re, r.w1.im, i.w1.im, r.w1.re), d);
    add_equal<2>(both(i.w2.re, r.w2.im, i.w2.im, r.w2.re), d);
    add<3, 3>(0, both(i.w3.re, r.w3.im, i.w3.im, r.w3.re));
    add<4, 4>(0, both(i.w4.re, r.w4.im, i.w4.im, r.w4.re));
    add_different<1, 3>(i.t, r.t, i.w1, r.w1, i.w3, r.w3);
    add_different<2, 4>(i.t, r.t, i.w2, r.w2, i.w4, r.w4);
    const SixPairs<R> six(i, r, m.p, i.w2.im, r.w2.im);
    for (int j = 0; j < 6; ++j) add<0, 2>(j, six.pair[j]);
    add<0, 4>(0, {r.w4.im + i.w4.im, r.w4.im - i.w4.im});
    add<0, 4>(1, both(i.t, r.w4.im, i.w4.im, r.t));
    add<0, 4>(2, both(i.tt, r.w4.im, i.w4.im, r.tt));
  }
};

/// The matrix in the xy frame, as printed.
template <class R, class C>
MMBRDF_INLINE void germer2017(const C& a, R scale, Complex<R> w_i, Complex<R> w_r, R (&f)[16]) {
  const Direction<R> i(w_i), r(w_r);
  const R d = i.t - r.t;
  const Monomials<R> m(i.t + r.t, i.t * r.t);
  const R f11 = scale * symmetric<7>(a, Germer2017Layout::f11, fma(w_i.im, w_r.im, w_i.re * w_r.re), m);
  Cosines<R, C> c(a, m);
  c.add_all(i, r, d);
  f[0] = f11;
  f[5] = f11 * c.m22;
  f[10] = f11 * c.m33;
  f[15] = f11 * c.m44;
  put_exchanged<0, 1>(f11, c.m12.s, c.m12.d, f);
  put_exchanged<2, 3>(f11, c.m34.s, c.m34.d, f);
  Sines<R, C> s(a, m);
  s.add_all(i, r, d);
  put_exchanged<0, 3>(f11, s.m14.s, s.m14.d, f);
  put_exchanged<0, 2>(f11, s.m13.s, s.m13.d, f);
  put_exchanged<1, 3>(f11, s.m24.s, s.m24.d, f);
  put_exchanged<1, 2>(f11, s.m23.s, s.m23.d, f);
}

}  // namespace
}  // namespace mmbrdf::MMBRDF_ISA
