// SPDX-License-Identifier: BSD-3-Clause
// Compiled once for each instruction set, with MMBRDF_ISA as its name.
#include "fitting/kernel/influence_kernel.hpp"

#include "numerics/pack.hpp"

namespace mmbrdf::MMBRDF_ISA {
namespace {

using R = Pack<double>;

constexpr size_t width = R::width, vectors = 3;  // with a tile of four: twelve sums, three values and a factor
constexpr size_t across = width * vectors;
static_assert(influence_sets % across == 0);

MMBRDF_INLINE void tile(const double* p, size_t count, const double* values, double* out) {
  R sums[influence_tile][vectors];
  for (size_t r = 0; r < influence_tile; ++r)
    for (size_t v = 0; v < vectors; ++v) sums[r][v] = load(out + r * influence_sets + v * width);
  for (size_t g = 0; g < count; ++g) {
    R some[vectors];
    for (size_t v = 0; v < vectors; ++v) some[v] = load(values + g * influence_sets + v * width);
    for (size_t r = 0; r < influence_tile; ++r) {
      const R factor(p[g * influence_tile + r]);
      for (size_t v = 0; v < vectors; ++v) sums[r][v] = fma(factor, some[v], sums[r][v]);
    }
  }
  for (size_t r = 0; r < influence_tile; ++r)
    for (size_t v = 0; v < vectors; ++v) store(sums[r][v], out + r * influence_sets + v * width);
}

void multiply(const double* p, size_t rows, size_t count, const double* values, double* out) {
  for (size_t t = 0; t < rows / influence_tile; ++t)
    for (size_t s = 0; s < influence_sets; s += across)
      tile(p + t * count * influence_tile, count, values + s, out + t * influence_tile * influence_sets + s);
}

/// a0 b0 a1 b1 …, as far as half of each goes: the first half, or the second.
template <bool second, class Values>
MMBRDF_INLINE Values interleave(Values a, Values b) {
  if constexpr (width == 8 && second)
    return __builtin_shufflevector(a, b, 4, 12, 5, 13, 6, 14, 7, 15);
  else if constexpr (width == 8)
    return __builtin_shufflevector(a, b, 0, 8, 1, 9, 2, 10, 3, 11);
  else if constexpr (width == 4 && second)
    return __builtin_shufflevector(a, b, 2, 6, 3, 7);
  else if constexpr (width == 4)
    return __builtin_shufflevector(a, b, 0, 4, 1, 5);
  else if constexpr (second)
    return __builtin_shufflevector(a, b, 1, 3);
  else
    return __builtin_shufflevector(a, b, 0, 2);
}

/// A square of numbers, its columns as rows: each of log₂ width rounds interleaves the upper half of the rows with the lower.
template <class Number>
MMBRDF_INLINE void turn(const Number* const* from, size_t at, R* to) {
  typedef Number Values __attribute__((vector_size(width * sizeof(Number))));
  Values rows[width], turned[width];
  for (size_t s = 0; s < width; ++s) __builtin_memcpy(&rows[s], from[s] + at, sizeof rows[s]);
  for (size_t round = 1; round < width; round *= 2) {
    for (size_t k = 0; k < width / 2; ++k) {
      turned[2 * k] = interleave<false>(rows[k], rows[k + width / 2]);
      turned[2 * k + 1] = interleave<true>(rows[k], rows[k + width / 2]);
    }
    for (size_t k = 0; k < width; ++k) rows[k] = turned[k];
  }
  for (size_t k = 0; k < width; ++k) to[k] = __builtin_convertvector(rows[k], R::Values);
}

MMBRDF_INLINE void put(R value, double weight, double* to, double* squares) {
  if (weight == 0) value = R(0.0);
  store(value, to);
  store(fma(R(weight), value * value, load(squares)), squares);
}

/// Matrices of one geometry, of as many sets as stand in a register.
template <class Number>
MMBRDF_INLINE void take_matrices(const Number* const* from, size_t g, const double* weights, double* const* to,
                                 double* const* squares, size_t s) {
  R f[16];
  for (size_t e = 0; e < 16; e += width) turn(from + s, 16 * g + e, f + e);
  put(f[0], weights[0], to[0] + g * influence_sets + s, squares[0] + s);
  const R inverse = R(1.0) / f[0];
  for (size_t e = 1; e < 16; ++e)
    if (to[e]) put(f[e] * inverse, weights[e], to[e] + g * influence_sets + s, squares[e] + s);
}

/// f11 of `some` geometries from g on, at most as many as sets stand in a register.
template <class Number>
MMBRDF_INLINE void take_f11(const Number* const* from, size_t g, size_t some, const double* weights, double* to,
                            double* squares, size_t s) {
  R f11[width];
  if (some == width)
    turn(from + s, g, f11);
  else
    for (size_t i = 0; i < some; ++i)
      for (size_t k = 0; k < width; ++k) f11[i].v[k] = static_cast<double>(from[s + k][g + i]);
  for (size_t i = 0; i < some; ++i) put(f11[i], weights[16 * (g + i)], to + (g + i) * influence_sets + s, squares + s);
}

template <class Number>
MMBRDF_INLINE void take(const Number* const* from, size_t each, size_t count, const double* weights, double* const* to,
                        double* const* squares) {
  if (each == 16) {
    for (size_t g = 0; g < count; ++g)
      for (size_t s = 0; s < influence_sets; s += width) take_matrices(from, g, weights + 16 * g, to, squares, s);
    return;
  }
  for (size_t g = 0; g < count; g += width)
    for (size_t s = 0; s < influence_sets; s += width)
      take_f11(from, g, count - g < width ? count - g : width, weights, to[0], squares[0], s);
}
void take_float(const float* const* from, size_t each, size_t count, const double* weights, double* const* to,
                double* const* squares) {
  take(from, each, count, weights, to, squares);
}
void take_double(const double* const* from, size_t each, size_t count, const double* weights, double* const* to,
                 double* const* squares) {
  take(from, each, count, weights, to, squares);
}

#define MMBRDF_TEXT(name) #name
#define MMBRDF_NAME(name) MMBRDF_TEXT(name)

}  // namespace

extern const InfluenceKernel influence_kernel;
const InfluenceKernel influence_kernel{MMBRDF_NAME(MMBRDF_ISA), runs_here, take_float, take_double, multiply};

}  // namespace mmbrdf::MMBRDF_ISA
