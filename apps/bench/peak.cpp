// SPDX-License-Identifier: BSD-3-Clause
// Compiled once for each instruction set, as src/model/kernel/kernel.cpp is.
#include "numerics/pack.hpp"

namespace mmbrdf::MMBRDF_ISA {
namespace {

/// Twelve chains hide the latency of an operation and still fit the 16 registers of AVX2.
template <class T>
void multiply_and_add(long rounds) {
  using R = Pack<T>;
  R a[12];
  for (int i = 0; i < 12; ++i) a[i] = R(T(i));
  R factor(T(0.5)), term(T(1));
  asm volatile("" : "+x"(factor.v), "+x"(term.v));  // unknown to the optimiser, which would do the sum otherwise
  for (long round = 0; round < rounds; ++round)
    for (R& chain : a) chain = fma(chain, factor, term);
  for (R& chain : a) asm volatile("" : : "x"(chain.v));
}

}  // namespace

extern const int peak_doubles, peak_floats;
extern void (*const peak_double)(long);
extern void (*const peak_float)(long);
const int peak_doubles = Pack<double>::width, peak_floats = Pack<float>::width;
void (*const peak_double)(long) = multiply_and_add<double>;
void (*const peak_float)(long) = multiply_and_add<float>;

}  // namespace mmbrdf::MMBRDF_ISA
