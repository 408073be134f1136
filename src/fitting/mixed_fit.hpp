// SPDX-License-Identifier: BSD-3-Clause
/// The mixed model of samples: each wavelength and block on its own, then polynomials of the wavelength through the
/// evaluated coefficients.
#pragma once

#include <functional>
#include <span>
#include <stdexcept>
#include <string>

#include "fitting/mixed_rounds.hpp"

namespace mmbrdf {

/// Why there is no mixed model after all.
struct MixedFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// The warning of a fit that is least squares for that.
std::string only_noise(const std::string& reason, const DeclaredErrors& declared);
/// Why there is none with a covariance other than residuals.
std::string only_residuals(Covariance covariance);

/// Of noise variance 1: none, or that of speckle.
ReadingLaw law_of(Weights weights);

/// Those of round 4, of a wavelength.
struct BlockSums {
  std::function<Gram(double, std::size_t block)> gram;
  std::function<DirectionCounts(double)> directions;
};
/// From the first three rounds and these sums. Throws MixedFailure, and as FitAccumulator::solve() does.
FitResult mixed_fit(const MixedRounds& rounds, FitOptions options, const BlockSums& sums);

/// Least squares of round 3, with a warning. Throws as FitAccumulator::solve() does.
FitResult noise_fit(const MixedRounds& rounds, const FitOptions& options, const std::string& reason);

/// Of samples in memory: rounds over them, but for the sums of blocks, of which few are there at once. Throws as
/// mixed_fit() does.
FitResult sample_fit(std::span<const Sample> samples, const Basis& basis, const FitOptions& options, Weights weights);

}  // namespace mmbrdf
