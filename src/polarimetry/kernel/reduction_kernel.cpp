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

#define MMBRDF_TEXT(name) #name
#define MMBRDF_NAME(name) MMBRDF_TEXT(name)

}  // namespace

extern const ReductionKernel reduction_kernel;
const ReductionKernel reduction_kernel{MMBRDF_NAME(MMBRDF_ISA), runs_here, run_double, run_float};

}  // namespace mmbrdf::MMBRDF_ISA
