// SPDX-License-Identifier: BSD-3-Clause
// Counts all memory of its process: a test program of its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <vector>

#include "given/random_model.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/samples/simulation.hpp"

// Memory that is held through operator new, and the most there ever was. Each piece is preceded by its size.
namespace {
std::size_t held = 0, peak = 0;
constexpr std::size_t before = alignof(std::max_align_t);
}  // namespace
void* operator new(std::size_t size) {
  void* memory = std::malloc(before + size);
  if (!memory) throw std::bad_alloc();
  *static_cast<std::size_t*>(memory) = size;
  held += size;
  peak = std::max(peak, held);
  return static_cast<char*>(memory) + before;
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {  // of std::stable_sort
  try {
    return operator new(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void operator delete(void* memory) noexcept {
  if (!memory) return;
  memory = static_cast<char*>(memory) - before;
  held -= *static_cast<std::size_t*>(memory);
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept { operator delete(memory); }

namespace mmbrdf {
namespace {

TEST(Fit, NeedsNoMoreMemoryForAHundredTimesTheSamples) {
  const std::vector<Sample> samples = simulate(material("ptfe-532"), std::array{0.532}, germer2017_grid(), 0.01, 1);
  const auto most_held = [&](int times) {
    const std::size_t at_first = held;
    peak = held;
    FitAccumulator accumulator{Basis{}};
    for (int i = 0; i < times; ++i) accumulator.add(samples);
    accumulator.solve();
    return peak - at_first;
  };
  const std::size_t once = most_held(1);
  EXPECT_GT(once, 100'000u);  // the counter counts
  EXPECT_EQ(most_held(100), once);
}

// Nothing has the square of their number, and so nothing takes the cube of the time.
TEST(Fit, NeedsMemoryInProportionToTheNumberOfWavelengths) {
  const std::vector<Geometry> geometries = random_geometries(4, 7);
  const auto most_held = [&](int wavelengths, Uncertainty uncertainty) {
    std::vector<double> list;
    for (int w = 0; w < wavelengths; ++w) list.push_back(0.3 + 0.001 * w);
    const std::vector<Sample> samples = simulate(material("ptfe"), list, geometries, 0.01, 8);
    const std::size_t at_first = held;
    peak = held;
    FitOptions options;
    options.minimum_norm = true;
    options.uncertainty = uncertainty;
    const FitResult result = fit(samples, {Family::isotropic, {0, 0}}, options, Weights::speckle);
    return static_cast<double>(peak - at_first);
  };
  for (const Uncertainty uncertainty : {Uncertainty::noise, Uncertainty::sample})
    EXPECT_NEAR(most_held(1000, uncertainty) / most_held(500, uncertainty), 2, 0.2);
}

}  // namespace
}  // namespace mmbrdf
