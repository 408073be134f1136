// SPDX-License-Identifier: BSD-3-Clause
/// A map from the unit square to the reflected directions of each incident one, in tables (theory 5.3). What is between them
/// is worked out in the kernel.
#pragma once

#include <cstddef>
#include <vector>

#include "mmbrdf/model/prepared.hpp"
#include "model/kernel/kernel.hpp"

namespace mmbrdf {

class SamplingMap {
 public:
  /// Throws std::invalid_argument if f11 is nowhere positive.
  explicit SamplingMap(const PreparedModel& model);

  SamplingTables tables() const { return {numbers_.data(), folded_, false}; }

 private:
  bool folded_;
  std::vector<double> numbers_;
};

}  // namespace mmbrdf
