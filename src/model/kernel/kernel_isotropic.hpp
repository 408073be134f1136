// SPDX-License-Identifier: BSD-3-Clause
/// The isotropic family up to orders 7, 4 as one straight line.
///
///   w = x + iy      point of the disc,  u = |w|²,  t = 2u − 1 in [−1, 1]: powers of t keep their digits, of u do not
///   s, p, d         t_i + t_r,  t_i t_r,  t_i − t_r
///   z = c + ie      w_i conj(w_r)
///
/// V_n^k is w^k (conj(w)^|k| for k < 0) times a polynomial of t. What is symmetric under exchange is a polynomial of s
/// and p, and Re z^k, Im z^k / e are polynomials of c and u_i u_r = (1 + s + p)/4; so 11, 44, Re v are polynomials of
/// c, s, p, and Im v, 14, 41 such polynomials times e.
#pragma once

#include "model/kernel/kernel_geometry.hpp"
#include "model/kernel/layouts.hpp"

namespace mmbrdf::MMBRDF_ISA {
namespace {

/// Monomials of s and p by total degree: s, p; s², sp, p²; s³, s²p, sp², p³.
template <class R>
struct Monomials {
  R s, p, ss, sp, pp, sss, ssp, spp, ppp;
  MMBRDF_INLINE Monomials(R sum, R product)
      : s(sum), p(product), ss(s * s), sp(s * p), pp(p * p), sss(ss * s), ssp(ss * p), spp(sp * p), ppp(pp * p) {}

