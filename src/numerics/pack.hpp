// SPDX-License-Identifier: BSD-3-Clause
/// As many numbers as a register of this instruction set holds. For kernel sources alone, which are compiled once for
/// each instruction set: everything here has internal linkage and includes nothing of the standard library, so that the
/// linker cannot take a function compiled for AVX-512 where the baseline asked for one.
#pragma once

#include <stddef.h>
#if defined(__AVX__)
#include <immintrin.h>
#endif

#define MMBRDF_INLINE [[gnu::always_inline]] inline  // a kernel is one straight line: no call within it

namespace mmbrdf::MMBRDF_ISA {
namespace {

#if defined(__AVX512F__)
constexpr int vector_bytes = 64;
#elif defined(__AVX__)
constexpr int vector_bytes = 32;
#else
constexpr int vector_bytes = 16;
#endif

/// Whether this processor has what this source was compiled for.
inline bool runs_here() {
#if defined(__AVX512F__)
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
#elif defined(__AVX2__)
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return true;
#endif
}

/// The vector extension of gcc and clang has all operators, but neither fma nor sqrt: there a loop over the lanes,
/// which both compilers turn into one instruction as long as the vector is as wide as the register; not so of sqrt for
/// WebAssembly.
template <class T>
struct Pack {
  static constexpr int width = vector_bytes / static_cast<int>(sizeof(T));
  typedef T Values __attribute__((vector_size(vector_bytes)));
  using Number = T;

