// SPDX-License-Identifier: BSD-3-Clause
/// Mueller matrices, one in each lane: read, scaled, written.
#pragma once

#include "numerics/complex_pack.hpp"
#include "numerics/pack.hpp"

namespace mmbrdf::MMBRDF_ISA {
namespace {

using R = Pack<double>;
using C = Complex<R>;

template <int... numbers>
struct Numbers {};
template <int count, int... numbers>
struct Counting : Counting<count - 1, count - 1, numbers...> {};
template <int... numbers>
struct Counting<0, numbers...> {
  using Type = Numbers<numbers...>;
};

/// Of a square of lanes, the blocks beside the diagonal change places: those at a distance of h.
template <int h, class Values, int... lane>
MMBRDF_INLINE void exchange(Values& a, Values& b, Numbers<lane...>) {
  constexpr int width = sizeof...(lane);
  const Values low = __builtin_shufflevector(a, b, ((lane & h) == 0 ? lane : width + lane - h)...);
  b = __builtin_shufflevector(a, b, ((lane & h) == 0 ? lane + h : width + lane)...);
  a = low;
}

/// As many Packs as each has lanes.
template <int h, class T>
MMBRDF_INLINE void transpose(Pack<T>* rows) {
  constexpr int width = Pack<T>::width;
  if constexpr (h < width) {
    for (int i = 0; i < width; ++i)
      if ((i & h) == 0) exchange<h>(rows[i].v, rows[i + h].v, typename Counting<width>::Type{});
    transpose<2 * h>(rows);
  }
}

/// Element e of the matrix in lane q is from[16 q + e].
template <class T>
MMBRDF_INLINE void load_matrices(const T* from, Pack<T> (&m)[16]) {
  constexpr int width = Pack<T>::width;
  for (int first = 0; first < 16; first += width) {
    for (int lane = 0; lane < width; ++lane) m[first + lane] = load(from + 16 * lane + first);
    transpose<1>(m + first);
  }
}

/// Element e of the matrix in lane q goes to to[stride q + e].
template <class T>
MMBRDF_INLINE void store_matrices(const Pack<T> (&m)[16], T* to, ptrdiff_t stride) {
  constexpr int width = Pack<T>::width;
  for (int first = 0; first < 16; first += width) {
    Pack<T> rows[width];
    for (int e = 0; e < width; ++e)
      keep_in_register(rows[e] = m[first + e]);  // g++ 12 makes 1, 1, 0, 0 of constants 1, 0, 0, 0
    transpose<1>(rows);
    for (int lane = 0; lane < width; ++lane) store(rows[lane], to + lane * stride + first);
  }
}

/// `count` numbers for each lane.
template <class T>
MMBRDF_INLINE void store_numbers(const Pack<T>* values, int count, T* to, ptrdiff_t stride) {
  constexpr int width = Pack<T>::width;
  for (int k = 0; k < count; ++k) {
    T lanes[width];
    store(values[k], lanes);
    for (int lane = 0; lane < width; ++lane) to[lane * stride + k] = lanes[lane];
  }
}

/// M · 2^−e with its largest element in [½, 1), as analysis.cpp has it, so that no square overflows.
struct ScaledPack {
  R m[16], back;  // back = 2^e
  Mask ordinary;  // whether that is possible; elsewhere m is 0

  MMBRDF_INLINE explicit ScaledPack(const double* from) {
    load_matrices(from, m);
    R largest(0.0);
    ordinary = largest.v == largest.v;
    for (const R& element : m) {
      largest = select(absolute(element).v > largest.v, absolute(element), largest);
      ordinary &= element.v == element.v;
    }
    constexpr long long one = 1LL << 52;
    ordinary &= (largest.v > 0x1p-400) & (largest.v < 0x1p+400);
    const Bits exponent = bits_of(select(ordinary, largest, R(1.0))) & (0x7ff * one);
    const R factor = from_bits(0x7fd * one - exponent);
    back = from_bits(exponent + one);
    for (R& element : m) element = select(ordinary, element * factor, R(0.0));
  }

  /// Whether M11 is positive, and a quotient of any element by it finite.
  MMBRDF_INLINE Mask has_intensity() const { return ordinary & (m[0].v > 0x1p-1000); }
};

}  // namespace
}  // namespace mmbrdf::MMBRDF_ISA
