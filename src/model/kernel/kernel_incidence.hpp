// SPDX-License-Identifier: BSD-3-Clause
/// One incident direction: what is left are functions of the reflected one.
#pragma once

#include "model/kernel/kernel_pairs.hpp"
#include "model/kernel/layouts.hpp"

namespace mmbrdf::MMBRDF_ISA {
namespace {

/// cos kφ and sin kφ parts of one direction up to order 4: w^k times 1, t, t².
template <class R>
struct Harmonics {
  R t, tt;
  Complex<R> w, wt, ww, wwt, www, wwww;

  MMBRDF_INLINE explicit Harmonics(Complex<R> point) : w(point) {
    ww = square(w);
    t = fma(w.re + w.re, w.re, fms(w.im + w.im, w.im, R(1)));
    tt = t * t;
    wt = t * w;
    wwt = t * ww;
    www = ww * w;
    wwww = square(ww);
  }
  /// Coefficients by k, then powers of t.
  template <class C>
  MMBRDF_INLINE R cosines(const C& a, int first) const {
    const auto of = [&](int k, int power) { return a(first + even_cosines.begin[k] + power); };
    const R low = fma(of(0, 2), tt, fma(of(0, 1), t, of(0, 0)));
    const R middle = fma(of(2, 0), ww.re, fma(of(1, 1), wt.re, of(1, 0) * w.re));
    const R high = fma(of(4, 0), wwww.re, fma(of(3, 0), www.re, of(2, 1) * wwt.re));
    return finished(low + (middle + high));
  }
  template <class C>
  MMBRDF_INLINE R sines(const C& a, int first) const {
    const auto of = [&](int k, int power) { return a(first + odd_sines.begin[k] + power); };
    const R low = fma(of(2, 0), ww.im, fma(of(1, 1), wt.im, of(1, 0) * w.im));
    return finished(low + fma(of(4, 0), wwww.im, fma(of(3, 0), www.im, of(2, 1) * wwt.im)));
  }
  template <class C>
  MMBRDF_INLINE R f11(const C& a, int first) const {
    const auto of = [&](int k, int power) { return a(first + f11_cosines.begin[k] + power); };
    const auto cubic = [&](int k) { return fma(fma(of(k, 3), t, of(k, 2)), tt, fma(of(k, 1), t, of(k, 0))); };
    const auto quadratic = [&](int k) { return fma(of(k, 2), tt, fma(of(k, 1), t, of(k, 0))); };
    const auto linear = [&](int k) { return fma(of(k, 1), t, of(k, 0)); };
    const R w5 = fnma(wwww.im, w.im, wwww.re * w.re), w6 = fms(www.re, www.re, www.im * www.im);
    const R w7 = fnma(wwww.im, www.im, wwww.re * www.re);
    const R low = fma(quadratic(2), ww.re, fma(cubic(1), w.re, cubic(0)));
    const R middle = fma(linear(5), w5, fma(linear(4), wwww.re, quadratic(3) * www.re));
    return finished(low + fma(of(7, 0), w7, fma(of(6, 0), w6, middle)));
  }
};

/// At phi_i = 0, where every element of an isotropic sample is even or odd in phi_r; then turned to the azimuth of
/// incidence. Elements 22, 33, 32, 23 are made of u and v of the isotropic family, of which v does not turn.
template <class R, class C>
MMBRDF_INLINE void plane_of_incidence(const C& a, R scale, Complex<R> turned_by, Complex<R> w, R (&f)[16]) {
  using L = PlaneLayout;
  const Harmonics<R> h(times_conj(w, turned_by));
  const R f11 = scale * h.f11(a, L::f11);
  const Complex<R> once = square(turned_by), two = f11 * once, four = f11 * square(once);
  const auto turn = [&](Complex<R> by, R x, R y, int at_x, int at_y) {
    f[at_x] = fnma(by.im, y, by.re * x);
    f[at_y] = fma(by.re, y, by.im * x);
  };
  f[0] = f11;
  f[15] = f11 * h.cosines(a, L::m44);
  f[3] = f11 * h.sines(a, L::m14);
  f[12] = f11 * h.sines(a, L::m41);
  turn(two, h.cosines(a, L::m21), h.sines(a, L::m31), 4, 8);
  turn(two, h.sines(a, L::m24), h.cosines(a, L::m34), 7, 11);
  turn(conj(two), h.cosines(a, L::m12), h.sines(a, L::m13), 1, 2);
  turn(conj(two), h.sines(a, L::m42), h.cosines(a, L::m43), 13, 14);
  const R v_re = f11 * h.cosines(a, L::v_re), v_im = f11 * h.sines(a, L::v_im);
  const R u_re = h.cosines(a, L::u_re), u_im = h.sines(a, L::u_im);
  const R re = fnma(four.im, u_im, four.re * u_re), im = fma(four.re, u_im, four.im * u_re);
  f[5] = re + v_re;
  f[10] = re - v_re;
  f[9] = im + v_im;
  f[6] = v_im - im;
}

/// Any family at any order: a sum over all K for each element, eight elements at a time.
template <class R, class C>
void all_functions(const C* a, int order, const R* scale, const Complex<R>* w, R (*f)[16]) {
  Together<R> k[max_table];
  zernike_values<1>(order, {w}, {k});
  const int count = (order + 1) * (order + 2) / 2;
  for (int h = 0; h < packs_together; ++h) {
    for (int first = 0; first < 16; first += 8) {
      R sum[8];
      for (int e = 0; e < 8; ++e) sum[e] = a[h](first + e);  // K_0^0 without its norm is 1
      for (int j = 1; j < count; ++j)
        for (int e = 0; e < 8; ++e) sum[e] = fma(a[h](16 * j + first + e), k[j].pack[h], sum[e]);
      for (int e = 0; e < 8; ++e) f[h][first + e] = sum[e];
    }
    f[h][0] = scale[h] * f[h][0];
    for (int e = 1; e < 16; ++e) f[h][e] = f[h][0] * f[h][e];
  }
}

}  // namespace
}  // namespace mmbrdf::MMBRDF_ISA
