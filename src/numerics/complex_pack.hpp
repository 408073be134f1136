// SPDX-License-Identifier: BSD-3-Clause
/// Complex numbers in kernels.
#pragma once

#include "numerics/pack.hpp"

namespace mmbrdf::MMBRDF_ISA {
namespace {

template <class R>
struct Complex {
  R re, im;
};
template <class R>
MMBRDF_INLINE Complex<R> operator*(Complex<R> a, Complex<R> b) {
  return {fnma(a.im, b.im, a.re * b.re), fma(a.re, b.im, a.im * b.re)};
}
template <class R>
MMBRDF_INLINE Complex<R> conj(Complex<R> a) {
  return {a.re, -a.im};
}
/// a conj(b)
template <class R>
MMBRDF_INLINE Complex<R> times_conj(Complex<R> a, Complex<R> b) {
  return {fma(a.im, b.im, a.re * b.re), fms(a.im, b.re, a.re * b.im)};
}
template <class R>
MMBRDF_INLINE Complex<R> square(Complex<R> a) {
  return {fms(a.re, a.re, a.im * a.im), (a.re + a.re) * a.im};
}
/// |a|²
template <class R>
MMBRDF_INLINE R norm(Complex<R> a) {
  return fma(a.re, a.re, a.im * a.im);
}
/// q a + b
template <class R>
MMBRDF_INLINE Complex<R> fma(R q, Complex<R> a, Complex<R> b) {
  return {fma(q, a.re, b.re), fma(q, a.im, b.im)};
}
/// a b + c
template <class R>
MMBRDF_INLINE Complex<R> fma(Complex<R> a, Complex<R> b, Complex<R> c) {
  return {fnma(a.im, b.im, fma(a.re, b.re, c.re)), fma(a.re, b.im, fma(a.im, b.re, c.im))};
}
template <class R>
MMBRDF_INLINE Complex<R> operator*(R q, Complex<R> a) {
  return {q * a.re, q * a.im};
}

}  // namespace
}  // namespace mmbrdf::MMBRDF_ISA
