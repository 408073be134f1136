// SPDX-License-Identifier: BSD-3-Clause
// Many threads on the same objects, to be run under the thread sanitizer: const functions of models, prepared models,
// uncertainties, answers and posteriors. Ends with 0 if all threads found the same bits.
#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/files/model_file.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/quantities/answer.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"
#include "mmbrdf/samples/simulation.hpp"
#include "mmbrdf/uncertainty/draws.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"

using namespace mmbrdf;

namespace {

struct Shared {
  Model model = material("ptfe");
  PreparedModel prepared = prepare(model, 0.532);
  PreparedUncertainty uncertainty = prepare_uncertainty(model, 0.532);
  Answers answers{model};
  Model unasked = model_from_json(to_json(model), "again");  // its posterior is computed by the threads that ask first
  std::vector<Geometry> geometries = random_geometries(40, 1);
};

/// All that one thread asks, in a number that depends on every bit of it.
double asked(const Shared& shared, std::size_t thread) {
  double sum = prepare_uncertainty(shared.unasked, 0.532).evaluate(shared.geometries.front())(0, 0);
  const PreparedAnswers here = shared.answers.at(0.6);
  for (std::size_t i = 0; i < shared.geometries.size(); ++i) {
    const Geometry& g = shared.geometries[(i + thread) % shared.geometries.size()];
    std::array<double, 3> numbers{shared.prepared.evaluate(g)(1, 1), shared.uncertainty.evaluate(g)(0, 0),
                                  here.at(g).quantities.front().value.value_or(0)};
    for (const double number : numbers) sum += number;
  }
  for (const double wavelength : {0.4, 0.532, 0.8}) {
    sum += prepare(shared.unasked, wavelength).f11(shared.geometries.front());
    sum += prepare_uncertainty(shared.unasked, wavelength).evaluate(shared.geometries.front())(0, 0);
    sum += directional_hemispherical_reflectance(shared.model, wavelength, {0.5, 0});
  }
  return sum + Draws(shared.model, 4, 1).at(0.532).front().f11(shared.geometries.front());
}

}  // namespace

int main(int count, char** arguments) {
  const auto threads = static_cast<std::size_t>(count > 1 ? std::atoi(arguments[1]) : 64);
  const Shared shared;
  std::vector<double> found(threads);
  std::atomic<bool> start = false;
  std::vector<std::thread> all;
  for (std::size_t t = 0; t < threads; ++t)
    all.emplace_back([&, t] {
      while (!start) std::this_thread::yield();
      found[t] = asked(shared, t);
    });
  start = true;
  for (std::thread& one : all) one.join();
  for (std::size_t t = 0; t < threads; ++t) {
    const double alone = asked(shared, t);
    if (found[t] == alone) continue;
    std::printf("thread %zu: %.17g, alone %.17g\n", t, found[t], alone);
    return 1;
  }
  std::printf("%zu threads: the same bits as alone\n", threads);
}
