// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/uncertainty/distribution.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

/// Sum, least or largest of values, in eight lanes that do not wait for each other.
template <class Join>
double joined(std::span<const double> values, double start, Join join) {
  std::array<double, 8> lanes;
  lanes.fill(start);
  std::size_t i = 0;
  for (; i + lanes.size() <= values.size(); i += lanes.size())
    for (std::size_t lane = 0; lane < lanes.size(); ++lane) lanes[lane] = join(lanes[lane], values[i + lane]);
  for (; i < values.size(); ++i) lanes[0] = join(lanes[0], values[i]);
  return std::accumulate(lanes.begin() + 1, lanes.end(), lanes[0], join);
}

double sum_of(std::span<const double> values) { return joined(values, 0, std::plus()); }

double sum_of_products(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<double> products(x.size());
  std::ranges::transform(x, y, products.begin(), std::multiplies());
  return sum_of(products);
}

void require_values(std::span<const double> values) {
  if (values.size() < 2) throw std::invalid_argument(std::to_string(values.size()) + " values, at least 2 are needed");
  for (const double value : values)
    if (!std::isfinite(value)) throw std::invalid_argument("the value " + shortest(value) + " is not finite");
}

/// The mean, differences from it in units of half the spread, and that. 0 if all values are equal.
struct Deviations {
  std::vector<double> relative;
  double half_spread = 0, mean = 0;

  explicit Deviations(std::span<const double> values) : relative(values.size()) {
    const double low = joined(values, values[0], [](double a, double b) { return b < a ? b : a; }),
                 high = joined(values, values[0], [](double a, double b) { return b > a ? b : a; });
    half_spread = high / 2 - low / 2;
    mean = low == high ? low : low / 2 + high / 2;
    if (half_spread == 0) return;
    set_relative(values);
    mean += sum_of(relative) / static_cast<double>(values.size()) * half_spread;
    set_relative(values);
  }

  void set_relative(std::span<const double> values) {
    for (std::size_t i = 0; i < values.size(); ++i) relative[i] = (values[i] / 2 - mean / 2) / half_spread * 2;
  }
};

/// The value that has so many before it. Of those beyond a bound alone, if there are more.
template <class Order>
double value_behind(std::size_t others, std::span<const double> values, double bound, Order order) {
  std::vector<double> some(values.size());
  std::size_t count = 0;
  for (const double value : values) {
    some[count] = value;
    count += order(value, bound) ? 1U : 0U;
  }
  if (count > others)
    some.resize(count);
  else
    std::ranges::copy(values, some.begin());
  const auto place = some.begin() + static_cast<std::ptrdiff_t>(others);
  std::nth_element(some.begin(), place, some.end(), order);
  return *place;
}

struct Ends {
  double low, high;
};

/// Normal values beyond 1.5 standard deviations are 7 % on each side: enough for intervals that hold 90 %, say.
Ends symmetric_interval(std::span<const double> values, std::size_t steps, double mean, double deviation) {
  const std::size_t low = (values.size() - steps + 1) / 2 - 1;  // r = ⌊(M − q + 1) / 2⌋, counted from 1
  return {value_behind(low, values, mean - 1.5 * deviation, std::less()),
          value_behind(values.size() - 1 - low - steps, values, mean + 1.5 * deviation, std::greater())};
}

Ends shortest_interval(std::span<const double> values, std::size_t steps) {
  std::vector<double> sorted(values.begin(), values.end());
  std::ranges::sort(sorted);
  std::size_t low = 0;
  for (std::size_t r = 1; r + steps < sorted.size(); ++r)
    if (sorted[r + steps] - sorted[r] < sorted[low + steps] - sorted[low]) low = r;
  return {sorted[low], sorted[low + steps]};
}

}  // namespace

Distribution distribution(std::span<const double> values, double coverage, Interval interval) {
  require_values(values);
  if (!(coverage > 0 && coverage < 1))
    throw std::invalid_argument("coverage " + shortest(coverage) + " is not between 0 and 1");
  const Deviations d(values);
  const auto count = static_cast<double>(values.size());
  const double deviation = std::min(d.half_spread * std::sqrt(sum_of_products(d.relative, d.relative) / (count - 1)),
                                    std::numeric_limits<double>::max());
  // JCGM 101, 7.7.1: q = ⌊p M + ½⌋ steps from the low end to the high end.
  const auto steps = std::min(static_cast<std::size_t>(coverage * count + 0.5), values.size() - 1);
  const auto [low, high] = interval == Interval::symmetric ? symmetric_interval(values, steps, d.mean, deviation)
                                                           : shortest_interval(values, steps);
  return {d.mean, deviation, low, high};
}

double correlation(std::span<const double> values, std::span<const double> others) {
  if (values.size() != others.size())
    throw std::invalid_argument(std::to_string(values.size()) + " and " + std::to_string(others.size()) + " values");
  require_values(values);
  require_values(others);
  const Deviations a(values), b(others);
  const double aa = sum_of_products(a.relative, a.relative), bb = sum_of_products(b.relative, b.relative),
               ab = sum_of_products(a.relative, b.relative);
  return aa > 0 && bb > 0 ? std::clamp(ab / std::sqrt(aa * bb), -1.0, 1.0) : 0;
}

}  // namespace mmbrdf
