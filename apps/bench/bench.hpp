// SPDX-License-Identifier: BSD-3-Clause
/// What the benchmarks share: the machine's own limits, and how times are reported.
#pragma once

#include <benchmark/benchmark.h>

#include <array>
#include <string>
#include <vector>

#include "model/kernel/kernels.hpp"

namespace mmbrdf::bench {

/// A loop of nothing but independent fused multiply-adds (multiplications and additions where there are none), compiled
/// for one instruction set.
struct PeakLoop {
  const char* name;
  int doubles, floats;              ///< in a vector
  void (*run_double)(long rounds);  ///< `each_round` operations on vectors in each round
  void (*run_float)(long rounds);
};
inline constexpr int each_round = 12;

/// Those that run here, the widest first.
std::vector<PeakLoop> peak_loops();

/// CPU time of this thread in seconds.
double thread_seconds();

/// A slot: the seconds in which the fastest peak loop does eight fused multiply-adds of doubles. Measured now.
double slot_seconds();

/// Of one thread it is its own time that counts, which other programs do not change; of several the time on the wall.
enum class Clock { thread, wall };

/// Times the loop of a benchmark and reports `ns_per_evaluation`, or of another unit of work, and, with the slot measured before and after, `slots`.
class Report {
 public:
  explicit Report(benchmark::State& state, Clock clock = Clock::thread);  ///< just before the loop
  /// Just after it; seconds per evaluation, or whatever it is.
  double finish(double evaluations_each_iteration, const std::string& unit = "evaluation");

 private:
  double now() const;
  benchmark::State& state_;
  Clock clock_;
  double slot_, begin_;
};

std::vector<const Kernel*> kernels_that_run_here();

/// Geometries that stay in the second-level cache together with their matrices, 352 KB, or in no cache.
inline constexpr std::size_t in_cache = 2000, beyond_cache = 1 << 20;

void register_limits();
void register_textbook();
void register_evaluation();
void register_batches();
void register_analysis();
void register_influence();
void register_reduction();
void register_sampling();
void register_uncertainty();

}  // namespace mmbrdf::bench
