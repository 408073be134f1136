// SPDX-License-Identifier: BSD-3-Clause
/// The size of numbers of which a few may be far too large.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace mmbrdf {

inline constexpr double typical_of_normal = 1.4826;  ///< standard deviation, over the median of |x|

/// Median of |x|, as the standard deviation of what is normal with mean 0; of nothing 0.
inline double typical_size(std::vector<double> numbers) {
  if (numbers.empty()) return 0;
  for (double& number : numbers) number = std::abs(number);
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::ranges::nth_element(numbers, middle);
  return typical_of_normal * *middle;
}

/// The same, to 5 %, from counts that add up: numbers that are given as parts of a unit, from 2⁻⁴⁰ to 2²⁴ of it.
class SizeCounts {
 public:
  void add(double part) {
    const double steps = std::floor(per_octave * (std::log2(std::abs(part)) - lowest));
    ++counts_[static_cast<std::size_t>(std::clamp(steps, 0.0, highest))];
  }
  void merge(const SizeCounts& other) {
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
  }
  /// In parts of the unit.
  double typical_size() const {
    const long all = std::accumulate(counts_.begin(), counts_.end(), 0L);
    std::size_t i = 0;
    for (long below = counts_[0]; i + 1 < counts_.size() && below <= all / 2; below += counts_[++i]) continue;
    return all == 0 ? 0 : typical_of_normal * std::exp2((static_cast<double>(i) + 0.5) / per_octave + lowest);
  }

  static constexpr double per_octave = 8, lowest = -40;
  using Counts = std::array<long, 512>;
  const Counts& counts() const { return counts_; }
  Counts& counts() { return counts_; }

 private:
  static constexpr double highest = 511;  // of the steps
  Counts counts_{};
};

}  // namespace mmbrdf
