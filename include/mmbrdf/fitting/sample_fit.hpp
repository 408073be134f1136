// SPDX-License-Identifier: BSD-3-Clause
/// The mixed model of a real sample (theory 8) from samples that are not in memory together: archives, streams, parts in
/// many processes.
///
///   SampleFitAccumulator sums;
///   do
///     for (…) sums.add(some samples);        // all of them, in each round
///   while (sums.next_round());
///   FitResult result = sums.solve();
///
/// Each round goes over the same samples, since sums of later rounds are weighed by what the earlier ones found: up to
/// four of them, two or three where there is no mixed model (src/fitting/mixed_rounds.hpp says what is in each).
/// Within a round samples come in any order and parts. In many processes: each adds its part of a round to a copy of the same
/// accumulator, the copies are merged, next_round() is called once, and the result is sent for the next round.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "mmbrdf/fitting/fit.hpp"

namespace mmbrdf {

class MixedRounds;  // of the library's own

/// Laws: in any order and parts the result is that of fit() in memory to sample_fit_tolerance. Memory
/// grows with the number of wavelengths (some 8 MB for each in the last round) and with distinct directions up to most_directions,
/// not with the number of samples.
class SampleFitAccumulator {
 public:
  /// Throws std::invalid_argument as FitAccumulator does, and for weights other than none and speckle: those need all
  /// samples at once.
  explicit SampleFitAccumulator(const Basis& basis = {}, Weights weights = Weights::speckle);
  SampleFitAccumulator(const SampleFitAccumulator& other);
  SampleFitAccumulator(SampleFitAccumulator&& other) noexcept;
  SampleFitAccumulator& operator=(SampleFitAccumulator other) noexcept;
  ~SampleFitAccumulator();

  /// To the sums of this round; threads 0: one for each core. Throws std::invalid_argument for an invalid sample, one where
  /// the law of the weights is infinite, a wavelength that the first round did not have, and after the last round.
  void add(std::span<const Sample> samples, int threads = 0);

  /// As if what was added to the other in this round had been added here. Throws std::invalid_argument for another basis
  /// or other weights, another round, one of other samples in the rounds before, and after the last.
  void merge(const SampleFitAccumulator& other);

  /// Ends the round. True: another one begins, and all samples are to be added again; false: solve() may be called.
  /// Throws std::invalid_argument for a round without samples, or with others than the first (in any order, to the last
  /// bit), and if f11 was not measured.
  bool next_round();

  int round() const;      ///< 1 … 4
  bool finished() const;  ///< whether next_round() has said false
  long samples() const;   ///< of this round so far

  /// Everything there is, as numbers to be saved or sent: from_state() of the same basis and weights makes the same accumulator,
  /// to the last bit.
  std::vector<double> state() const;
  /// Throws std::invalid_argument unless the numbers are a state of this basis and these weights.
  static SampleFitAccumulator from_state(const Basis& basis, Weights weights, std::span<const double> state);

  /// As fit() of all samples with Uncertainty::sample, whatever the options say of it, without residuals and weights of samples.
  /// Where there is no mixed model it is least squares, and FitResult::warnings says why; the noise of f11 is relative to
  /// an isotropic f11 of order first_order then. Throws std::invalid_argument before the end of the rounds, and as
  /// FitAccumulator::solve() does.
  FitResult solve(const FitOptions& options = {}) const;

 private:
  SampleFitAccumulator(Weights weights, MixedRounds rounds);
  Weights weights_;
  std::unique_ptr<MixedRounds> rounds_;
};

/// Of coefficients, in parts of the largest of a block, and ten times of it of u: how far orders and parts take a search
/// that ends where a step promises less evidence than 1e-8. Where samples leave much open, as those of one incidence, of values
/// ten times of it in parts of u.
inline constexpr double sample_fit_tolerance = 1e-7;

}  // namespace mmbrdf
