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

/// What states tell of a matrix, by least squares; the same states are solved once.
class PolarizedRows {
 public:
  /// f11 and elements of a sample whose geometry is given, from values at it, with their uncertainties: those which the
  /// states determine, all others unknown. f11 is NaN if they do not determine it.
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
