// SPDX-License-Identifier: BSD-3-Clause
/// Any list of products K_a(i) K_b(r): every family at every order.
///
/// Products come in pairs, S, D = K_a(i) K_b(r) ± K_b(i) K_a(r). Since all families are reciprocal, an element and its
/// transpose share coefficients: f_ij = S-sum + D-sum, f_ji = ±(S-sum − D-sum), so each coefficient costs one fma for
/// both. Pairs that feed the same elements form a run, whose sums stay in registers.
#pragma once

#include "model/kernel/kernel_geometry.hpp"

namespace mmbrdf::MMBRDF_ISA {
namespace {

/// Packs that are evaluated together, so that each coefficient is read once for both. Two need the 32 registers of
/// AVX-512.
#if defined(__AVX512F__)
constexpr int packs_together = 2;
#else
constexpr int packs_together = 1;
#endif

/// A table of K, or sums, for the packs side by side.
template <class R>
struct Together {
  R pack[packs_together];
};

/// Re Z_n^k at (n, k) and Im Z_n^k at (n, −k), by the recurrence of zernike.cpp; norms are in the coefficients. Several
/// tables at once, since each step waits for the one before.
template <int tables, class R>
void zernike_values(int order, const Complex<R>* const (&points)[tables], Together<R>* const (&values)[tables]) {
  const auto for_each = [](auto step) {
    for (int t = 0; t < tables; ++t)
      for (int h = 0; h < packs_together; ++h) step(t, h);
  };
  const auto at = [&](int t, int h, int n, int k) -> R& { return values[t][(n * (n + 2) + k) / 2].pack[h]; };
  for_each([&](int t, int h) { at(t, h, 0, 0) = R(1); });
  for (int n = 1; n <= order; ++n) {
    if (n % 2 == 0)
      for_each([&](int t, int h) {
        const Complex<R> w = points[t][h];
        const R half = fma(w.re, at(t, h, n - 1, 1), w.im * at(t, h, n - 1, -1));
        at(t, h, n, 0) = half + half - at(t, h, n - 2, 0);
      });
    for (int k = 2 - n % 2; k <= n; k += 2)
      for_each([&](int t, int h) {
        const Complex<R> w = points[t][h];
        const R below_im = k == 1 ? R(0) : at(t, h, n - 1, 1 - k);
        Complex<R> z = w * Complex<R>{at(t, h, n - 1, k - 1), below_im};
        if (k < n) {
          const Complex<R> above{at(t, h, n - 1, k + 1), at(t, h, n - 1, -k - 1)};
          const Complex<R> before{at(t, h, n - 2, k), at(t, h, n - 2, -k)};
          z = fma(conj(w), above, z);
          z = {z.re - before.re, z.im - before.im};
        }
        at(t, h, n, k) = z.re;
        at(t, h, n, -k) = z.im;
      });
  }
}

/// A coefficient of each pack: one for all at a folded wavelength, kept in a register, since gcc would read it again
/// for each use.
template <class R, class C>
MMBRDF_INLINE auto read_once(const C* a, int i) {
  if constexpr (C::same_for_all_packs) {
    R value = a[0](i);
    keep_in_register(value);
    return [value](int) { return value; };
  } else {
    return [a, i](int h) { return a[h](i); };
  }
}

/// One run with its numbers of sums over S and over D; a holds the coefficients for each pack.
template <int sums, int differences, class R, class C>
void add_run(const C* a, const PairRun& run, const KernelPair* pairs, const Together<R>* k_i, const Together<R>* k_r,
             Together<R>* total) {
  constexpr int each = sums + differences;
  R sum[packs_together][each];
  for (auto& of_pack : sum)
    for (R& e : of_pack) e = R(0);
  int c = run.coefficients;
  for (const KernelPair* ab = pairs + run.begin; ab != pairs + run.end; ++ab, c += each) {
    R s[packs_together], d[packs_together];
    for (int h = 0; h < packs_together; ++h) {
      const R first = k_i[ab->a].pack[h] * k_r[ab->b].pack[h], b_i = k_i[ab->b].pack[h], a_r = k_r[ab->a].pack[h];
      s[h] = fma(b_i, a_r, first);
      d[h] = fnma(b_i, a_r, first);
    }
    for (int e = 0; e < each; ++e) {
      const auto coefficient = read_once<R>(a, c + e);
      for (int h = 0; h < packs_together; ++h) sum[h][e] = fma(coefficient(h), e < sums ? s[h] : d[h], sum[h][e]);
    }
  }
  for (int h = 0; h < packs_together; ++h)
    for (int e = 0; e < each; ++e) total[run.target[e]].pack[h] = total[run.target[e]].pack[h] + sum[h][e];
}

template <int sums, class R, class C>
void add_run_of(const C* a, const PairRun& run, const KernelPair* pairs, const Together<R>* k_i, const Together<R>* k_r,
                Together<R>* total) {
  switch (run.differences) {
    case 0:
      if constexpr (sums > 0) add_run<sums, 0>(a, run, pairs, k_i, k_r, total);
      break;
    case 1:
      return add_run<sums, 1>(a, run, pairs, k_i, k_r, total);
    case 2:
      return add_run<sums, 2>(a, run, pairs, k_i, k_r, total);
    case 3:
      return add_run<sums, 3>(a, run, pairs, k_i, k_r, total);
    default:
      return add_run<sums, 4>(a, run, pairs, k_i, k_r, total);
  }
}

template <class R, class C>
void add_any_run(const C* a, const PairRun& run, const KernelPair* pairs, const Together<R>* k_i,
                 const Together<R>* k_r, Together<R>* total) {
  switch (run.sums) {
    case 0:
      return add_run_of<0>(a, run, pairs, k_i, k_r, total);
    case 1:
      return add_run_of<1>(a, run, pairs, k_i, k_r, total);
    case 2:
      return add_run_of<2>(a, run, pairs, k_i, k_r, total);
    case 3:
      return add_run_of<3>(a, run, pairs, k_i, k_r, total);
    default:
      return add_run_of<4>(a, run, pairs, k_i, k_r, total);
  }
}

/// Points w_i, w_r of the disc, coefficients and scale of each pack.
template <class R, class C>
void pairs(const C* a, const PairList& list, const R* scale, const Complex<R>* w_i, const Complex<R>* w_r, R (*f)[16]) {
  Together<R> k_i[max_table], k_r[max_table], total[16];
  zernike_values<2>(list.order, {w_i, w_r}, {k_i, k_r});
  for (Together<R>& t : total)
    for (R& pack : t.pack) pack = R(0);
  for (const PairRun* run = list.runs; run != list.runs + list.count; ++run)
    add_any_run(a, *run, list.pairs, k_i, k_r, total);
  for (int h = 0; h < packs_together; ++h) {
    const R f11 = scale[h] * total[0].pack[h];
    const auto put = [&]<int row, int column>() {
      put_exchanged<row, column>(f11, total[4 * row + column].pack[h], total[4 * column + row].pack[h], f[h]);
    };
    put.template operator()<0, 1>();
    put.template operator()<0, 2>();
    put.template operator()<0, 3>();
    put.template operator()<1, 2>();
    put.template operator()<1, 3>();
    put.template operator()<2, 3>();
    for (int e = 5; e < 16; e += 5) f[h][e] = f11 * total[e].pack[h];
    f[h][0] = f11;
  }
}

}  // namespace
}  // namespace mmbrdf::MMBRDF_ISA
