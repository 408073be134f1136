// SPDX-License-Identifier: BSD-3-Clause
/// The numbers of a state of a fit, one after another.
#pragma once

#include <span>
#include <vector>

#include "mmbrdf/fitting/fit.hpp"

namespace mmbrdf {

/// Throws std::invalid_argument where there are too few numbers, or others than are asked for.
class StateReader {
 public:
  explicit StateReader(std::span<const double> numbers) : rest_(numbers) {}

  bool at_end() const { return rest_.empty(); }
  std::span<const double> next(std::size_t count);
  /// In [0, highest].
  double next(const char* what, double highest);
  /// A whole one, as below.
  long whole(const char* what, double highest = largest_whole);

  static constexpr double largest_whole = 9e15;  ///< whole numbers up to here are exact

 private:
  std::span<const double> rest_;
};

/// Family, both orders, mapping, rotation.
std::vector<double> numbers_of(const Basis& basis);
/// Throws std::invalid_argument unless those of this basis are next.
void require_next(StateReader& reader, const Basis& basis);

}  // namespace mmbrdf
