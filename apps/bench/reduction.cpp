// SPDX-License-Identifier: BSD-3-Clause
// Readings to matrices: by each kernel, by one call of the library for one pixel, and for an image.
#include <cmath>
#include <random>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "bench.hpp"
#include "mmbrdf/polarimetry/reduction.hpp"
#include "polarimetry/kernel/reduction_kernels.hpp"

namespace mmbrdf::bench {
namespace {

template <class Number>
std::vector<Number> random_numbers(std::size_t count) {
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<Number> uniform;
  std::vector<Number> result(count);
  for (Number& number : result) number = uniform(engine);
  return result;
}

/// So many readings of generator and analyzer states that are all different.
Polarimeter instrument(std::size_t readings) {
  std::vector<double> azimuths;
  for (std::size_t k = 0; k < readings; ++k) azimuths.push_back(0.37 * static_cast<double>(k));
  Polarimeter result = ideal_polarimeter(2.3, azimuths);
  for (std::size_t k = 0; k < readings; ++k) result.pairs.push_back({k, 5 * k % readings});
  return result;
}

template <class Number>
void by_kernel(benchmark::State& state, const ReductionKernel& kernel, std::size_t n) {
  constexpr std::size_t count = 48;  // in the nearest cache
  const std::vector<double> inverse = random_numbers<double>(16 * n);
  const std::vector<Number> readings = random_numbers<Number>(n * count);
  std::vector<Number> elements(16 * count);
  std::vector<double> room(n * count);
  Report report(state);
  for (auto _ : state) {
    if constexpr (std::is_same_v<Number, float>)
      kernel.run_float(inverse.data(), n, readings.data(), count, elements.data(), room.data());
    else
      kernel.run_double(inverse.data(), n, readings.data(), count, elements.data());
    benchmark::ClobberMemory();
  }
  report.finish(static_cast<double>(count), "matrix");
}

void one_by_one(benchmark::State& state, std::size_t n) {
  const Reduction reduction(instrument(n));
  const std::vector<double> readings = random_numbers<double>(n * in_cache);
  Report report(state);
  for (auto _ : state)
    for (std::size_t q = 0; q < in_cache; ++q)
      benchmark::DoNotOptimize(reduction.mueller(std::span(readings).subspan(n * q, n)));
  report.finish(static_cast<double>(in_cache), "matrix");
}

template <class Number>
void batch(benchmark::State& state, std::size_t n, std::size_t count, int threads) {
  const Reduction reduction(instrument(n));
  const std::vector<Number> readings = random_numbers<Number>(n * count);
  std::vector<Number> elements(16 * count);
  Report report(state, threads == 1 ? Clock::thread : Clock::wall);
  for (auto _ : state) {
    reduction.muellers(readings, std::span<Number>(elements), {.threads = threads});
    benchmark::ClobberMemory();
  }
  report.finish(static_cast<double>(count), "matrix");
}

template <class Number>
void add(std::size_t n, const char* precision) {
  const std::string start = "reduce/" + std::to_string(n) + "/";
  const auto add_one = [&](const std::string& name, auto run) {
    benchmark::RegisterBenchmark((start + name + precision).c_str(), run);
  };
  for (const ReductionKernel* kernel : reduction_kernels())
    if (kernel->runs_here())
      add_one(std::string(kernel->name) + "/", [=](benchmark::State& s) { by_kernel<Number>(s, *kernel, n); });
  add_one("batch/", [=](benchmark::State& s) { batch<Number>(s, n, in_cache, 1); });
  for (const int threads : {1, 2})
    add_one("memory/" + std::to_string(threads) + "/",
            [=](benchmark::State& s) { batch<Number>(s, n, beyond_cache, threads); });
}

}  // namespace

void register_reduction() {
  for (const std::size_t n : {16U, 36U, 61U}) {
    add<double>(n, "double");
    add<float>(n, "float");
    benchmark::RegisterBenchmark(("reduce/" + std::to_string(n) + "/one").c_str(),
                                 [=](benchmark::State& s) { one_by_one(s, n); });
  }
}

}  // namespace mmbrdf::bench
