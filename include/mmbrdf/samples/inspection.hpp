// SPDX-License-Identifier: BSD-3-Clause
/// What a table of samples betrays of itself, row by row and without a model.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf {

/// A fault that the data show, and what mends it.
struct Finding {
  std::string fault;                   ///< "fill values"
  std::string evidence;                ///< "f11 = -999 in 20 samples: 3, 17, 18, …"
  std::string remedy;                  ///< "leave these rows out"; empty where that depends
  std::vector<std::size_t> samples{};  ///< which, counted from 0; none: all, or it depends
  std::string option{};                ///< "--frame sp": of the program, where one mends it
};

/// "fill values: f11 = -999 in 20 samples: 3, 17, …: leave these rows out"
std::string to_string(const Finding& finding);

/// What numbers of some samples are no measurement. It is one if all that are there are equal, f11 and elements, if an
/// element is beyond 10, if f11 is beyond 10⁴ or below −10 times the median of all |f11| that are not 0, or if it is the
/// same number in three samples or more and no other is as it is: the only one that is not positive, farther from the others
/// than their rounding explains and, if it is 0, than a tenth of the median; or five times as large as all others. What
/// is large only within 20 degrees of the direction of a mirror, or of that to the source, is a peak.
class FillValues {
 public:
  explicit FillValues(std::span<const Sample> samples);
  bool include(const Sample& sample) const;
  /// That median; 0 if there is no such f11.
  double typical() const { return typical_; }

 private:
  double typical_ = 0;
  std::vector<double> repeated_;
};

/// Any of the following that the samples show, in this order. Samples are numbered from 1, or as `numbers` says.
///
///   fill values              FillValues
///   f11 not positive         in more than half of the samples
///   elements not divided     an element beyond 1.5 in more than 1 % of the samples; in more than a fifth, those beyond 10 are
///                            no fill values
///   matrices that cannot exist   smallest coherency eigenvalue below −0.1 f11 in more than 1 % of the samples, of those
///                            whose sixteen elements are there and which are as bright as most: in dark ones it may be noise
///   zeros                    an element that is exactly 0 in all samples, of 4 at least
///   repeated rows            samples that are equal in every number
///   wavelengths              outside of 0.1 … 20 µm
///
/// Throws std::invalid_argument for invalid samples.
std::vector<Finding> row_findings(std::span<const Sample> samples, std::span<const long> numbers = {});

}  // namespace mmbrdf
