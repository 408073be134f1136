// SPDX-License-Identifier: BSD-3-Clause
/// What drawn values say: mean, standard deviation, coverage interval and correlation (JCGM 101:2008).
#pragma once

#include <span>

namespace mmbrdf {

/// Which of the intervals that hold a given part of the values.
enum class Interval {
  symmetric,  ///< as many values below as above (JCGM 101, 7.7.2)
  shortest,   ///< (JCGM 101, 7.7.4)
};

struct Distribution {
  double mean = 0;
  double standard_deviation = 0;  ///< of one value, with count − 1: the standard uncertainty
  double low = 0, high = 0;       ///< ends of the coverage interval, both among the values
};

/// Mean, standard deviation and coverage interval of drawn values. Throws std::invalid_argument for fewer than two
/// values, one that is not finite, or unless 0 < coverage < 1.
Distribution distribution(std::span<const double> values, double coverage = 0.95,
                          Interval interval = Interval::symmetric);

/// Correlation of two quantities over the same draws, in [−1, 1]; 0 where one does not vary. Throws
/// std::invalid_argument if the counts differ, for fewer than two values, or one that is not finite.
double correlation(std::span<const double> values, std::span<const double> others);

}  // namespace mmbrdf
