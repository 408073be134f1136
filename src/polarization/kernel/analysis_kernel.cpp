// SPDX-License-Identifier: BSD-3-Clause
// Compiled once for each instruction set, with MMBRDF_ISA as its name.
#include "polarization/kernel/analysis_kernel.hpp"

#include "polarization/kernel/coherency_pack.hpp"
#include "polarization/kernel/logarithm_pack.hpp"
#include "polarization/kernel/matrix_pack.hpp"
#include "polarization/kernel/polar_pack.hpp"
#include "polarization/kernel/symmetric_pack.hpp"

namespace mmbrdf::MMBRDF_ISA {
namespace {

// As in analysis.hpp.
constexpr double realizability_tolerance = 1e-12;

constexpr int width = R::width;

MMBRDF_INLINE R squares_but_first(const R (&m)[16]) {
  R sum = m[1] * m[1];
  for (int e = 2; e < 16; ++e) sum = fma(m[e], m[e], sum);
  return sum;
}

/// Of a vector, whose squares may be too small for a number.
MMBRDF_INLINE R length(R a, R b, R c) {
  R largest(0x1p-1000);
  const R parts[] = {a, b, c};
  for (const R& part : parts) largest = select(absolute(part).v > largest.v, absolute(part), largest);
  const R scale = R(1.0) / largest, x = scale * a, y = scale * b, z = scale * c;
  return largest * sqrt(fma(x, x, fma(y, y, z * z)));
}

MMBRDF_INLINE R depolarization(const R (&m)[16]) { return sqrt(squares_but_first(m) * R(1.0 / 3)) / m[0]; }

MMBRDF_INLINE Mask realizable(const R (&m)[16]) {
  return is_positive_definite(four_times_coherency(m), R(4 * realizability_tolerance) * m[0]);
}

MMBRDF_INLINE R diattenuation(const R (&m)[16]) { return length(m[1], m[2], m[3]) / m[0]; }
MMBRDF_INLINE R polarizance(const R (&m)[16]) { return length(m[4], m[8], m[12]) / m[0]; }

MMBRDF_INLINE R purity(const R (&m)[16]) {
  const R purity = fma(R(0.25), squares_but_first(m) / m[0] / m[0], R(0.25)), largest(0x1.fffffffffffffp+1023);
  return select(purity.v < largest.v, purity, largest);
}

/// Of 4 T, rising.
MMBRDF_INLINE void eigenvalues(const R (&m)[16], R (&values)[4]) {
  HermitianPack t = four_times_coherency(m);
  NoVectors none;
  diagonalize(t, none);
  for (int q = 0; q < 4; ++q) values[q] = t.diagonal[q];
  sort_rising(values, [](Mask, int, int) {});
}

MMBRDF_INLINE void eigenvectors(const R (&m)[16], R (&values)[4], VectorsPack& vectors) {
  HermitianPack t = four_times_coherency(m);
  diagonalize(t, vectors);
  for (int q = 0; q < 4; ++q) values[q] = t.diagonal[q];
  sort_rising(values, [&](Mask wrong, int low, int high) {
    for (int k = 0; k < 16; k += 4) {
      C &x = vectors.v[k + low], &y = vectors.v[k + high];
      const C old = x;
      x = {select(wrong, y.re, x.re), select(wrong, y.im, x.im)};
      y = {select(wrong, old.re, y.re), select(wrong, old.im, y.im)};
    }
  });
}

MMBRDF_INLINE R realizability_margin(const R (&m)[16], const R (&of_coherency)[4]) {
  return R(0.25) * of_coherency[0] / m[0];
}

/// −Σ p log₄ p of the nearest realizable matrix.
MMBRDF_INLINE R entropy(const R (&m)[16], const R (&values)[4]) {
  R p[4], sum(0.0);
  const R trace = R(4.0) * m[0];
  project_on_simplex(values, trace, p);
  for (const R& value : p) {
    const R part = value / trace;
    sum = fnma(select(part.v > 0.0, part, R(0.0)), R(0.5) * log2_of(select(part.v > 0.0, part, R(1.0))), sum);
  }
  sum = select(sum.v > 0.0, sum, R(0.0));
  return select(sum.v < 1.0, sum, R(1.0));
}

/// Adds weight v v† for column q.
MMBRDF_INLINE void add_projector(const VectorsPack& vectors, int q, R weight, HermitianPack& t) {
  int at = 0;
  for (int k = 0; k < 4; ++k) {
    const C v = vectors.v[4 * k + q], scaled{weight * v.re, weight * v.im};
    t.diagonal[k] = fma(scaled.re, v.re, fma(scaled.im, v.im, t.diagonal[k]));
    for (int l = k + 1; l < 4; ++l, ++at) {
      const C product = times_conj(scaled, vectors.v[4 * l + q]);
      t.above[at] = {t.above[at].re + product.re, t.above[at].im + product.im};
    }
  }
}

MMBRDF_INLINE HermitianPack no_coherency() {
  HermitianPack t;
  for (R& d : t.diagonal) d = R(0.0);
  for (C& z : t.above) z = {R(0.0), R(0.0)};
  return t;
}

// One Pack of matrices: `from` to `out`; returns the lanes that have an answer.

/// What has no meaning without an intensity.
template <class Value>
MMBRDF_INLINE Mask relative(const double* from, double* out, Value value) {
  const ScaledPack scaled(from);
  store(value(scaled.m), out);
  return scaled.has_intensity();
}

Mask realizable(const double* from, double* out) {
  const ScaledPack scaled(from);
  store(select(realizable(scaled.m), R(1.0), R(0.0)), out);
  return scaled.ordinary;
}

Mask nearest_realizable(const double* from, double* out) {
  const ScaledPack scaled(from);
  const Mask possible = realizable(scaled.m) | ~scaled.ordinary;
  R m[16], change(0.0);
  load_matrices(from, m);
  if (any(~possible)) {
    R values[4], weights[4], nearest[16], sum(0.0);
    VectorsPack vectors;
    HermitianPack t = no_coherency();
    eigenvectors(scaled.m, values, vectors);
    project_on_simplex(values, R(4.0) * scaled.m[0], weights);
    for (int q = 0; q < 4; ++q) {
      const R difference = weights[q] - values[q];
      sum = fma(difference, difference, sum);
      add_projector(vectors, q, weights[q], t);
    }
    matrix_of(t, nearest);
    for (int e = 1; e < 16; ++e) m[e] = select(possible, m[e], scaled.back * nearest[e]);
    change = select(possible, change, (R(0.5) * scaled.back) * sqrt(sum));  // Σ M_ij² = 4 tr T²
  }
  store_matrices(m, out, 17);
  store_numbers(&change, 1, out + 16, 17);
  return scaled.ordinary & (scaled.m[0].v >= 0.0);
}

Mask cloude_decomposition(const double* from, double* out) {
  const ScaledPack scaled(from);
  R values[4], weights[4];
  VectorsPack vectors;
  eigenvectors(scaled.m, values, vectors);
  for (int q = 0; q < 4; ++q) {
    const int column = 3 - q;
    weights[q] = (R(0.25) * scaled.back) * values[column];
    HermitianPack t = no_coherency();
    R component[16];
    add_projector(vectors, column, R(4.0), t);
    matrix_of(t, component);
    const R inverse = R(1.0) / component[0];
    component[0] = R(1.0);
    for (int e = 1; e < 16; ++e) component[e] = inverse * component[e];
    store_matrices(component, out + 4 + 16 * q, 68);
  }
  store_numbers(weights, 4, out, 68);
  return scaled.ordinary;
}

/// What can be decomposed, over its M11; 1 elsewhere.
struct DecomposablePack {
  R n[16], intensity;
  Mask possible;

