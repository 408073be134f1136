// SPDX-License-Identifier: BSD-3-Clause
/// From the readings of a polarimeter to a Mueller matrix, with its covariance.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "mmbrdf/polarimetry/polarimeter.hpp"
#include "mmbrdf/polarization/covariance.hpp"

namespace mmbrdf {

/// Readings to matrices, by the pseudo-inverses of A and W: M = A⁺ B W⁺, the least-squares solution.
class Reduction {
 public:
  /// `covariance` is that of the instrument: of the components of w_1, w_2, …, a_1, a_2, …, row-major; none if it is
  /// not known, or exact. Throws std::invalid_argument for states that are not finite, fewer than four independent
  /// ones, more than most_states, a covariance of another size, or one that is not symmetric and positive semidefinite (covariance_tolerance).
  explicit Reduction(const Polarimeter& polarimeter, std::span<const double> covariance = {});

  /// Throws std::invalid_argument for another number of readings than the instrument has, or one that is not finite.
  Mueller mueller(std::span<const double> readings) const;

  /// Of the sixteen elements, from independent readings with these variances. Throws as mueller(), and for a negative
  /// variance.
  MuellerCovariance from_readings(std::span<const double> variances) const;

  /// Of the sixteen elements, from the instrument: the same errors in every matrix that it measures. 0 if the
  /// covariance is not given. dM = −A⁺ dA M − M dW W⁺.
  MuellerCovariance from_instrument(const Mueller& m) const;

  /// What independent errors of the instrument, each of one standard deviation, do to a matrix that it measures: one
  /// change for each. The sum of their products is from_instrument(m). Empty if the covariance is not given.
  std::vector<Mueller> errors(const Mueller& m) const;

  /// Slopes of the elements over the components of w_1, …, a_1, …: 16 × 4 (states), row-major.
  std::vector<double> slopes(const Mueller& m) const;

 private:
  struct Inverses;
  std::shared_ptr<const Inverses> inverses_;
};

}  // namespace mmbrdf
