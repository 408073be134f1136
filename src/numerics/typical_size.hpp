// SPDX-License-Identifier: BSD-3-Clause
/// The size of numbers of which a few may be far too large.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace mmbrdf {

/// Median of |x|, as the standard deviation of what is normal with mean 0; of nothing 0.
inline double typical_size(std::vector<double> numbers) {
  constexpr double of_normal = 1.4826;
  if (numbers.empty()) return 0;
  for (double& number : numbers) number = std::abs(number);
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::ranges::nth_element(numbers, middle);
  return of_normal * *middle;
}

}  // namespace mmbrdf