  MMBRDF_INLINE explicit DecomposablePack(const double* from) {
    const ScaledPack scaled(from);
    possible = scaled.has_intensity() & realizable(scaled.m);
    intensity = scaled.back * scaled.m[0];
    const R inverse = R(1.0) / select(possible, scaled.m[0], R(1.0));
    for (int e = 0; e < 16; ++e) n[e] = select(possible, inverse * scaled.m[e], R(e % 5 == 0 ? 1.0 : 0.0));
  }
};

Mask lu_chipman(const double* from, double* out) {
  const DecomposablePack m(from);
  R depolarizer[16], retarder[16], diattenuator[16];
  const Mask regular = lu_chipman(m.n, m.intensity, depolarizer, retarder, diattenuator);
  store_matrices(depolarizer, out, 48);
  store_matrices(retarder, out + 16, 48);
  store_matrices(diattenuator, out + 32, 48);
  return m.possible & regular;
}

Mask symmetric_decomposition(const double* from, double* out) {
  const DecomposablePack m(from);
  SymmetricPack factors;
  const Mask regular = symmetric_decomposition(m.n, m.intensity, factors);
  store_matrices(factors.diattenuator2, out, 80);
  store_matrices(factors.retarder2, out + 16, 80);
  store_matrices(factors.depolarizer, out + 32, 80);
  store_matrices(factors.retarder1, out + 48, 80);
  store_matrices(factors.diattenuator1, out + 64, 80);
  return m.possible & regular;
}

Mask coherency_eigenvalues(const double* from, double* out) {
  const ScaledPack scaled(from);
  R values[4];
  eigenvalues(scaled.m, values);
  for (R& value : values) value = (R(0.25) * scaled.back) * value;
  store_numbers(values, 4, out, 4);
  return scaled.ordinary;
}

Mask ratios(const double* from, double* out) {
  const ScaledPack scaled(from);
  R values[4];
  eigenvalues(scaled.m, values);
  const R all[] = {depolarization(scaled.m),
                   diattenuation(scaled.m),
                   polarizance(scaled.m),
                   purity(scaled.m),
                   realizability_margin(scaled.m, values),
                   entropy(scaled.m, values)};
  store_numbers(all, 6, out, 6);
  return scaled.has_intensity();
}

/// The common path; what is over at the end is done in a Pack of its own.
template <class Work>
bool run(Work work, size_t numbers, const double* from, size_t count, double* out, unsigned char* left) {
  Mask some = R(0.0).v > 0.0;
  const auto pack = [&](const double* matrices, double* to, unsigned char* flags, size_t lanes) {
    const Mask answered = work(matrices, to);
    for (size_t lane = 0; lane < lanes; ++lane) flags[lane] = answered[lane] == 0;
    some |= ~answered;
  };
  size_t q = 0;
  for (; q + width <= count; q += width) pack(from + 16 * q, out + numbers * q, left + q, width);
  if (q < count) {
    double matrices[16 * width], results[most_numbers * width];
    for (size_t lane = 0; lane < width; ++lane) {
      const double* const matrix = from + 16 * (q + lane < count ? q + lane : count - 1);
      for (size_t e = 0; e < 16; ++e) matrices[16 * lane + e] = matrix[e];
    }
    pack(matrices, results, left + q, count - q);
    for (size_t i = 0; i < numbers * (count - q); ++i) out[numbers * q + i] = results[i];
  }
  return any(some);
}

bool run(Analysis analysis, const double* from, size_t count, double* out, unsigned char* left) {
  const size_t numbers = numbers_of[static_cast<size_t>(analysis)];
  const auto number = [&](auto value) {
    return run([value](const double* m, double* to) { return relative(m, to, value); }, 1, from, count, out, left);
  };
  switch (analysis) {
    case Analysis::realizable:
      return run([](const double* m, double* to) { return realizable(m, to); }, 1, from, count, out, left);
    case Analysis::depolarization:
      return number([](const R(&m)[16]) { return depolarization(m); });
    case Analysis::diattenuation:
      return number([](const R(&m)[16]) { return diattenuation(m); });
    case Analysis::polarizance:
      return number([](const R(&m)[16]) { return polarizance(m); });
    case Analysis::purity:
      return number([](const R(&m)[16]) { return purity(m); });
    case Analysis::realizability_margin:
      return number([](const R(&m)[16]) {
        R values[4];
        eigenvalues(m, values);
        return realizability_margin(m, values);
      });
    case Analysis::entropy:
      return number([](const R(&m)[16]) {
        R values[4];
        eigenvalues(m, values);
        return entropy(m, values);
      });
    case Analysis::coherency_eigenvalues:
      return run(coherency_eigenvalues, numbers, from, count, out, left);
    case Analysis::nearest_realizable:
      return run(nearest_realizable, numbers, from, count, out, left);
    case Analysis::cloude_decomposition:
      return run(cloude_decomposition, numbers, from, count, out, left);
    case Analysis::lu_chipman:
      return run([](const double* m, double* to) { return lu_chipman(m, to); }, numbers, from, count, out, left);
    case Analysis::symmetric_decomposition:
      return run([](const double* m, double* to) { return symmetric_decomposition(m, to); }, numbers, from, count, out,
                 left);
    case Analysis::ratios:
      return run(ratios, numbers, from, count, out, left);
  }
  return false;
}

#define MMBRDF_TEXT(name) #name
#define MMBRDF_NAME(name) MMBRDF_TEXT(name)

}  // namespace

extern const AnalysisKernel analysis_kernel;
const AnalysisKernel analysis_kernel{MMBRDF_NAME(MMBRDF_ISA), runs_here, run};

}  // namespace mmbrdf::MMBRDF_ISA
