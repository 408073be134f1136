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

  MMBRDF_INLINE Element(const C& coefficients, int first, int sums)
      : a(coefficients), at_s(first), at_d(first + sums), s(R(0)), d(R(0)) {}
  MMBRDF_INLINE void add(int j, const Both<R>& pair) { add(j, j, pair); }
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
        m22(m.sum2(a, L::m22 + 12)),
        m33(m.sum2(a, L::m33 + 12)),
        m44(m.sum2(a, L::m44 + 8)),
        m12(coefficients, L::m12, 18),
        m34(coefficients, L::m34, 18) {}

  /// C_k(i) C_k(r) with polynomials of t, k = 1 and 2.
  MMBRDF_INLINE void add_equal(int j, R product, R d) {
    const R odd = product * d;
    m12.s = fma(product, m.sum1(a, L::m12 + 3 * j), m12.s);
    m12.d = fma(a(L::m12 + 18 + j), odd, m12.d);
    m34.s = fma(product, m.sum1(a, L::m34 + 3 * j), m34.s);
    m34.d = fma(a(L::m34 + 18 + j), odd, m34.d);
    m22 = fma(product, m.sum1(a, L::m22 + 3 * j), m22);
    m33 = fma(product, m.sum1(a, L::m33 + 3 * j), m33);
    m44 = fma(product, m.sum1(a, L::m44 + 3 * j), m44);
  }
  /// The same without t, k = 3 and 4.
  MMBRDF_INLINE void add_equal(int j, R product) {
    m12.s = fma(a(L::m12 + j), product, m12.s);
    m34.s = fma(a(L::m34 + j), product, m34.s);
    m22 = fma(a(L::m22 + j), product, m22);
    m33 = fma(a(L::m33 + j), product, m33);
    m44 = fma(a(L::m44 + j), product, m44);
  }
  /// C_1 with C_3, C_2 with C_4.
  MMBRDF_INLINE void add_different(int j, const Both<R>& pair) {
    m12.add(j, j - 6, pair);
    m34.add(j, j - 6, pair);
    m22 = fma(a(L::m22 + j), pair.s, m22);
    m33 = fma(a(L::m33 + j), pair.s, m33);
  }
  MMBRDF_INLINE void add_all(const Direction<R>& i, const Direction<R>& r, R d) {
    add_equal(0, i.w1.re * r.w1.re, d);
    add_equal(1, i.w2.re * r.w2.re, d);
    add_equal(6, i.w3.re * r.w3.re);
    add_equal(7, i.w4.re * r.w4.re);
    add_different(8, both(i.w1.re, r.w3.re, i.w3.re, r.w1.re));
    add_different(9, both(i.t * i.w1.re, r.w3.re, i.w3.re, r.t * r.w1.re));
    add_different(10, both(i.w2.re, r.w4.re, i.w4.re, r.w2.re));
    add_different(11, both(i.t * i.w2.re, r.w4.re, i.w4.re, r.t * r.w2.re));
    const SixPairs<R> six(i, r, m.p, i.w2.re, r.w2.re);
    for (int j = 0; j < 6; ++j) {
      m12.add(12 + j, 6 + j, six.pair[j]);
      m34.add(12 + j, 6 + j, six.pair[j]);
    }
    const R with_0 = r.w4.re + i.w4.re, with_t = fma(i.t, r.w4.re, i.w4.re * r.t),
            with_tt = fma(i.tt, r.w4.re, i.w4.re * r.tt);
    m22 = fma(a(L::m22 + 20), with_tt, fma(a(L::m22 + 19), with_t, fma(a(L::m22 + 18), with_0, m22)));
    m33 = fma(a(L::m33 + 20), with_tt, fma(a(L::m33 + 19), with_t, fma(a(L::m33 + 18), with_0, m33)));
  }
};

/// Elements 14, 13, 24 and 23: cosines with sines.
template <class R, class C>
struct Sines {
  const Monomials<R>& m;
  Element<R, C> m14, m13, m24, m23;
  using L = Germer2017Layout;

  MMBRDF_INLINE Sines(const C& a, const Monomials<R>& monomials)
      : m(monomials), m14(a, L::m14, 18), m13(a, L::m13, 24), m24(a, L::m24, 24), m23(a, L::m23, 21) {}

  MMBRDF_INLINE void add(int j, const Both<R>& pair) {
    m14.add(j, pair);
    m13.add(j, pair);
    m24.add(j, pair);
    m23.add(j, pair);
  }
  /// C_k with S_k and polynomials of t, k = 1 and 2: pairs times 1, s, p; those of the other symmetry times d.
  MMBRDF_INLINE void add_equal(int j, const Both<R>& pair, R d) {
    const Both<R> odd{pair.d * d, pair.s * d};
    add(j + 3, odd);
    const auto polynomials = [&](Element<R, C>& e) {
      e.s = fma(pair.s, m.sum1(e.a, e.at_s + j), e.s);
      e.d = fma(pair.d, m.sum1(e.a, e.at_d + j), e.d);
    };
    polynomials(m14);
    polynomials(m13);
    polynomials(m24);
    polynomials(m23);
  }
  /// C_k with S_k and t times the first, and C_k' S_k' for the other way round.
  MMBRDF_INLINE void add_different(int j, R t_i, R t_r, Complex<R> low_i, Complex<R> low_r, Complex<R> high_i,
                                   Complex<R> high_r) {
    add(j, both(low_i.re, high_r.im, high_i.im, low_r.re));
    add(j + 1, both(t_i * low_i.re, high_r.im, high_i.im, t_r * low_r.re));
    add(j + 2, both(high_i.re, low_r.im, low_i.im, high_r.re));
    add(j + 3, both(high_i.re, t_r * low_r.im, t_i * low_i.im, high_r.re));
  }
  MMBRDF_INLINE void add_all(const Direction<R>& i, const Direction<R>& r, R d) {
    add_equal(0, both(i.w1.re, r.w1.im, i.w1.im, r.w1.re), d);
    add_equal(4, both(i.w2.re, r.w2.im, i.w2.im, r.w2.re), d);
    add(8, both(i.w3.re, r.w3.im, i.w3.im, r.w3.re));
    add(9, both(i.w4.re, r.w4.im, i.w4.im, r.w4.re));
    add_different(10, i.t, r.t, i.w1, r.w1, i.w3, r.w3);
    add_different(14, i.t, r.t, i.w2, r.w2, i.w4, r.w4);
    const SixPairs<R> six(i, r, m.p, i.w2.im, r.w2.im);
    for (int j = 0; j < 6; ++j) {
      m13.add(18 + j, six.pair[j]);
      m24.add(18 + j, six.pair[j]);
    }
    m23.add(18, {r.w4.im + i.w4.im, r.w4.im - i.w4.im});
    m23.add(19, both(i.t, r.w4.im, i.w4.im, r.t));
    m23.add(20, both(i.tt, r.w4.im, i.w4.im, r.tt));
  }
};

/// The matrix in the xy frame, as printed.
template <class R, class C>
MMBRDF_INLINE void germer2017(const C& a, R scale, Complex<R> w_i, Complex<R> w_r, R (&f)[16]) {
  const Direction<R> i(w_i), r(w_r);
  const R d = i.t - r.t;
  const Monomials<R> m(i.t + r.t, i.t * r.t);
  const R f11 = scale * symmetric7(a, Germer2017Layout::f11, fma(w_i.im, w_r.im, w_i.re * w_r.re), m);
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
