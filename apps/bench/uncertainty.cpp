// SPDX-License-Identifier: BSD-3-Clause
// Uncertainties of what a model predicts, of random directions: of a fit of least squares and of the mixed model.
#include "bench.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/quantities/answer.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"
#include "mmbrdf/samples/simulation.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"

namespace mmbrdf::bench {
namespace {

constexpr double wavelength = 0.532;

Model fitted(Uncertainty kind) {
  const auto samples = simulate(material("ptfe-532"), std::vector{wavelength}, random_geometries(1000, 2), 0.01, 1);
  return kind == Uncertainty::sample ? fit_sample(samples).model : fit(samples).model;
}

const PreparedUncertainty& prepared(Uncertainty kind) {
  static const PreparedUncertainty noise = prepare_uncertainty(fitted(Uncertainty::noise), wavelength);
  if (kind == Uncertainty::noise) return noise;
  static const PreparedUncertainty sample = prepare_uncertainty(fitted(Uncertainty::sample), wavelength);
  return sample;
}

template <class Out>
void run(benchmark::State& state, std::size_t count, auto evaluate) {
  const std::vector<Geometry> geometries = random_geometries(static_cast<int>(count), 1);
  std::vector<Out> out(count);
  Report report(state);
  for (auto _ : state) {
    evaluate(geometries, std::span<Out>(out));
    benchmark::ClobberMemory();
  }
  report.finish(static_cast<double>(count));
}

void deviations(benchmark::State& state, Uncertainty kind, Frame frame) {
  const PreparedUncertainty& u = prepared(kind);
  run<Mueller>(state, in_cache,
               [&](const auto& geometries, auto out) { u.standard_uncertainty(geometries, frame, out); });
}

void covariances(benchmark::State& state, Uncertainty kind, Frame frame) {
  const PreparedUncertainty& u = prepared(kind);
  run<MuellerCovariance>(state, in_cache,
                         [&](const auto& geometries, auto out) { u.evaluate(geometries, frame, out); });
}

void one(benchmark::State& state, Uncertainty kind) {
  const PreparedUncertainty& u = prepared(kind);
  run<Mueller>(state, in_cache, [&](const auto& geometries, auto out) {
    for (std::size_t g = 0; g < out.size(); ++g) out[g] = u.standard_uncertainty(geometries[g]);
  });
}

/// All derived quantities with intervals, of the material and its posterior: as a call does, the draws included.
void answers_with_draws(benchmark::State& state) {
  const std::vector<Geometry> geometries = random_geometries(1760, 1);
  const Model ptfe = material("ptfe");
  Report report(state);
  for (auto _ : state)
    benchmark::DoNotOptimize(Answers(ptfe, {.draws = 1000, .parts = false}).at(wavelength).at(geometries));
  report.finish(1000. * static_cast<double>(geometries.size()), "draw");
}

void reflectances(benchmark::State& state) {
  const PreparedUncertainty& u = prepared(Uncertainty::noise);
  std::vector<Direction> directions;
  for (const Geometry& geometry : random_geometries(10000, 1)) directions.push_back(geometry.incident);
  std::vector<double> out(directions.size());
  Report report(state);
  for (auto _ : state) {
    u.directional_hemispherical_reflectance(directions, out);
    benchmark::ClobberMemory();
  }
  report.finish(static_cast<double>(directions.size()));
}

template <class Run>
void add(const std::string& name, Run run) {
  benchmark::RegisterBenchmark(("uncertainty/" + name).c_str(), run)->UseRealTime();
}

}  // namespace

void register_uncertainty() {
  for (const Uncertainty kind : {Uncertainty::noise, Uncertainty::sample}) {
    const std::string of = "/" + to_string(kind);
    for (const Frame frame : {Frame::xy, Frame::sp, Frame::scattering_plane}) {
      add("elements" + of + "/" + to_string(frame), [=](benchmark::State& s) { deviations(s, kind, frame); });
      add("covariance" + of + "/" + to_string(frame), [=](benchmark::State& s) { covariances(s, kind, frame); });
    }
    add("one" + of, [=](benchmark::State& s) { one(s, kind); });
  }
  add("answers/1000_draws", answers_with_draws);
  add("directional_hemispherical", reflectances);
}

}  // namespace mmbrdf::bench
