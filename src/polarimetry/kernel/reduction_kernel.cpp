// SPDX-License-Identifier: BSD-3-Clause
// Compiled once for each instruction set, with MMBRDF_ISA as its name.
//
// The lanes are elements: a column of the inverse is read once for some pixels, of which each multiplies it by its own
// reading. Nothing is turned, and all sums of these pixels stay in registers.
#include "polarimetry/kernel/reduction_kernel.hpp"

#include "numerics/pack.hpp"

namespace mmbrdf::MMBRDF_ISA {
namespace {

using R = Pack<double>;

constexpr size_t width = R::width, vectors = 16 / width;
// As many sums as fit beside a reading of each pixel and a part of a column.
constexpr size_t at_once = vectors == 2 ? 8 : vectors == 4 ? 3 : 1;

typedef float Floats __attribute__((vector_size(vector_bytes / 2)));

MMBRDF_INLINE void put(R a, double* to) { store(a, to); }
MMBRDF_INLINE void put(R a, float* to) {
  const Floats rounded = __builtin_convertvector(a.v, Floats);
  __builtin_memcpy(to, &rounded, sizeof rounded);
}

/// Some pixels; returns what is NaN in some lane if a reading is not finite: all elements are not, then, and the first of
/// them tell.
template <size_t pixels, class Out>
MMBRDF_INLINE R solve(const double* inverse, size_t readings, const double* from, Out* out) {
  R sums[pixels][vectors];
  for (size_t p = 0; p < pixels; ++p)
    for (size_t v = 0; v < vectors; ++v) sums[p][v] = R(0.0);
  for (size_t j = 0; j < readings; ++j) {
    R reading[pixels];
    for (size_t p = 0; p < pixels; ++p) reading[p] = R(from[p * readings + j]);
    for (size_t v = 0; v < vectors; ++v) {
      const R column = load(inverse + 16 * j + v * width);
      for (size_t p = 0; p < pixels; ++p) sums[p][v] = fma(reading[p], column, sums[p][v]);
    }
  }
  R odd(0.0);
  for (size_t p = 0; p < pixels; ++p) {
    odd = odd + (sums[p][0] - sums[p][0]);
    for (size_t v = 0; v < vectors; ++v) put(sums[p][v], out + 16 * p + v * width);
  }
  return odd;
}

template <class Out>
bool run(const double* inverse, size_t readings, const double* from, size_t count, Out* out) {
  R odd(0.0);
  size_t q = 0;
  for (; q + at_once <= count; q += at_once)
    odd = odd + solve<at_once>(inverse, readings, from + q * readings, out + 16 * q);
  if (q < count && count >= at_once) {  // some of them once more: the same numbers
    q = count - at_once;
    odd = odd + solve<at_once>(inverse, readings, from + q * readings, out + 16 * q);
    q = count;
  }
  for (; q < count; ++q) odd = odd + solve<1>(inverse, readings, from + q * readings, out + 16 * q);
  return !any(odd.v != odd.v);
}

bool run_double(const double* inverse, size_t readings, const double* from, size_t count, double* out) {
  return run(inverse, readings, from, count, out);
}

bool run_float(const double* inverse, size_t readings, const float* from, size_t count, float* out, double* room) {
  const size_t numbers = readings * count;
  size_t i = 0;
  for (; i + width <= numbers; i += width) {
    Floats some;
    __builtin_memcpy(&some, from + i, sizeof some);
    store(R(__builtin_convertvector(some, R::Values)), room + i);
  }
  for (; i < numbers; ++i) room[i] = static_cast<double>(from[i]);
  return run(inverse, readings, room, count, out);
}

// Four numbers whatever the width of the processor: a row of a matrix.
constexpr size_t part_bytes = vector_bytes < 32 ? vector_bytes : 32, parts = 32 / part_bytes;
typedef double Part __attribute__((vector_size(part_bytes)));
typedef float FloatPart __attribute__((vector_size(part_bytes / 2)));
struct Row {
  Part v[parts];
};

/// sum += factor × the four numbers of a row; products and sums are rounded apart, and so the same on all processors.
MMBRDF_INLINE void add(Row& sum, double factor, const float* from) {
  for (size_t k = 0; k < parts; ++k) {
    FloatPart some;
    __builtin_memcpy(&some, from + k * (4 / parts), sizeof some);
    sum.v[k] += factor * __builtin_convertvector(some, Part);
  }
}
MMBRDF_INLINE void add(Row& sum, double factor, const Row& a) {
  for (size_t k = 0; k < parts; ++k) sum.v[k] += factor * a.v[k];
}
MMBRDF_INLINE void put(const Row& a, float* to) {
  for (size_t k = 0; k < parts; ++k) {
    const FloatPart rounded = __builtin_convertvector(a.v[k], FloatPart);
    __builtin_memcpy(to + k * (4 / parts), &rounded, sizeof rounded);
  }
}

void run_each(const float* inverses, size_t readings, const float* from, size_t count, float* out) {
  for (size_t q = 0; q < count; ++q, inverses += 16 * readings, from += readings, out += 16) {
    Row sums[4] = {};
    for (size_t j = 0; j < readings; ++j)
      for (size_t r = 0; r < 4; ++r) add(sums[r], static_cast<double>(from[j]), inverses + 16 * j + 4 * r);
    for (size_t r = 0; r < 4; ++r) put(sums[r], out + 4 * r);
  }
}

/// `n` analyzers and generators, or 0: as many as are told.
template <size_t n>
MMBRDF_INLINE void arms(const float* a, const float* w, size_t analyzers, size_t generators, const float* from,
                        size_t count, float* out) {
  if (n > 0) analyzers = generators = n;
  for (size_t pixel = 0; pixel < count; ++pixel) {
    Row sums[4] = {};
    for (size_t q = 0; q < analyzers; ++q) {
      Row seen = {};
      for (size_t p = 0; p < generators; ++p) add(seen, static_cast<double>(from[q * generators + p]), w + 4 * p);
      for (size_t r = 0; r < 4; ++r) add(sums[r], static_cast<double>(a[r * analyzers + q]), seen);
    }
    for (size_t r = 0; r < 4; ++r) put(sums[r], out + 4 * r);
    a += 4 * analyzers;
    w += 4 * generators;
    from += analyzers * generators;
    out += 16;
  }
}

void run_arms(const float* a, const float* w, size_t analyzers, size_t generators, const float* from, size_t count,
              float* out) {
  if (analyzers == 4 && generators == 4) return arms<4>(a, w, 4, 4, from, count, out);
  arms<0>(a, w, analyzers, generators, from, count, out);
}

#define MMBRDF_TEXT(name) #name
#define MMBRDF_NAME(name) MMBRDF_TEXT(name)

}  // namespace

extern const ReductionKernel reduction_kernel;
const ReductionKernel reduction_kernel{MMBRDF_NAME(MMBRDF_ISA), runs_here, run_double, run_float, run_each, run_arms};

}  // namespace mmbrdf::MMBRDF_ISA