  /// Coefficients first, first + 1, … with the monomials up to a degree.
  template <int degree, class C>
  MMBRDF_INLINE R sum(const C& a, int first) const {
    if constexpr (degree == 0) {
      return a(first);
    } else if constexpr (degree == 1) {
      return fma(a(first + 2), p, fma(a(first + 1), s, a(first)));
    } else if constexpr (degree == 2) {
      return fma(a(first + 5), pp, fma(a(first + 4), sp, fma(a(first + 3), ss, sum<1>(a, first))));
    } else {
      const R high = fma(a(first + 9), ppp, fma(a(first + 8), spp, fma(a(first + 7), ssp, a(first + 6) * sss)));
      return sum<2>(a, first) + high;
    }
  }
};

/// Σ_q c^q × polynomial of s and p, of degree at most (order − q)/2; coefficients by rising q.
template <int order, int q = 0, class R, class C>
MMBRDF_INLINE R symmetric(const C& a, int first, R c, const Monomials<R>& m) {
  constexpr int begin = symmetric_begin(order, q);
  if constexpr (q == order) {
    return a(first + begin);
  } else {
    const R higher = symmetric<order, q + 1>(a, first, c, m);
    return fma(higher, c, m.template sum<(order - q) / 2>(a, first + begin));
  }
}

/// Powers of t of both directions, for what is not symmetric.
template <class R>
struct Powers {
  R t_i, t_r, tt_i, tt_r, iir, rri;  // t, t², t_i² t_r, t_r² t_i
};

/// w_i^k w_r^l for k + l = 2, conj(w) for negative powers: k = 4, 3, 2, 1, 0, −1, −2.
template <class R>
struct SpinTwo {
  Complex<R> k4, k3, k2, k1, k0, k_1, k_2;
};

template <class R>
struct Exchanged {
  Complex<R> ir, ri;  // at (i, r) and at (r, i)
};

/// Σ_k q_k(t_i, t_r) w_i^k w_r^(2−k), and the same for i and r exchanged; coefficients by g_products.
template <class R, class C>
MMBRDF_INLINE Exchanged<R> spin_two(const C& a, int f, const Monomials<R>& m, R d, const Powers<R>& t,
                                    const SpinTwo<R>& w) {
  constexpr int k1 = g_products.begin(1, 1), k2 = g_products.begin(2, 0), k0 = g_products.begin(0, 2);
  constexpr int k3 = g_products.begin(3, -1), k_1 = g_products.begin(-1, 3), k4 = g_products.begin(4, -2);
  constexpr int k_2 = g_products.begin(-2, 4);
  const R even = m.template sum<1>(a, f + k1), odd = a(f + k1 + 3) * d;
  // One power of the direction with k or l = ±2, two of the one with 0: first is that with 2.
  const auto six = [&](int g, R t2, R t0, R tt0, R tt0_t2) {
    const R low = fma(a(g + 2), t0, fma(a(g + 1), t2, a(g)));
    return fma(a(g + 5), tt0_t2, fma(a(g + 4), tt0, fma(a(g + 3), m.p, low)));
  };
  const auto two = [&](int g, R x) { return fma(a(g + 1), x, a(g)); };
  Exchanged<R> g;
  g.ir = (even + odd) * w.k1;
  g.ri = (even - odd) * w.k1;
  g.ir = fma(six(f + k2, t.t_i, t.t_r, t.tt_r, t.rri), w.k2, g.ir);
  g.ri = fma(six(f + k2, t.t_r, t.t_i, t.tt_i, t.iir), w.k0, g.ri);
  g.ir = fma(six(f + k0, t.t_r, t.t_i, t.tt_i, t.iir), w.k0, g.ir);
  g.ri = fma(six(f + k0, t.t_i, t.t_r, t.tt_r, t.rri), w.k2, g.ri);
  g.ir = fma(two(f + k3, t.t_r), w.k3, g.ir);
  g.ri = fma(two(f + k3, t.t_i), w.k_1, g.ri);
  g.ir = fma(two(f + k_1, t.t_i), w.k_1, g.ir);
  g.ri = fma(two(f + k_1, t.t_r), w.k3, g.ri);
  g.ir = fma(two(f + k4, t.t_r), w.k4, g.ir);
  g.ri = fma(two(f + k4, t.t_i), w.k_2, g.ri);
  g.ir = fma(two(f + k_2, t.t_i), w.k_2, g.ir);
  g.ri = fma(two(f + k_2, t.t_r), w.k4, g.ri);
  return g;
}

/// u: k + l = 4, symmetric; coefficients by u_products.
template <class R, class C>
MMBRDF_INLINE Complex<R> spin_four(const C& a, int f, const Monomials<R>& m, const Powers<R>& t, Complex<R> ii,
                                   Complex<R> rr, Complex<R> ir) {
  constexpr int k4 = u_products.begin(4, 0), k3 = u_products.begin(3, 1), k2 = u_products.begin(2, 2);
  const auto alpha = [&](R x, R xx) { return fma(a(f + k4 + 2), xx, fma(a(f + k4 + 1), x, a(f + k4))); };
  const auto beta = [&](R x) { return fma(a(f + k3 + 1), x, a(f + k3)); };
  Complex<R> sum = ir * (m.template sum<1>(a, f + k2) * ir);
  sum = fma(ii, fma(alpha(t.t_r, t.tt_r), ii, beta(t.t_r) * ir), sum);
  return fma(rr, fma(alpha(t.t_i, t.tt_i), rr, beta(t.t_i) * ir), sum);
}

/// The matrix in the xy frame.
template <class R, class C>
MMBRDF_INLINE void isotropic(const C& a, R scale, const Products<R>& g2, R (&f)[16]) {
  using L = IsotropicLayout;
  const auto [t_i, t_r, z, ii, rr, ir] = g2;
  const R d = t_i - t_r;
  const Monomials<R> m(t_i + t_r, t_i * t_r);
  const Powers<R> t{t_i, t_r, t_i * t_i, t_r * t_r, m.p * t_i, m.p * t_r};
  const Complex<R> zz = square(z);
  const SpinTwo<R> w{ii * zz, ii * z, ii, ir, rr, times_conj(rr, z), times_conj(rr, zz)};

  const R f11 = scale * symmetric<7>(a, L::f11, z.re, m), minus = -f11;
  f[0] = f11;
  f[15] = f11 * symmetric<4>(a, L::m44, z.re, m);

  const R ef = z.im * f11;
  const R same = ef * symmetric<3>(a, L::m14, z.re, m), other = (ef * d) * fma(a(L::m14_d + 1), z.re, a(L::m14_d));
  f[3] = other + same;
  f[12] = other - same;

  const Exchanged<R> g = spin_two(a, L::g, m, d, t, w);
  f[1] = f11 * g.ir.re;
  f[2] = minus * g.ir.im;
  f[4] = f11 * g.ri.re;
  f[8] = f11 * g.ri.im;

  const Exchanged<R> h = spin_two(a, L::h, m, d, t, w);  // without its factor i
  f[13] = minus * h.ir.im;
  f[14] = minus * h.ir.re;
  f[7] = minus * h.ri.im;
  f[11] = f11 * h.ri.re;

  const Complex<R> u = spin_four(a, L::u, m, t, ii, rr, ir);
  const R v_re = symmetric<4>(a, L::v_re, z.re, m), v_im = z.im * symmetric<3>(a, L::v_im, z.re, m);
  f[5] = f11 * (u.re + v_re);
  f[10] = f11 * (u.re - v_re);
  f[9] = f11 * (u.im + v_im);
  f[6] = f11 * (v_im - u.im);
}

}  // namespace
}  // namespace mmbrdf::MMBRDF_ISA
