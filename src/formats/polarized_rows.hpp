// SPDX-License-Identifier: BSD-3-Clause
// Mueller matrices out of values between polarization states.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "mmbrdf/polarization/mueller.hpp"
#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf {

/// A BRDF for light in the state `incident` of which a receiver lets `analyzed` pass. (1, 0, 0, 0) is unpolarized light, or
/// a receiver without an analyzer; an ideal analyzer has the Stokes vector of the light that it lets pass.
struct PolarizedValue {
  Stokes incident{1, 0, 0, 0}, analyzed{1, 0, 0, 0};
  double brdf = 0;         ///< sr⁻¹
  double uncertainty = 0;  ///< of it; 0: not known
};

/// What states tell of a matrix, by least squares; the same states are solved once. Combinations of elements whose
/// singular value is below 1/100 of the largest count as not told: nearly equal states would tell them by their errors. An
/// element is determined if less than 1/100 of it (the length of its part) is in such combinations, so that states as
/// measured, which are not quite s and p, determine what s and p do.
class PolarizedRows {
 public:
  /// f11 and elements of a sample whose geometry is given, from values at it, with their uncertainties: those which the
  /// states determine, all others unknown. f11 is NaN if they do not determine it. Uncertainties are 0, not known, if that
  /// of any value is.
  void solve(std::span<const PolarizedValue> values, Sample& sample);

 private:
  struct Solution {
    std::vector<double> inverse;  ///< 16 rows: elements from values
    Elements determined;
  };
  const Solution& solution(std::span<const PolarizedValue> values);
  std::map<std::vector<double>, Solution> solutions_;
};

}  // namespace mmbrdf
