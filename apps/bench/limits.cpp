// SPDX-License-Identifier: BSD-3-Clause
// The machine's limits, measured in the same run as all else.
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <functional>
#include <thread>

#include "bench.hpp"

namespace mmbrdf {

#define MMBRDF_PEAK_OF(isa)                   \
  namespace isa {                             \
  extern const int peak_doubles, peak_floats; \
  extern void (*const peak_double)(long);     \
  extern void (*const peak_float)(long);      \
  }
MMBRDF_PEAK_OF(baseline)
#ifdef MMBRDF_X86
MMBRDF_PEAK_OF(avx2)
MMBRDF_PEAK_OF(avx512)
#endif

namespace bench {

std::vector<const Kernel*> kernels_that_run_here() {
  std::vector<const Kernel*> list;
  for (const Kernel* kernel : kernels())
    if (kernel->runs_here()) list.push_back(kernel);
  return list;
}

std::vector<PeakLoop> peak_loops() {
  std::vector<PeakLoop> all{
      {"baseline", baseline::peak_doubles, baseline::peak_floats, baseline::peak_double, baseline::peak_float}};
#ifdef MMBRDF_X86
  all.push_back({"avx2", avx2::peak_doubles, avx2::peak_floats, avx2::peak_double, avx2::peak_float});
  all.push_back({"avx512", avx512::peak_doubles, avx512::peak_floats, avx512::peak_double, avx512::peak_float});
#endif
  std::vector<PeakLoop> here;
  for (const Kernel* kernel : kernels_that_run_here())
    for (const PeakLoop& loop : all)
      if (std::strcmp(kernel->name, loop.name) == 0) here.push_back(loop);
  return here;
}

double thread_seconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double slot_seconds() {
  static const PeakLoop loop = peak_loops().front();
  constexpr long rounds = 20000;
  std::array<double, 9> seconds;
  for (double& s : seconds) {
    const double begin = thread_seconds();
    loop.run_double(rounds);
    s = thread_seconds() - begin;
  }
  std::sort(seconds.begin(), seconds.end());
  return seconds[seconds.size() / 2] * 8 / (static_cast<double>(rounds) * each_round * loop.doubles);
}

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Report::Report(benchmark::State& state, Clock clock)
    : state_(state), clock_(clock), slot_(slot_seconds()), begin_(now()) {}

double Report::now() const { return clock_ == Clock::thread ? thread_seconds() : wall_seconds(); }

double Report::finish(double evaluations, const std::string& unit) {
  const double seconds = (now() - begin_) / (evaluations * static_cast<double>(state_.iterations()));
  state_.counters["ns_per_" + unit] = 1e9 * seconds;
  state_.counters["slots"] = seconds / (0.5 * (slot_ + slot_seconds()));
  return seconds;
}

namespace {

/// Here an evaluation is eight operations, of whatever precision.
void fma_peak(benchmark::State& state, const PeakLoop& loop, bool is_double) {
  constexpr long rounds = 20000;
  Report report(state);
  for (auto _ : state) (is_double ? loop.run_double : loop.run_float)(rounds);
  const double operations = static_cast<double>(rounds) * each_round * (is_double ? loop.doubles : loop.floats);
  state.counters["GFLOP/s"] = 16e-9 / report.finish(operations / 8);
}

/// Reads six numbers and writes sixteen for each evaluation, as many as unit vectors and their matrices have.
void copy_part(const std::vector<double>& from, std::vector<double>& to, std::size_t begin, std::size_t end) {
  const std::size_t count = to.size() / 16;
  for (std::size_t e = 0; e < 16; ++e)
    std::memcpy(to.data() + e * count + begin, from.data() + e % 6 * count + begin, (end - begin) * sizeof(double));
}

void copy(benchmark::State& state, std::size_t count, std::size_t threads) {
  const std::vector<double> from(6 * count, 1.0);
  std::vector<double> to(16 * count);
  Report report(state, threads == 1 ? Clock::thread : Clock::wall);
  constexpr std::size_t block = 512;  // so that the six columns are read from memory once
  for (auto _ : state) {
    std::vector<std::jthread> others;
    const auto part = [&](std::size_t t) {
      for (std::size_t q = count * t / threads; q < count * (t + 1) / threads; q += block)
        copy_part(from, to, q, std::min(q + block, count * (t + 1) / threads));
    };
    for (std::size_t t = 1; t < threads; ++t) others.emplace_back(part, t);
    part(0);
    others.clear();
    benchmark::ClobberMemory();
  }
  state.counters["GB/s"] = 1e-9 * 22 * sizeof(double) / report.finish(static_cast<double>(count));
}

}  // namespace

void register_limits() {
  for (const PeakLoop& loop : peak_loops())
    for (const bool is_double : {true, false})
      benchmark::RegisterBenchmark(("fma_peak/" + std::string(loop.name) + (is_double ? "/double" : "/float")).c_str(),
                                   [=](benchmark::State& state) { fma_peak(state, loop, is_double); });
  benchmark::RegisterBenchmark("copy/cache", [](benchmark::State& state) { copy(state, in_cache, 1); });
  for (const std::size_t threads : {1u, 2u})
    benchmark::RegisterBenchmark(("copy/memory/" + std::to_string(threads)).c_str(), [=](benchmark::State& state) {
      copy(state, beyond_cache, threads);
    })->UseRealTime();
}

}  // namespace bench
}  // namespace mmbrdf
