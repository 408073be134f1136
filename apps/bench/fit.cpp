// SPDX-License-Identifier: BSD-3-Clause
// How long fits take: of samples as many as the published ones, and of a stream without end. rows_per_second counts
// samples.

#include <benchmark/benchmark.h>
#include <sys/resource.h>
#include <mmbrdf/files/materials.hpp>
#include <mmbrdf/fitting/fit.hpp>
#include <mmbrdf/samples/samples.hpp>
#include <mmbrdf/samples/simulation.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace {

using namespace mmbrdf;

constexpr double noise = 0.01;

/// The published geometries at four wavelengths, or others at each.
std::vector<Sample> four_wavelengths(bool shared) {
  const Model model = material("ptfe");
  if (shared) return simulate(model, model.validity.wavelengths, germer2017_grid(), noise, 1);
  std::vector<Sample> samples;
  unsigned long seed = 1;
  for (const double wavelength : model.validity.wavelengths) {
    const std::vector<Geometry> geometries = random_geometries(static_cast<int>(germer2017_grid().size()), seed);
    const std::vector<Sample> some = simulate(model, std::vector{wavelength}, geometries, noise, seed++);
    samples.insert(samples.end(), some.begin(), some.end());
  }
  return samples;
}

double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024;
}

void count_rows(benchmark::State& state, std::size_t for_each_iteration) {
  const double rows = static_cast<double>(state.iterations()) * static_cast<double>(for_each_iteration);
  using Counter = benchmark::Counter;
  state.counters["rows_per_second"] = Counter(rows, Counter::kIsRate);
  state.counters["ns_per_evaluation"] = Counter(rows * 1e-9, Counter::kIsRate | Counter::kInvert);  // of a row
}

/// From samples in memory to the model with its covariance, the reflectances being those of the data.
void fit_samples(benchmark::State& state, Family family, bool shared) {
  const std::vector<Sample> samples = four_wavelengths(shared);
  for (auto _ : state) {
    FitAccumulator accumulator({family, {7, 4}});
    accumulator.add(samples);
    benchmark::DoNotOptimize(accumulator.solve());
  }
  count_rows(state, samples.size());
}

/// Of a fit that holds the rows already.
void solve(benchmark::State& state, Family family, bool shared) {
  FitAccumulator accumulator({family, {7, 4}});
  const std::vector<Sample> samples = four_wavelengths(shared);
  accumulator.add(samples);
  for (auto _ : state) benchmark::DoNotOptimize(accumulator.solve());
  count_rows(state, samples.size());
}

/// Rows of 8192 random geometries at one wavelength, again and again: to a fit, rows are rows. peak_growth: memory that
/// was not needed by the first piece.
void fit_stream(benchmark::State& state, Family family) {
  constexpr int piece = 8192;
  const std::vector<Sample> samples =
      simulate(material("ptfe-532"), std::vector{0.532}, random_geometries(piece, 1), noise, 1);
  FitAccumulator accumulator({family, {7, 4}});
  accumulator.add(samples);
  const double before = peak_memory();
  for (auto _ : state) accumulator.add(samples);
  state.counters["peak_growth"] = peak_memory() - before;
  state.counters["peak_memory"] = peak_memory();
  state.counters["rows"] = static_cast<double>(accumulator.samples());
  count_rows(state, piece);
}

constexpr bool shared = true, general = false;
BENCHMARK_CAPTURE(fit_samples, shared, Family::germer2017, shared)->Name("fit_germer2017/shared");
BENCHMARK_CAPTURE(fit_samples, general, Family::germer2017, general)->Name("fit_germer2017/general");
BENCHMARK_CAPTURE(solve, shared, Family::germer2017, shared)->Name("fit_germer2017/shared/solve");
BENCHMARK_CAPTURE(solve, general, Family::germer2017, general)->Name("fit_germer2017/general/solve");
BENCHMARK_CAPTURE(fit_samples, shared, Family::isotropic, shared)->Name("fit_isotropic/shared");
BENCHMARK_CAPTURE(fit_samples, general, Family::isotropic, general)->Name("fit_isotropic/general");
BENCHMARK_CAPTURE(solve, shared, Family::isotropic, shared)->Name("fit_isotropic/shared/solve");
BENCHMARK_CAPTURE(solve, general, Family::isotropic, general)->Name("fit_isotropic/general/solve");
BENCHMARK_CAPTURE(fit_stream, germer2017, Family::germer2017)->Name("fit_stream/germer2017");
BENCHMARK_CAPTURE(fit_stream, isotropic, Family::isotropic)->Name("fit_stream/isotropic");

}  // namespace
