// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "mmbrdf/uncertainty/draws.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

double mean_of(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value / static_cast<double>(values.size());
  return sum;
}

void require_values(std::span<const double> values) {
  if (values.size() < 2) throw std::invalid_argument(std::to_string(values.size()) + " values, at least 2 are needed");
  for (const double value : values)
    if (!std::isfinite(value)) throw std::invalid_argument("the value " + shortest(value) + " is not finite");
}

/// Differences from the mean in units of half the spread, and that. 0 if all values are equal, whatever their mean is
/// rounded to.
struct Deviations {
  std::vector<double> relative;
  double half_spread = 0;
};

Deviations deviations(std::span<const double> values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  Deviations result{std::vector<double>(values.size()), *high / 2 - *low / 2};
  if (result.half_spread == 0) return result;
  const double mean = mean_of(values);
  for (std::size_t i = 0; i < values.size(); ++i)
    result.relative[i] = (values[i] / 2 - mean / 2) / (result.half_spread / 2);
  return result;
}

}  // namespace

Distribution distribution(std::span<const double> values, double coverage, Interval interval) {
  require_values(values);
  if (!(coverage > 0 && coverage < 1))
    throw std::invalid_argument("coverage " + shortest(coverage) + " is not between 0 and 1");
  const Deviations d = deviations(values);
  double squares = 0;
  for (const double value : d.relative) squares += value * value;
  std::vector<double> sorted(values.begin(), values.end());
  const std::size_t count = sorted.size();
  // JCGM 101, 7.7.1: q = ⌊p M + ½⌋ steps from the low end to the high end.
  const auto steps = std::min(static_cast<std::size_t>(coverage * static_cast<double>(count) + 0.5), count - 1);
  std::size_t low = (count - steps + 1) / 2 - 1;  // r = ⌊(M − q + 1) / 2⌋, counted from 1
  if (interval == Interval::symmetric) {          // two of them in their places take a fifth of the time of all
    const auto at = [&](std::size_t place) { return sorted.begin() + static_cast<std::ptrdiff_t>(place); };
    std::nth_element(sorted.begin(), at(low), sorted.end());
    if (steps > 0) std::nth_element(at(low + 1), at(low + steps), sorted.end());
  } else {
    std::sort(sorted.begin(), sorted.end());
    low = 0;
    for (std::size_t r = 1; r + steps < count; ++r)
      if (sorted[r + steps] - sorted[r] < sorted[low + steps] - sorted[low]) low = r;
  }
  const double deviation = d.half_spread * std::sqrt(squares / static_cast<double>(count - 1));
  return {mean_of(values), std::min(deviation, std::numeric_limits<double>::max()), sorted[low], sorted[low + steps]};
}

double correlation(std::span<const double> values, std::span<const double> others) {
  if (values.size() != others.size())
    throw std::invalid_argument(std::to_string(values.size()) + " and " + std::to_string(others.size()) + " values");
  require_values(values);
  require_values(others);
  const Deviations a = deviations(values), b = deviations(others);
  double aa = 0, bb = 0, ab = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    aa += a.relative[i] * a.relative[i];
    bb += b.relative[i] * b.relative[i];
    ab += a.relative[i] * b.relative[i];
  }
  return aa > 0 && bb > 0 ? std::clamp(ab / std::sqrt(aa * bb), -1.0, 1.0) : 0;
}

}  // namespace mmbrdf
