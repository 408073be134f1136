// SPDX-License-Identifier: BSD-3-Clause
// How long it takes to evaluate a model, and to analyse matrices, beside what the machine can do and what the textbook
// costs. Each line has
//   ns_per_evaluation   for one Mueller matrix; ns_per_matrix where one is analysed
//   slots               the same in units of the time in which this core does eight fused multiply-adds of doubles,
//                       measured around each benchmark: independent of the clock
#include "bench.hpp"

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  mmbrdf::bench::register_limits();
  mmbrdf::bench::register_textbook();
  mmbrdf::bench::register_evaluation();
  mmbrdf::bench::register_batches();
  mmbrdf::bench::register_analysis();
  mmbrdf::bench::register_reduction();
  mmbrdf::bench::register_influence();
  mmbrdf::bench::register_sampling();
  mmbrdf::bench::register_uncertainty();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