  Values v;
  Pack() = default;
  MMBRDF_INLINE Pack(const Values& values) : v(values) {}
  MMBRDF_INLINE explicit Pack(T value) : v(value - Values{}) {}
};

template <class T>
MMBRDF_INLINE Pack<T> operator+(Pack<T> a, Pack<T> b) {
  return a.v + b.v;
}
template <class T>
MMBRDF_INLINE Pack<T> operator-(Pack<T> a, Pack<T> b) {
  return a.v - b.v;
}
template <class T>
MMBRDF_INLINE Pack<T> operator*(Pack<T> a, Pack<T> b) {
  return a.v * b.v;
}
template <class T>
MMBRDF_INLINE Pack<T> operator/(Pack<T> a, Pack<T> b) {
  return a.v / b.v;
}
template <class T>
MMBRDF_INLINE Pack<T> operator-(Pack<T> a) {
  return -a.v;
}

/// a b + c, rounded once where the processor can, and twice where it would have to be emulated.
MMBRDF_INLINE double fma(double a, double b, double c) {
#if defined(__FMA__) || defined(__ARM_FEATURE_FMA)
  return __builtin_fma(a, b, c);
#else
  return a * b + c;
#endif
}
MMBRDF_INLINE float fma(float a, float b, float c) {
#if defined(__FMA__) || defined(__ARM_FEATURE_FMA)
  return __builtin_fmaf(a, b, c);
#else
  return a * b + c;
#endif
}
MMBRDF_INLINE double sqrt(double a) { return __builtin_sqrt(a); }
MMBRDF_INLINE float sqrt(float a) { return __builtin_sqrtf(a); }

#if defined(__AVX512F__)
MMBRDF_INLINE Pack<double> fma(Pack<double> a, Pack<double> b, Pack<double> c) {
  return _mm512_fmadd_pd(a.v, b.v, c.v);
}
MMBRDF_INLINE Pack<float> fma(Pack<float> a, Pack<float> b, Pack<float> c) { return _mm512_fmadd_ps(a.v, b.v, c.v); }
// All lanes by mask: gcc 12 warns of an uninitialised value in its own _mm512_sqrt_pd.
MMBRDF_INLINE Pack<double> sqrt(Pack<double> a) { return _mm512_maskz_sqrt_pd(0xff, a.v); }
MMBRDF_INLINE Pack<float> sqrt(Pack<float> a) { return _mm512_maskz_sqrt_ps(0xffff, a.v); }
#elif defined(__AVX__)
MMBRDF_INLINE Pack<double> fma(Pack<double> a, Pack<double> b, Pack<double> c) {
  return _mm256_fmadd_pd(a.v, b.v, c.v);
}
MMBRDF_INLINE Pack<float> fma(Pack<float> a, Pack<float> b, Pack<float> c) { return _mm256_fmadd_ps(a.v, b.v, c.v); }
MMBRDF_INLINE Pack<double> sqrt(Pack<double> a) { return _mm256_sqrt_pd(a.v); }
MMBRDF_INLINE Pack<float> sqrt(Pack<float> a) { return _mm256_sqrt_ps(a.v); }
#else
template <class T>
MMBRDF_INLINE Pack<T> fma(Pack<T> a, Pack<T> b, Pack<T> c) {
#if defined(__FMA__) || defined(__ARM_FEATURE_FMA)
  Pack<T> r;
  for (int i = 0; i < Pack<T>::width; ++i) r.v[i] = fma(a.v[i], b.v[i], c.v[i]);
  return r;
#else
  return a.v * b.v + c.v;
#endif
}
template <class T>
MMBRDF_INLINE Pack<T> sqrt(Pack<T> a) {
#if defined(__wasm_simd128__)
  if constexpr (sizeof(T) == sizeof(double))
    return __builtin_wasm_sqrt_f64x2(a.v);
  else
    return __builtin_wasm_sqrt_f32x4(a.v);
#else
  Pack<T> r;
  for (int i = 0; i < Pack<T>::width; ++i) r.v[i] = sqrt(a.v[i]);
  return r;
#endif
}
#endif
/// c − a b
template <class T>
MMBRDF_INLINE Pack<T> fnma(Pack<T> a, Pack<T> b, Pack<T> c) {
  return fma(-a, b, c);
}
/// a b − c
template <class T>
MMBRDF_INLINE Pack<T> fms(Pack<T> a, Pack<T> b, Pack<T> c) {
  return fma(a, b, -c);
}

/// Lane by lane a where the mask is set, else b.
template <class Mask, class T>
MMBRDF_INLINE Pack<T> select(Mask mask, Pack<T> a, Pack<T> b) {
  return mask ? a.v : b.v;
}

typedef long long Bits __attribute__((vector_size(vector_bytes)));
MMBRDF_INLINE Bits bits_of(Pack<double> a) { return reinterpret_cast<Bits>(a.v); }
/// a, with its sign changed where the highest bit is set.
MMBRDF_INLINE Pack<double> with_sign(Pack<double> a, Bits highest) {
  return reinterpret_cast<Pack<double>::Values>(bits_of(a) ^ (highest & (-0x7fffffffffffffffLL - 1)));
}

MMBRDF_INLINE Pack<double> from_bits(Bits bits) { return reinterpret_cast<Pack<double>::Values>(bits); }
MMBRDF_INLINE Pack<double> absolute(Pack<double> a) { return from_bits(bits_of(a) & 0x7fffffffffffffffLL); }
/// |a| with the sign of b.
MMBRDF_INLINE Pack<double> copy_sign(Pack<double> a, Pack<double> b) { return with_sign(absolute(a), bits_of(b)); }

using Mask = decltype(Pack<double>::Values{} < 0.0);  // of a comparison
/// Whether a mask is set in some lane.
template <class Lanes>
MMBRDF_INLINE bool any(Lanes mask) {
#if defined(__AVX512F__)
  return _mm512_test_epi64_mask(reinterpret_cast<__m512i>(mask), reinterpret_cast<__m512i>(mask)) != 0;
#elif defined(__AVX__)
  return _mm256_testz_si256(reinterpret_cast<__m256i>(mask), reinterpret_cast<__m256i>(mask)) == 0;
#else
  const Bits bits = reinterpret_cast<Bits>(mask);
  return (bits[0] | bits[1]) != 0;
#endif
}

/// Nothing, but the compiler must have the value in a register here.
template <class T>
MMBRDF_INLINE void keep_in_register([[maybe_unused]] Pack<T>& a) {
#if defined(__AVX512F__)
  asm("" : "+v"(a.v));
#endif
}

/// a, where the compilers of browsers have to have it before they go on: they would load all that comes, and have no
/// registers for it.
template <class T>
MMBRDF_INLINE Pack<T> finished(Pack<T> a) {
#if defined(__wasm_simd128__)
  volatile typename Pack<T>::Values in_memory = a.v;
  a.v = in_memory;
#endif
  return a;
}

template <class T>
MMBRDF_INLINE Pack<T> load(const T* from) {
  Pack<T> r;
  __builtin_memcpy(&r.v, from, sizeof r.v);
  return r;
}
template <class T>
MMBRDF_INLINE void store(Pack<T> a, T* to) {
  __builtin_memcpy(to, &a.v, sizeof a.v);
}

}  // namespace
}  // namespace mmbrdf::MMBRDF_ISA
