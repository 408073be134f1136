// SPDX-License-Identifier: BSD-3-Clause
// Directions that are drawn for an incident one, by f11 and, to compare, by the cosine alone.
#include <cmath>
#include <numbers>
#include <random>

#include "bench.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/model/sampling.hpp"
#include "mmbrdf/samples/samples.hpp"
#include "models.hpp"

namespace mmbrdf::bench {
namespace {

const DirectionSampler& sampler_of(Family family) {
  static const DirectionSampler isotropic(prepare(material("ptfe-532"), 0.532));
  if (family == Family::isotropic) return isotropic;
  static const DirectionSampler anisotropic(prepare(bench_model(Family::anisotropic, {4, 0}, 0), 0.532));
  return anisotropic;
}

/// An incident direction and a point for each of what is drawn.
struct Asked {
  std::vector<Direction> incident;
  std::vector<Vector3> vectors;
  std::vector<UnitPoint> points;
  Asked() {
    std::mt19937_64 engine(1);
    const auto uniform = [&] { return static_cast<double>(engine() >> 11) * 0x1p-53; };
    for (const Geometry& g : random_geometries(static_cast<int>(in_cache), 1)) {
      incident.push_back(g.incident);
      vectors.push_back(unit_vector(g.incident));
      points.push_back({uniform(), uniform()});
    }
  }
};

const Asked& asked() {
  static const Asked all;
  return all;
}

template <class Work>
void run(benchmark::State& state, Work work) {
  Report report(state);
  for (auto _ : state) {
    work();
    benchmark::ClobberMemory();
  }
  report.finish(static_cast<double>(in_cache), "direction");
}

template <class Incident, class Sampled>
void draw(benchmark::State& state, Family family, std::span<const Incident> incident) {
  const DirectionSampler& sampler = sampler_of(family);
  std::vector<Sampled> out(in_cache);
  run(state, [&] { sampler.sample(incident, asked().points, out); });
}

void pdf(benchmark::State& state) {
  const DirectionSampler& sampler = sampler_of(Family::isotropic);
  std::vector<SampledDirection> drawn(in_cache);
  sampler.sample(asked().incident, asked().points, drawn);
  run(state, [&] {
    for (std::size_t q = 0; q < in_cache; ++q) drawn[q].pdf = sampler.pdf(asked().incident[q], drawn[q].reflected);
  });
}

void weights(benchmark::State& state) {
  const DirectionSampler& sampler = sampler_of(Family::isotropic);
  std::vector<SampledDirection> drawn(in_cache);
  std::vector<Mueller> out(in_cache);
  sampler.sample(asked().incident, asked().points, drawn);
  run(state, [&] { sampler.weights(asked().incident, drawn, Frame::sp, out); });
}

/// What any sampler has to do at least.
void cosine_angles(benchmark::State& state) {
  std::vector<SampledDirection> out(in_cache);
  run(state, [&] {
    for (std::size_t q = 0; q < in_cache; ++q) {
      const auto [u1, u2] = asked().points[q];
      const double z = std::sqrt(1 - u1);
      out[q] = {{std::acos(z), 2 * std::numbers::pi * u2}, z / std::numbers::pi};
    }
  });
}

void cosine_vectors(benchmark::State& state) {
  std::vector<SampledVector> out(in_cache);
  run(state, [&] {
    for (std::size_t q = 0; q < in_cache; ++q) {
      const auto [u1, u2] = asked().points[q];
      const double z = std::sqrt(1 - u1), r = std::sqrt(u1), phi = 2 * std::numbers::pi * u2;
      out[q] = {{r * std::cos(phi), r * std::sin(phi), z}, z / std::numbers::pi};
    }
  });
}

template <class Run>
void add(const std::string& name, Run run) {
  benchmark::RegisterBenchmark(("sampling/" + name).c_str(), run);
}

}  // namespace

void register_sampling() {
  add("cosine/angles", cosine_angles);
  add("cosine/vectors", cosine_vectors);
  for (const auto& [family, name] :
       {std::pair(Family::isotropic, ""), std::pair(Family::anisotropic, "anisotropic/")}) {
    const std::string of = name;
    add(of + "angles", [=](auto& s) { draw<Direction, SampledDirection>(s, family, asked().incident); });
    add(of + "angles/one_incident",
        [=](auto& s) { draw<Direction, SampledDirection>(s, family, std::span(asked().incident).first(1)); });
    add(of + "vectors", [=](auto& s) { draw<Vector3, SampledVector>(s, family, asked().vectors); });
    add(of + "vectors/one_incident",
        [=](auto& s) { draw<Vector3, SampledVector>(s, family, std::span(asked().vectors).first(1)); });
  }
  add("pdf", pdf);
  add("weights/sp", weights);
  add("tables", [](benchmark::State& state) {
    const PreparedModel model = prepare(material("ptfe-532"), 0.532);
    Report report(state);
    for (auto _ : state) benchmark::DoNotOptimize(DirectionSampler(model));
    report.finish(1, "sampler");
  });
}

}  // namespace mmbrdf::bench
