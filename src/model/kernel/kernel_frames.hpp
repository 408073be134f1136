// SPDX-License-Identifier: BSD-3-Clause
/// Matrices in the frame asked for, by algebra on both directions: what angles_to_xy() of geometry.hpp says, without
/// its angles.
///
/// M_frame = R(−a_s) M_xy R(a_i): R(a) multiplies S2 + i S3 by e^{−2ia}, so cos 2a and sin 2a of both sides are enough. For
/// sp they come from the azimuths, a_s = −φr and a_i = φi. For the scattering plane a turn from sp is added, of which
/// geometry.cpp has the sines and cosines of the single angles, ⊥·s + i ⊥·p; its square over its norm is that of the double
/// angle.
#pragma once

#include "model/kernel/kernel_geometry.hpp"

namespace mmbrdf::MMBRDF_ISA {
namespace {

/// Factors of length 1: of m_2j + i m_3j for all j, then of m_i2 + i m_i3 for all i.
template <class R>
struct Turn {
  Complex<R> rows, columns;
};

template <class R>
MMBRDF_INLINE void apply(const Turn<R>& turn, R* f) {
  for (int j = 4; j < 8; ++j) {
    const Complex<R> row = Complex<R>{f[j], f[j + 4]} * turn.rows;
    f[j] = row.re, f[j + 4] = row.im;
  }
  for (int i = 0; i < 16; i += 4) {
    const Complex<R> column = Complex<R>{f[i + 1], f[i + 2]} * turn.columns;
    f[i + 1] = column.re, f[i + 2] = column.im;
  }
}

/// From xy to sp. Here and below `doubled` is that of the azimuth of each direction.
template <class R>
MMBRDF_INLINE Turn<R> turn_to_sp(Complex<R> doubled_i, Complex<R> doubled_r) {
  return {conj(doubled_r), doubled_i};
}

/// From xy to the scattering plane where the beams are parallel: ⊥ is the s axis of the incident one. The turn from sp is 0
/// on that side, and the angle of −cos d + i cos θr sin d on the other.
template <class R>
MMBRDF_INLINE Turn<R> turn_to_plane_of_parallel(Complex<R> doubled_i, Complex<R> doubled_r, R cos_theta_r) {
  const Complex<R> d = times_conj(doubled_r, doubled_i);  // cos 2d + i sin 2d
  const R sine = cos_theta_r * cos_theta_r * (R(1) - d.re), cosine = R(1) + d.re;
  const R inverse = R(1) / (cosine + sine);
  const Complex<R> from_sp{inverse * (cosine - sine), inverse * (R(-2) * (cos_theta_r * d.im))};
  return {conj(doubled_r * from_sp), doubled_i};
}

template <class Mask, class R>
MMBRDF_INLINE Turn<R> select(Mask mask, const Turn<R>& a, const Turn<R>& b) {
  const auto part = [&](Complex<R> x, Complex<R> y) {
    return Complex<R>{select(mask, x.re, y.re), select(mask, x.im, y.im)};
  };
  return {part(a.rows, b.rows), part(a.columns, b.columns)};
}

// ---- from angles ----------------------------------------------------------------------------------------------------

/// With e = cos φ + i sin φ.
template <class R>
struct Angles {
  R theta, phi;
  Complex<R> e;
};

/// From xy to the scattering plane. In half angles ⊥·s + i ⊥·p of both sides are products, 2 a b of the scattered beam and
/// 2 ā b of the incident one, in which nothing cancels where the beams are nearly parallel:
///     a = sin(θi − θr)/2 cos d/2 − i sin(θi + θr)/2 sin d/2,    b = cos(θi − θr)/2 cos d/2 − i cos(θi + θr)/2 sin d/2
template <class R>
MMBRDF_INLINE Turn<R> turn_to_plane(const Angles<R>& i, const Angles<R>& r) {
  const R half(0.5), difference = half * (i.theta - r.theta);
  const Complex<R> d = circle(half * (r.phi - i.phi)), sum = circle(half * (i.theta + r.theta));
  const R sine = sine_of_small(difference), cosine = cosine_of_small(difference);
  const Complex<R> a{sine * d.re, -(sum.im * d.im)}, b{cosine * d.re, -(sum.re * d.im)};
  const R square_product = norm(a) * norm(b);
  const auto parallel = square_product.v < R(0.25 * kernel_parallel_limit * kernel_parallel_limit).v;
  const R inverse = R(1) / select(parallel, R(1), square_product);
  const Complex<R> doubled_i = square(i.e), doubled_r = square(r.e), aa = inverse * square(a), bb = square(b);
  const Turn<R> turn{conj(doubled_r * (aa * bb)), doubled_i * times_conj(aa, bb)};
  if (!any(parallel)) [[likely]]
    return turn;
  const R cos_theta_r = fma(sum.re, cosine, sum.im * sine);
  return select(parallel, turn_to_plane_of_parallel(doubled_i, doubled_r, cos_theta_r), turn);
}

template <class R>
MMBRDF_INLINE Turn<R> turn_to(KernelFrame frame, const Angles<R>& i, const Angles<R>& r) {
  return frame == KernelFrame::sp ? turn_to_sp(square(i.e), square(r.e)) : turn_to_plane(i, r);
}

// ---- from vectors ---------------------------------------------------------------------------------------------------

/// a b − c d; with fused multiply-adds no digits are lost where they are nearly the same.
template <class R>
MMBRDF_INLINE R difference_of_products(R a, R b, R c, R d) {
  const R product = c * d;
  return fms(a, b, product) - fms(c, d, product);
}

/// (x + iy)² / |x + iy|²
template <class R>
MMBRDF_INLINE Complex<R> doubled_azimuth(const Vector<R>& v) {
  return doubled_phase(Complex<R>{v.x, v.y});
}

/// From xy to the scattering plane, with ⊥ = r × i. The axes of xy come from those at the normal by the shortest turn, so
/// ⊥ has the components −i (⊥x + i⊥y − (x + iy) ⊥z/(L + z)) in them, without the azimuth of x + iy. doubled_i() is
/// asked for parallel beams only.
template <class R, class DoubledI>
MMBRDF_INLINE Turn<R> turn_to_plane(const Vector<R>& i, const Vector<R>& r, const DoubledI& doubled_i) {
  const Complex<R> across{difference_of_products(r.y, i.z, r.z, i.y), difference_of_products(r.z, i.x, r.x, i.z)};
  const R up = difference_of_products(r.x, i.y, r.y, i.x);
  const R length_i = near_one_root(norm(i)), length_r = near_one_root(norm(r));
  const Complex<R> of_i = fma(length_i + i.z, across, -up * Complex<R>{i.x, i.y});
  const Complex<R> of_r = fma(length_r + r.z, across, -up * Complex<R>{r.x, r.y});
  constexpr double limit = kernel_parallel_limit * kernel_parallel_limit;
  const auto parallel = fma(up, up, norm(across)).v < R(static_cast<typename R::Number>(limit)).v;
  const R norm_i = norm(of_i), norm_r = norm(of_r);
  const R inverse = R(-1) / select(parallel, R(1), norm_i * norm_r);
  const Turn<R> turn{conj((inverse * norm_i) * square(of_r)), (inverse * norm_r) * square(of_i)};
  if (!any(parallel)) [[likely]]
    return turn;
  return select(parallel, turn_to_plane_of_parallel(doubled_i(), doubled_azimuth(r), r.z / length_r), turn);
}

template <class R, class DoubledI>
MMBRDF_INLINE Turn<R> turn_to(KernelFrame frame, const Vector<R>& i, const Vector<R>& r, const DoubledI& doubled_i) {
  return frame == KernelFrame::sp ? turn_to_sp(doubled_i(), doubled_azimuth(r)) : turn_to_plane(i, r, doubled_i);
}

}  // namespace
}  // namespace mmbrdf::MMBRDF_ISA
