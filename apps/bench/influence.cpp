// SPDX-License-Identifier: BSD-3-Clause
// Many fits at the same geometries, on one thread: whole, from values in memory, and the products alone, of values that are
// there already.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "bench.hpp"
#include "fitting/kernel/influence_kernels.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/fitting/leverage.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf::bench {
namespace {

constexpr std::size_t sets = 20 * influence_sets;
const Basis basis{Family::isotropic, {7, 4}};

/// f of the material, 16 for each geometry, of each set; or f11 alone.
std::vector<float> measured(const std::vector<Geometry>& where, bool f11_only) {
  const PreparedModel ptfe = prepare(material("ptfe-532"), 0.532);
  std::vector<float> one;
  for (const Geometry& geometry : where) {
    const Mueller f = ptfe.evaluate(geometry);
    for (std::size_t e = 0; e < (f11_only ? 1U : 16U); ++e) one.push_back(static_cast<float>(f.elements[e]));
  }
  std::vector<float> all;
  for (std::size_t s = 0; s < sets; ++s) all.insert(all.end(), one.begin(), one.end());
  return all;
}

void whole(benchmark::State& state, bool f11_only) {
  const std::vector<Geometry> where = germer2017_grid();
  const Influence influence(where, 0.532, basis, {}, f11_only);
  const std::vector<float> values = measured(where, f11_only);
  std::vector<double> coefficients(sets * influence.coefficients()), variances(sets * influence.model().blocks.size());
  Report report(state);
  for (auto _ : state) influence.fit(values, coefficients, variances);
  report.finish(static_cast<double>(sets), "set");
}

/// Rows of each fitted element times values of as many geometries as Influence takes at once, again and again.
void products(benchmark::State& state, bool f11_only) {
  constexpr std::size_t at_once = influence_geometries;
  const std::vector<Geometry> where = germer2017_grid();
  const Influence influence(where, 0.532, basis, {}, f11_only);
  std::vector<std::size_t> rows;  // filled up, of each element
  for (const FittedBlock& block : influence.model().blocks)
    rows.insert(rows.end(), block.block.elements.size(),
                (block.block.modes.size() + influence_tile - 1) / influence_tile * influence_tile);
  const std::size_t most = *std::ranges::max_element(rows);
  const std::size_t all = std::reduce(rows.begin(), rows.end());
  const std::vector<double> p(all * where.size(), 1e-3), values(at_once * influence_sets, 1.);
  std::vector<double> sums(most * influence_sets);
  Report report(state);
  for (auto _ : state) {
    const double* next = p.data();
    for (std::size_t g = 0; g < where.size(); g += at_once)
      for (const std::size_t some : rows) {
        best_influence_kernel().multiply(next, some, at_once, values.data(), sums.data());
        next += some * at_once;
      }
    benchmark::ClobberMemory();
  }
  report.finish(static_cast<double>(influence_sets), "set");
}

}  // namespace

void register_influence() {
  for (const bool f11_only : {false, true}) {
    const std::string name = f11_only ? "influence/f11" : "influence/matrices";
    benchmark::RegisterBenchmark(name.c_str(), whole, f11_only);
    benchmark::RegisterBenchmark((name + "/products").c_str(), products, f11_only);
  }
}

}  // namespace mmbrdf::bench
