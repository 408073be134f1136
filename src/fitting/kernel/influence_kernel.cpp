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

void multiply(const double* p, size_t rows, size_t columns, size_t first, size_t count, const double* values,
              double* out) {
  for (size_t t = 0; t < rows / influence_tile; ++t)
    for (size_t s = 0; s < influence_sets; s += across)
      tile(p + (t * columns + first) * influence_tile, count, values + s,
           out + t * influence_tile * influence_sets + s);
}

void square(const double* weights, size_t count, double* values, double* squares) {
  for (size_t g = 0; g < count; ++g) {
    double* const row = values + g * influence_sets;
    const R weight(weights[g]);
    for (size_t s = 0; s < influence_sets; s += width) {
      const R value = weights[g] == 0 ? R(0.0) : load(row + s);
      if (weights[g] == 0) store(value, row + s);
      store(fma(weight, value * value, load(squares + s)), squares + s);
    }
  }
}

/// Four elements of four sets, as four sets of each of the elements.
template <class Number>
MMBRDF_INLINE void turn(const Number* const* from, size_t at, double* to) {
  typedef Number Four __attribute__((vector_size(4 * sizeof(Number))));
  typedef double FourDoubles __attribute__((vector_size(32)));
  Four in[4];
  for (size_t k = 0; k < 4; ++k) __builtin_memcpy(&in[k], from[k] + at, sizeof in[k]);
  const Four a = __builtin_shufflevector(in[0], in[1], 0, 4, 1, 5),
             b = __builtin_shufflevector(in[0], in[1], 2, 6, 3, 7),
             c = __builtin_shufflevector(in[2], in[3], 0, 4, 1, 5),
             d = __builtin_shufflevector(in[2], in[3], 2, 6, 3, 7);
  const Four out[4] = {__builtin_shufflevector(a, c, 0, 1, 4, 5), __builtin_shufflevector(a, c, 2, 3, 6, 7),
                       __builtin_shufflevector(b, d, 0, 1, 4, 5), __builtin_shufflevector(b, d, 2, 3, 6, 7)};
  for (size_t k = 0; k < 4; ++k) {
    const FourDoubles whole = __builtin_convertvector(out[k], FourDoubles);
    __builtin_memcpy(to + k * influence_sets, &whole, sizeof whole);
  }
}

constexpr size_t ahead = 12;  // geometries

template <class Number>
MMBRDF_INLINE void pack(const Number* const* from, size_t count, double* const* to) {
  alignas(64) double f[16][influence_sets];
  for (size_t g = 0; g < count; ++g) {
    // So many places are read in turn that the processor does not see what comes next.
    for (size_t s = 0; s < influence_sets; ++s)
      for (size_t line = 0; line < 16; line += 64 / sizeof(Number))
        __builtin_prefetch(from[s] + 16 * (g + ahead) + line);
    for (size_t s = 0; s < influence_sets; s += 4)
      for (size_t e = 0; e < 16; e += 4) turn(from + s, 16 * g + e, &f[e][s]);
    double* const first = to[0] + g * influence_sets;
    R inverse[influence_sets / width];
    for (size_t v = 0; v < influence_sets / width; ++v) {
      const R f11 = load(f[0] + v * width);
      store(f11, first + v * width);
      inverse[v] = R(1.0) / f11;
    }
    for (size_t e = 1; e < 16; ++e) {
      if (!to[e]) continue;
      double* const row = to[e] + g * influence_sets;
      for (size_t v = 0; v < influence_sets / width; ++v) store(load(f[e] + v * width) * inverse[v], row + v * width);
    }
  }
}
void pack_float(const float* const* from, size_t count, double* const* to) { pack(from, count, to); }
void pack_double(const double* const* from, size_t count, double* const* to) { pack(from, count, to); }

#define MMBRDF_TEXT(name) #name
#define MMBRDF_NAME(name) MMBRDF_TEXT(name)

}  // namespace

extern const InfluenceKernel influence_kernel;
const InfluenceKernel influence_kernel{MMBRDF_NAME(MMBRDF_ISA), runs_here, square, pack_float, pack_double, multiply};

}  // namespace mmbrdf::MMBRDF_ISA
