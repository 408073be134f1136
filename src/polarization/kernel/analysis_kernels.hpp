// SPDX-License-Identifier: BSD-3-Clause
/// The analysis kernels that were compiled in.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "mmbrdf/polarization/mueller.hpp"
#include "polarization/kernel/analysis_kernel.hpp"

namespace mmbrdf {

/// Every one of this build, the fastest first; not all of them need run here. For tests and benchmarks.
std::span<const AnalysisKernel* const> analysis_kernels();

/// The first that runs here.
const AnalysisKernel& best_analysis_kernel();

/// What it answers of one matrix; nothing where it has no answer.
template <Analysis analysis>
std::optional<std::array<double, numbers_of[static_cast<std::size_t>(analysis)]>> answer_of(const Mueller& m) {
  std::array<double, numbers_of[static_cast<std::size_t>(analysis)]> numbers;
  unsigned char left;
  if (best_analysis_kernel().run(analysis, m.elements.data(), 1, numbers.data(), &left)) return {};
  return numbers;
}

}  // namespace mmbrdf
