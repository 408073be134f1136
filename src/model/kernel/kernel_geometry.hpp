// SPDX-License-Identifier: BSD-3-Clause
/// Directions as points of the disc, and their products.
#pragma once

#include "mmbrdf/polarization/exchange_sign.hpp"
#include "model/kernel/kernel.hpp"
#include "numerics/complex_pack.hpp"
#include "numerics/pack.hpp"

namespace mmbrdf::MMBRDF_ISA {
namespace {

/// What the isotropic family is made of: functions of even order in both directions together, so that no square root of
/// a single direction is needed.
///   t    2|w|² − 1          z    w_i conj(w_r)          ii, rr, ir    w_i², w_r², w_i w_r
template <class R>
struct Products {
  R t_i, t_r;
  Complex<R> z, ii, rr, ir;
};

template <class R>
struct Vector {
  R x, y, z;
};

template <class R>
MMBRDF_INLINE R norm(const Vector<R>& v) {
  return fma(v.z, v.z, fma(v.x, v.x, v.y * v.y));
}

/// L of L², where L is 1 to 1e-6, so that two terms of the series are enough.
template <class R>
MMBRDF_INLINE R near_one_root(R square) {
  const R e = square - R(1);
  return fma(e, fma(e, R(-0.125f), R(0.5f)), R(1));
}

/// w = (x + iy)/√(L (L + z)), where L = |v| is 1 to 1e-6.
template <class R>
struct Lambert {
  R area, denominator;  // x² + y²;  L² + L z
  MMBRDF_INLINE explicit Lambert(const Vector<R>& v) {
    area = fma(v.x, v.x, v.y * v.y);
    const R square = fma(v.z, v.z, area);
    denominator = fma(near_one_root(square), v.z, square);
  }
};

template <class R>
MMBRDF_INLINE Products<R> lambert_products(const Vector<R>& i, const Vector<R>& r) {
  const Lambert<R> a(i), b(r);
  const R both = a.denominator * b.denominator, inverse = R(1) / both, root = sqrt(both) * inverse;
  const R factor_i = b.denominator * inverse, factor_r = a.denominator * inverse;
  const Complex<R> w_i{root * i.x, root * i.y}, w_r{r.x, r.y};
  return {fms(a.area + a.area, factor_i, R(1)),
          fms(b.area + b.area, factor_r, R(1)),
          times_conj(w_i, w_r),
          factor_i * square(Complex<R>{i.x, i.y}),
          factor_r * square(w_r),
          w_i * w_r};
}

template <class R>
MMBRDF_INLINE Products<R> products(Complex<R> w_i, Complex<R> w_r) {
  const auto t = [](Complex<R> w) { return fma(w.re + w.re, w.re, fms(w.im + w.im, w.im, R(1))); };
  return {t(w_i), t(w_r), times_conj(w_i, w_r), square(w_i), square(w_r), w_i * w_r};
}

template <class R>
MMBRDF_INLINE Complex<R> disc_point(const Vector<R>& v, bool projected) {
  if (projected) {
    const R e = fma(v.x, v.x, fma(v.y, v.y, fms(v.z, v.z, R(1))));
    const R inverse = fma(e, fma(e, R(0.375f), R(-0.5f)), R(1));  // of the length
    return {v.x * inverse, v.y * inverse};
  }
  const R factor = R(1) / sqrt(Lambert<R>(v).denominator);
  return {v.x * factor, v.y * factor};
}

/// Tiny w are made large, since their squares are 0.
template <class T>
MMBRDF_INLINE Complex<Pack<T>> with_square(Complex<Pack<T>> w) {
  using R = Pack<T>;
  constexpr T tiny = sizeof(T) == 8 ? T(0x1p-400) : T(0x1p-50f), huge = sizeof(T) == 8 ? T(0x1p+700) : T(0x1p+90f);
  const auto is_tiny = (w.re.v < tiny) & (w.re.v > -tiny) & (w.im.v < tiny) & (w.im.v > -tiny);
  return select(is_tiny, R(huge), R(1)) * w;
}

/// w / |w|; 1 at the normal.
template <class T>
MMBRDF_INLINE Complex<Pack<T>> phase(Complex<Pack<T>> w) {
  using R = Pack<T>;
  const Complex<R> large = with_square(w);
  const R length = sqrt(norm(large));
  const auto is_normal = length.v == R(0).v;
  const R inverse = R(1) / select(is_normal, R(1), length);
  return {select(is_normal, R(1), large.re * inverse), large.im * inverse};
}

/// (w / |w|)²; 1 at the normal.
template <class T>
MMBRDF_INLINE Complex<Pack<T>> doubled_phase(Complex<Pack<T>> w) {
  using R = Pack<T>;
  const Complex<R> large = with_square(w);
  const R length = norm(large);
  const auto is_normal = length.v == R(0).v;
  const Complex<R> doubled = (R(1) / select(is_normal, R(1), length)) * square(large);
  return {select(is_normal, R(1), doubled.re), doubled.im};
}

consteval double factorial(int n) { return n == 0 ? 1 : n * factorial(n - 1); }

/// Taylor's series for |x| ≤ π/4, where the first term left out is below 1e-17.
template <class R>
MMBRDF_INLINE R sine_of_small(R x) {
  const R xx = x * x;
  R sum = R(-1 / factorial(15));
  sum = fma(sum, xx, R(1 / factorial(13)));
  sum = fma(sum, xx, R(-1 / factorial(11)));
  sum = fma(sum, xx, R(1 / factorial(9)));
  sum = fma(sum, xx, R(-1 / factorial(7)));
  sum = fma(sum, xx, R(1 / factorial(5)));
  sum = fma(sum, xx, R(-1 / factorial(3)));
  return fma(sum * xx, x, x);
}
template <class R>
MMBRDF_INLINE R cosine_of_small(R x) {
  const R xx = x * x;
  R sum = R(1 / factorial(16));
  sum = fma(sum, xx, R(-1 / factorial(14)));
  sum = fma(sum, xx, R(1 / factorial(12)));
  sum = fma(sum, xx, R(-1 / factorial(10)));
  sum = fma(sum, xx, R(1 / factorial(8)));
  sum = fma(sum, xx, R(-1 / factorial(6)));
  sum = fma(sum, xx, R(1 / factorial(4)));
  return fma(xx, fma(sum, xx, R(-0.5)), R(1));
}

/// cos x + i sin x for |x| ≤ max_azimuth. Quarter turns are taken off in two parts of π/2, the first short enough for
/// exact products; adding 1.5 × 2⁵² rounds to a whole number and leaves it in the last bits.
MMBRDF_INLINE Complex<Pack<double>> circle(Pack<double> x) {
  using R = Pack<double>;
  constexpr double quarter = 1.5707963267948966, beyond = 6.123233995736766e-17;  // π/2 is their sum to 107 bits
  constexpr double shift = 0x1.8p52;
  constexpr double first = (quarter + 0x1p+21) - 0x1p+21, second = (quarter - first) + beyond;  // 32 bits; the rest
  const R shifted = fma(x, R(1 / quarter), R(shift)), count = shifted - R(shift);
  const R rest = fnma(count, R(second), fnma(count, R(first), x));
  const R c = cosine_of_small(rest), s = sine_of_small(rest);
  const auto bits = bits_of(shifted);
  const auto odd = (bits & 1) != 0;
  return {with_sign(select(odd, s, c), (bits + 1) << 62), with_sign(select(odd, c, s), bits << 62)};
}

/// Of theta and phi, where e is cos phi + i sin phi.
MMBRDF_INLINE Pack<double> disc_radius(Pack<double> theta, bool projected) {
  if (projected) return circle(theta).im;
  return Pack<double>(1.4142135623730951) * sine_of_small(Pack<double>(0.5) * theta);
}

/// The matrix at azimuths that both grew by that of e, of an isotropic sample: R(−φ) M R(−φ).
template <class R>
MMBRDF_INLINE void turn(Complex<R> e, R (&f)[16]) {
  const Complex<R> twice = square(e);
  const R c = twice.re, s = twice.im;
  for (int j = 0; j < 4; ++j) {
    const R a = f[4 + j], b = f[8 + j];
    f[4 + j] = fnma(s, b, c * a);
    f[8 + j] = fma(s, a, c * b);
  }
  for (int i = 0; i < 16; i += 4) {
    const R a = f[i + 1], b = f[i + 2];
    f[i + 1] = fma(s, b, c * a);
    f[i + 2] = fnma(s, a, c * b);
  }
}

/// An element above the diagonal and its transpose, from sums over what is even and odd under exchange.
template <int row, int column, class R>
MMBRDF_INLINE void put_exchanged(R f11, R even, R odd, R* f) {
  constexpr bool changes = exchange_sign(row, column) < 0;
  f[4 * row + column] = f11 * (even + odd);
  f[4 * column + row] = f11 * (changes ? odd - even : even - odd);
}

}  // namespace
}  // namespace mmbrdf::MMBRDF_ISA
