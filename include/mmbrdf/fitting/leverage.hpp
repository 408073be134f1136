// SPDX-License-Identifier: BSD-3-Clause
/// How much each sample of a fit determines, and which do not belong.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/fitting/fit.hpp"

namespace mmbrdf {

/// How much each sample determines, and how far it lies off.
struct SampleDiagnostics {
  struct Leverage {
    std::string block;
    int rank = 0;                ///< the leverages of all samples add up to it
    std::vector<double> values;  ///< of each sample: Σ w xᵀ (Xᵀ W X)⁺ x over the elements of the block
    std::size_t largest = 0;     ///< its sample
  };
  std::vector<Leverage> leverage;
  /// r √w / (s √(1 − h)) of each sample and element, s that of its block and h its leverage: near normal with variance
  /// 1 if the weights are right. 0 where the row alone decides its residual (h = 1), or s is 0.
  std::vector<Mueller> studentized;
};

/// Of the samples and weights that the result was fitted to, turned if the fit turned them. Throws
/// std::invalid_argument for samples that do not fit to it in number.
SampleDiagnostics sample_diagnostics(std::span<const Sample> samples, const FitResult& result,
                                     std::span<const Mueller> weights = {});

struct Outlier {
  std::size_t sample = 0, element = 0;  ///< counted from 0; element in row-major order
  double studentized = 0;
};

/// Samples and elements beyond ± threshold, the largest first. Of 100 000 normal residuals 6 exceed 4, none 5.
std::vector<Outlier> outliers(const SampleDiagnostics& diagnostics, double threshold = 5);

}  // namespace mmbrdf
