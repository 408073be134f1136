// SPDX-License-Identifier: BSD-3-Clause
// How long it takes to prepare and to evaluate the built-in model ptfe. items_per_second counts Mueller matrices.

#include <benchmark/benchmark.h>
#include <mmbrdf/dataset.hpp>
#include <mmbrdf/materials.hpp>
#include <mmbrdf/model.hpp>

#include <cstdint>
#include <vector>

namespace {

using namespace mmbrdf;

constexpr double wavelength = 0.532;
constexpr std::size_t count = 4096;  // geometries and their matrices stay in the second-level cache

std::vector<Geometry> sample_geometries() { return random_geometries(static_cast<int>(count), 1, radians(80)); }

void count_matrices(benchmark::State& state, std::size_t for_each_iteration) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(for_each_iteration));
}

void prepare_model(benchmark::State& state) {
  const Model model = material("ptfe");
  for (auto _ : state) benchmark::DoNotOptimize(prepare(model, wavelength));
}
BENCHMARK(prepare_model);

void evaluate_one(benchmark::State& state) {
  const PreparedModel prepared = prepare(material("ptfe"), wavelength);
  const std::vector<Geometry> geometries = sample_geometries();
  const auto frame = static_cast<Frame>(state.range(0));
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(prepared.evaluate(geometries[i++ % count], frame));
  count_matrices(state, 1);
}
BENCHMARK(evaluate_one)
    ->ArgName("frame")
    ->Arg(static_cast<int>(Frame::xy))
    ->Arg(static_cast<int>(Frame::sp))
    ->Arg(static_cast<int>(Frame::scattering_plane));

void evaluate_many(benchmark::State& state) {
  const PreparedModel prepared = prepare(material("ptfe"), wavelength);
  const std::vector<Geometry> geometries = sample_geometries();
  std::vector<Mueller> out(count);
  for (auto _ : state) {
    prepared.evaluate(geometries, Frame::xy, out);
    benchmark::ClobberMemory();
  }
  count_matrices(state, count);
}
BENCHMARK(evaluate_many);

void evaluate_many_at_one_incident_direction(benchmark::State& state) {
  const PreparedIncidence prepared = prepare(material("ptfe"), wavelength).at(Direction{radians(45), 0});
  std::vector<Direction> reflected;
  for (const Geometry& geometry : sample_geometries()) reflected.push_back(geometry.reflected);
  std::vector<Mueller> out(count);
  for (auto _ : state) {
    prepared.evaluate(reflected, Frame::xy, out);
    benchmark::ClobberMemory();
  }
  count_matrices(state, count);
}
BENCHMARK(evaluate_many_at_one_incident_direction);

}  // namespace

BENCHMARK_MAIN();
