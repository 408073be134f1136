// SPDX-License-Identifier: BSD-3-Clause
/// Of many matrices or pixels those that were refused: how many, and the first. Any thread may add to them.
#pragma once

#include <atomic>
#include <cstddef>
#include <limits>
#include <string>

namespace mmbrdf {

struct Refusals {
  std::atomic<std::size_t> count = 0, first = std::numeric_limits<std::size_t>::max();

  void add(std::size_t q) {
    ++count;
    for (std::size_t before = first; q < before && !first.compare_exchange_weak(before, q);) continue;
  }

  /// "matrix 5, counted from 0: why (2 of 9 are refused)"
  std::string message(const std::string& what, const std::string& why, std::size_t of) const {
    return what + " " + std::to_string(first) + ", counted from 0: " + why + " (" + std::to_string(count) + " of " +
           std::to_string(of) + " are refused)";
  }
};

}  // namespace mmbrdf
