// SPDX-License-Identifier: BSD-3-Clause
// What is asked of matrices that are there: each analysis by each kernel, and by one call of the library for one
// matrix. Beside them, whether a matrix can exist, as a textbook may put it.
#include <cmath>
#include <complex>
#include <memory>
#include <random>

#include "bench.hpp"
#include "mmbrdf/polarization/analysis_batch.hpp"
#include "polarization/kernel/analysis_kernels.hpp"

namespace mmbrdf::bench {
namespace {

/// Sums of four Jones matrices of any kind, so that nothing is singular; of noisy ones a part cannot exist.
std::vector<Mueller> random_matrices(std::size_t count, double noise) {
  std::mt19937_64 engine(1);
  std::normal_distribution<double> normal;
  std::vector<Mueller> result(count);
  for (Mueller& m : result) {
    Coherency t{};
    for (int part = 0; part < 4; ++part) {
      std::array<std::complex<double>, 4> v;
      for (auto& z : v) z = {normal(engine), normal(engine)};
      const double weight = std::exp(2 * normal(engine));
      for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t column = 0; column < 4; ++column)
          t[4 * row + column] += weight * v[row] * std::conj(v[column]);
    }
    m = from_coherency(t);
    for (std::size_t e = 1; e < 16; ++e) m.elements[e] += noise * m(0, 0) * normal(engine);
  }
  return result;
}

struct Named {
  const char* name;
  Analysis analysis;
  double noise;
};
constexpr Named analyses[] = {
    {"realizable", Analysis::realizable, 0},
    {"depolarization", Analysis::depolarization, 0},
    {"diattenuation", Analysis::diattenuation, 0},
    {"purity", Analysis::purity, 0},
    {"entropy", Analysis::entropy, 0},
    {"ratios", Analysis::ratios, 0},
    {"coherency_eigenvalues", Analysis::coherency_eigenvalues, 0},
    {"nearest_realizable", Analysis::nearest_realizable, 0.3},
    {"cloude_decomposition", Analysis::cloude_decomposition, 0},
    {"lu_chipman", Analysis::lu_chipman, 0},
    {"symmetric_decomposition", Analysis::symmetric_decomposition, 0},
};

void analyze(benchmark::State& state, const AnalysisKernel& kernel, const Named& named) {
  const std::vector<Mueller> matrices = random_matrices(in_cache, named.noise);
  std::vector<double> out(in_cache * numbers_of[static_cast<std::size_t>(named.analysis)]);
  std::vector<unsigned char> left(in_cache);
  Report report(state);
  for (auto _ : state) {
    kernel.run(named.analysis, matrices[0].elements.data(), in_cache, out.data(), left.data());
    benchmark::ClobberMemory();
  }
  report.finish(static_cast<double>(in_cache), "matrix");
}

template <class One>
void one_by_one(benchmark::State& state, One one) {
  const std::vector<Mueller> matrices = random_matrices(in_cache, 0);
  Report report(state);
  for (auto _ : state)
    for (const Mueller& m : matrices) benchmark::DoNotOptimize(one(m));
  report.finish(static_cast<double>(in_cache), "matrix");
}

template <class Result, class Many>
void batch(benchmark::State& state, int threads, Many many) {
  constexpr std::size_t count = 1 << 18;
  const std::vector<Mueller> some = random_matrices(in_cache, 0);
  std::vector<Mueller> matrices;
  for (std::size_t q = 0; q < count; ++q) matrices.push_back(some[q % some.size()]);
  const auto out = std::make_unique<Result[]>(count);
  Report report(state, threads == 1 ? Clock::thread : Clock::wall);
  for (auto _ : state) {
    many(matrices, std::span<Result>(out.get(), count), MatricesOptions{.threads = threads});
    benchmark::ClobberMemory();
  }
  report.finish(static_cast<double>(count), "matrix");
}

/// Whether all coefficients of the characteristic polynomial of T alternate in sign, written in the elements of M: with
/// m11 = 1, polarizance p, diattenuation d and the rest C,
///   s = |p|² + |d|² + |C|²,  v = pᵀC d − |C|,  16 e₂ = 6 − 2 s,  64 e₃ = 4 (1 − s + 2 v),
///   256 e₄ = (1 − s)² + 8 v − 4 (|p|²|d|² + |Cᵀp|² + |C d|² + |cof C|² − 2 pᵀ cof C d)
/// after the signs that conj σ_j puts on the last column (Novikova et al. 2024 have the same polynomials).
bool realizable_by_polynomials(const Mueller& m) {
  const double f = 1 / m(0, 0);
  double p[3], d[3], c[3][3], cof[3][3];
  for (int i = 0; i < 3; ++i) {
    p[i] = f * m(i + 1, 0);
    d[i] = f * (i == 2 ? -m(0, 3) : m(0, i + 1));
    for (int j = 0; j < 3; ++j) c[i][j] = f * (j == 2 ? -m(i + 1, 3) : m(i + 1, j + 1));
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      cof[i][j] = c[(i + 1) % 3][(j + 1) % 3] * c[(i + 2) % 3][(j + 2) % 3] -
                  c[(i + 1) % 3][(j + 2) % 3] * c[(i + 2) % 3][(j + 1) % 3];
  double pp = 0, dd = 0, cc = 0, pcd = 0, cp = 0, cd = 0, ff = 0, pfd = 0;
  for (int i = 0; i < 3; ++i) {
    double c_d = 0, c_p = 0, f_d = 0;
    for (int j = 0; j < 3; ++j) {
      c_d += c[i][j] * d[j], c_p += c[j][i] * p[j], f_d += cof[i][j] * d[j];
      cc += c[i][j] * c[i][j], ff += cof[i][j] * cof[i][j];
    }
    pp += p[i] * p[i], dd += d[i] * d[i], pcd += p[i] * c_d, cd += c_d * c_d, cp += c_p * c_p, pfd += p[i] * f_d;
  }
  const double determinant = c[0][0] * cof[0][0] + c[0][1] * cof[0][1] + c[0][2] * cof[0][2];
  const double s = pp + dd + cc, v = pcd - determinant;
  return m(0, 0) > 0 && s <= 3 && 1 - s + 2 * v >= 0 &&
         (1 - s) * (1 - s) + 8 * v - 4 * (pp * dd + cp + cd + ff - 2 * pfd) >= 0;
}

}  // namespace

void register_analysis() {
  const auto add = [](const std::string& name, auto run) { benchmark::RegisterBenchmark(name.c_str(), run); };
  for (const Named& named : analyses)
    for (const AnalysisKernel* kernel : analysis_kernels())
      if (kernel->runs_here())
        add("analyze_" + std::string(named.name) + "/" + kernel->name + "/double",
            [=, &named](benchmark::State& state) { analyze(state, *kernel, named); });
  add("textbook/realizable", [](benchmark::State& state) { one_by_one(state, realizable_by_polynomials); });
  add("analyze_realizable/one",
      [](benchmark::State& s) { one_by_one(s, [](const Mueller& m) { return realizable(m); }); });
  add("analyze_lu_chipman/one",
      [](benchmark::State& s) { one_by_one(s, [](const Mueller& m) { return lu_chipman(m); }); });
  add("analyze_symmetric_decomposition/one",
      [](benchmark::State& s) { one_by_one(s, [](const Mueller& m) { return symmetric_decomposition(m); }); });
  for (const int threads : {1, 2}) {
    const std::string end = "/batch/" + std::to_string(threads);
    const auto add_batch =
        [&]<class Result>(const char* name,
                          std::size_t (*many)(std::span<const Mueller>, std::span<Result>, const MatricesOptions&)) {
          add("analyze_" + std::string(name) + end, [=](benchmark::State& s) { batch<Result>(s, threads, many); });
        };
    add_batch.operator()<bool>("realizable", realizable);
    add_batch.operator()<double>("entropy", entropy);
    add_batch.operator()<LuChipman>("lu_chipman", lu_chipman);
    add_batch.operator()<SymmetricDecomposition>("symmetric_decomposition", symmetric_decomposition);
  }
}

}  // namespace mmbrdf::bench
