// SPDX-License-Identifier: BSD-3-Clause
// What callers of the library do, with the checks that this includes: one geometry at a time, and batches.
#include <thread>

#include "bench.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/model/batch.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf::bench {
namespace {

constexpr double wavelength = 0.532;

void evaluate_one(benchmark::State& state, Frame frame) {
  const PreparedModel prepared = prepare(material("ptfe"), wavelength);
  const std::vector<Geometry> geometries = random_geometries(1000, 1);
  Report report(state);
  std::size_t q = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(prepared.evaluate(geometries[q], frame));
    q = q + 1 < geometries.size() ? q + 1 : 0;
  }
  report.finish(1);
}

void evaluate_one_vector(benchmark::State& state) {
  const PreparedModel prepared = prepare(material("ptfe"), wavelength);
  std::vector<std::pair<Vector3, Vector3>> pairs;
  for (const Geometry& g : random_geometries(1000, 1))
    pairs.emplace_back(unit_vector(g.incident), unit_vector(g.reflected));
  Report report(state);
  std::size_t q = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(prepared.evaluate(pairs[q].first, pairs[q].second));
    q = q + 1 < pairs.size() ? q + 1 : 0;
  }
  report.finish(1);
}

void evaluate_one_at_prepared_incidence(benchmark::State& state) {
  const PreparedIncidence prepared = prepare(material("ptfe"), wavelength).at(Direction{0.5, 1});
  const std::vector<Geometry> geometries = random_geometries(1000, 1);
  Report report(state);
  std::size_t q = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(prepared.evaluate(geometries[q].reflected));
    q = q + 1 < geometries.size() ? q + 1 : 0;
  }
  report.finish(1);
}

/// Columns of unit vectors and room for their matrices.
template <class T>
struct Columns {
  std::array<std::vector<T>, 6> in;
  std::vector<T> out;
  explicit Columns(std::size_t count) : out(16 * count) {
    const std::vector<Geometry> geometries = random_geometries(10007, 1);
    for (auto& column : in) column.reserve(count);
    for (std::size_t q = 0; q < count; ++q) {
      const Geometry& g = geometries[q % geometries.size()];
      const Vector3 i = unit_vector(g.incident), r = unit_vector(g.reflected);
      for (std::size_t j = 0; j < 3; ++j) {
        in[j].push_back(static_cast<T>(i[j]));
        in[3 + j].push_back(static_cast<T>(r[j]));
      }
    }
  }
  UnitVectors<T> incident() const { return {in[0], in[1], in[2]}; }
  UnitVectors<T> reflected() const { return {in[3], in[4], in[5]}; }
  MuellerColumns<T> columns() {
    MuellerColumns<T> result;
    const std::size_t count = out.size() / 16;
    for (std::size_t e = 0; e < 16; ++e) result.elements[e] = std::span(out).subspan(e * count, count);
    return result;
  }
};

template <class T>
void evaluate_vectors(benchmark::State& state, std::size_t count, int threads, Frame frame = Frame::xy) {
  const PreparedModel prepared = prepare(material("ptfe"), wavelength);
  Columns<T> data(count);
  Report report(state, threads == 1 ? Clock::thread : Clock::wall);
  for (auto _ : state) {
    evaluate(prepared, {data.incident(), data.reflected()}, data.columns(), {.frame = frame, .threads = threads});
    benchmark::ClobberMemory();
  }
  report.finish(static_cast<double>(count));
}

template <class T>
void evaluate_incidence(benchmark::State& state, std::size_t count, int threads) {
  const PreparedIncidence prepared = prepare(material("ptfe"), wavelength).at(Direction{0.5, 1});
  Columns<T> data(count);
  Report report(state, threads == 1 ? Clock::thread : Clock::wall);
  for (auto _ : state) {
    evaluate(prepared, data.reflected(), data.columns(), {.threads = threads});
    benchmark::ClobberMemory();
  }
  report.finish(static_cast<double>(count));
}

void evaluate_angles(benchmark::State& state, std::size_t count, int threads, Frame frame) {
  const PreparedModel prepared = prepare(material("ptfe"), wavelength);
  const std::vector<Geometry> geometries = random_geometries(static_cast<int>(count), 1);
  std::vector<Mueller> out(count);
  Report report(state, threads == 1 ? Clock::thread : Clock::wall);
  for (auto _ : state) {
    evaluate(prepared, geometries, out, {.frame = frame, .threads = threads});
    benchmark::ClobberMemory();
  }
  report.finish(static_cast<double>(count));
}

template <class Run>
void add(const std::string& name, Run run) {
  benchmark::RegisterBenchmark(name.c_str(), run)->UseRealTime();
}

}  // namespace

void register_batches() {
  add("evaluate_one/xy", [](benchmark::State& state) { evaluate_one(state, Frame::xy); });
  add("evaluate_one/sp", [](benchmark::State& state) { evaluate_one(state, Frame::sp); });
  add("evaluate_one/scattering_plane", [](benchmark::State& state) { evaluate_one(state, Frame::scattering_plane); });
  add("evaluate_one/vectors", evaluate_one_vector);
  add("evaluate_one/prepared_incidence", evaluate_one_at_prepared_incidence);
  add("evaluate_isotropic/batch/double/cache", [](benchmark::State& s) { evaluate_vectors<double>(s, in_cache, 1); });
  add("evaluate_isotropic/batch/angles/cache", [](benchmark::State& s) { evaluate_angles(s, in_cache, 1, Frame::xy); });
  for (const Frame frame : {Frame::sp, Frame::scattering_plane}) {
    const std::string name = "evaluate_isotropic/batch/frame/" + to_string(frame);
    add(name + "/angles", [=](benchmark::State& s) { evaluate_angles(s, in_cache, 1, frame); });
    add(name + "/double", [=](benchmark::State& s) { evaluate_vectors<double>(s, in_cache, 1, frame); });
    add(name + "/float", [=](benchmark::State& s) { evaluate_vectors<float>(s, in_cache, 1, frame); });
  }
  for (const int threads : {1, 2}) {
    const std::string memory = "/memory/" + std::to_string(threads);
    add("evaluate_isotropic/batch/double" + memory,
        [=](benchmark::State& s) { evaluate_vectors<double>(s, beyond_cache, threads); });
    add("evaluate_isotropic/batch/float" + memory,
        [=](benchmark::State& s) { evaluate_vectors<float>(s, beyond_cache, threads); });
    add("evaluate_isotropic/batch/angles" + memory,
        [=](benchmark::State& s) { evaluate_angles(s, beyond_cache, threads, Frame::xy); });
    add("evaluate_prepared_incidence/batch/double" + memory,
        [=](benchmark::State& s) { evaluate_incidence<double>(s, beyond_cache, threads); });
  }
}

}  // namespace mmbrdf::bench
