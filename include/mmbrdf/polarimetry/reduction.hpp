// SPDX-License-Identifier: BSD-3-Clause
/// From the readings of a polarimeter to a Mueller matrix, with its covariance.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "mmbrdf/polarimetry/polarimeter.hpp"
#include "mmbrdf/polarization/analysis_batch.hpp"
#include "mmbrdf/polarization/covariance.hpp"

namespace mmbrdf {

/// By how much noise of the readings may grow on its way to an element, relative to the largest singular value of the
/// readings as functions of the elements, or to that of readings that are all as the median one: beyond, the element
/// counts as not determined.
inline constexpr double most_amplified = 1e4;

/// Readings to matrices: the least-squares solution of B_j = a_j · M w_j, all readings with the same weight. For a grid
/// of states it is M = A⁺ B W⁺. Which elements the readings determine is a matter of their states: what they do not
/// determine is unknown, not zero.
class Reduction {
 public:
  /// `covariance` is that of the instrument: of the components of w_1, w_2, …, a_1, a_2, …, row-major; none if it is
  /// not known, or exact. Throws std::invalid_argument for states that are not finite, pairs of states that are not
  /// there, no states or more than most_states, states so large or small that no finite numbers are left, a covariance of another size, or one that is not symmetric and positive
  /// semidefinite (covariance_tolerance).
  explicit Reduction(const Polarimeter& polarimeter, std::span<const double> covariance = {});

  /// What the readings do not determine: elements that have a part in the null space of their matrix, or nearly so
  /// (most_amplified).
  const Elements& undetermined() const;
  /// How many independent combinations of the sixteen elements they determine.
  int rank() const;
  /// Ratio of the largest singular value to the smallest of these: the product of the two arms' numbers for a grid.
  double condition() const;

  /// Elements that are not determined are NaN. Each other is within (n + 2) 2⁻⁵³ Σ |x_j B_j| of what the n readings B_j
  /// times their exact weights x_j add up to, while condition() is at most most_amplified. Throws std::invalid_argument
  /// for another number of readings than the instrument has, or one that is not finite.
  Mueller mueller(std::span<const double> readings) const;

  /// The same of many pixels, with the same bits, on several threads and without a copy of the whole. The readings of a
  /// pixel stand one after the other, pixel after pixel, and so do its sixteen elements, in rows; the two must not
  /// overlap. Single precision is that of what goes in and out: the elements are those of the same readings in double
  /// precision, rounded. A pixel is refused for a reading that is not finite. Returns how many are; throws
  /// std::invalid_argument for sizes that are not those of as many pixels.
  std::size_t muellers(std::span<const double> readings, std::span<double> elements,
                       const MatricesOptions& options = {}) const;
  std::size_t muellers(std::span<const float> readings, std::span<float> elements,
                       const MatricesOptions& options = {}) const;

  /// Of the sixteen elements, from independent readings with these variances; NaN for those that are not determined.
  /// Throws as mueller(), and for a negative variance.
  MuellerCovariance from_readings(std::span<const double> variances) const;

  /// Of the sixteen elements, from the instrument: the same errors in every matrix that it measures. 0 if the
  /// covariance is not given, NaN for elements that are not determined. dM is minus the solution for readings
  /// da_j · M w_j + a_j · M dw_j; unknown elements of M count as 0 in it.
  MuellerCovariance from_instrument(const Mueller& m) const;

  /// What independent errors of the instrument, each of one standard deviation, do to a matrix that it measures: one
  /// change for each. The sum of their products is from_instrument(m). Empty if the covariance is not given.
  std::vector<Mueller> errors(const Mueller& m) const;

  /// Slopes of the elements over the components of w_1, …, a_1, …: 16 × 4 (states), row-major.
  std::vector<double> slopes(const Mueller& m) const;

 private:
  struct Solution;
  template <class Number>
  std::size_t solve(std::span<const Number> readings, std::span<Number> elements, const MatricesOptions& options) const;
  std::shared_ptr<const Solution> solution_;
};

}  // namespace mmbrdf
