// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/fitting/sample_fit.hpp"

#include <stdexcept>
#include <string>
#include <utility>

#include "fitting/mixed_fit.hpp"
#include "fitting/moderate.hpp"

namespace mmbrdf {
namespace {

const Basis& with_sums(const Basis& basis, Weights weights) {
  if (weights != Weights::none && weights != Weights::speckle)
    throw std::invalid_argument("weights " + to_string(weights) +
                                " need all samples at once: take none or speckle, or fit()");
  return basis;
}

/// Weights of these are finite.
void require_weighable(std::span<const Sample> samples, Weights weights) {
  for (std::size_t s = 0; s < samples.size() && weights == Weights::speckle; ++s) try {
      weight(NoiseLaw{}, samples[s].geometry);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("sample " + std::to_string(s + 1) + ": " + error.what());
    }
}

}  // namespace

SampleFitAccumulator::SampleFitAccumulator(const Basis& basis, Weights weights)
    : SampleFitAccumulator(weights, MixedRounds(with_sums(basis, weights), law_of(weights))) {}
SampleFitAccumulator::SampleFitAccumulator(Weights weights, MixedRounds rounds)
    : weights_(weights), rounds_(std::make_unique<MixedRounds>(std::move(rounds))) {}
SampleFitAccumulator::SampleFitAccumulator(const SampleFitAccumulator& other)
    : SampleFitAccumulator(other.weights_, *other.rounds_) {}
SampleFitAccumulator::SampleFitAccumulator(SampleFitAccumulator&&) noexcept = default;
SampleFitAccumulator& SampleFitAccumulator::operator=(SampleFitAccumulator other) noexcept {
  std::swap(weights_, other.weights_);
  std::swap(rounds_, other.rounds_);
  return *this;
}
SampleFitAccumulator::~SampleFitAccumulator() = default;

void SampleFitAccumulator::add(std::span<const Sample> samples, int threads) {
  require_valid(samples);
  require_moderate(samples, {});
  require_weighable(samples, weights_);
  rounds_->add(by_wavelength(samples), threads);
}

void SampleFitAccumulator::merge(const SampleFitAccumulator& other) { rounds_->merge(*other.rounds_); }
bool SampleFitAccumulator::next_round() { return rounds_->next(); }
int SampleFitAccumulator::round() const { return rounds_->round(); }
bool SampleFitAccumulator::finished() const { return rounds_->finished(); }
long SampleFitAccumulator::samples() const { return rounds_->samples(); }
std::vector<double> SampleFitAccumulator::state() const { return rounds_->state(); }

SampleFitAccumulator SampleFitAccumulator::from_state(const Basis& basis, Weights weights,
                                                      std::span<const double> state) {
  return {weights, MixedRounds::from_state(with_sums(basis, weights), law_of(weights), state)};
}

FitResult SampleFitAccumulator::solve(const FitOptions& options) const {
  const MixedRounds& rounds = *rounds_;
  if (!rounds.finished())
    throw std::invalid_argument("round " + std::to_string(rounds.round()) +
                                " over the samples has not ended, or others are to follow: next_round()");
  std::string reason = rounds.reason();
  if (reason.empty() && options.covariance != Covariance::residuals) reason = only_residuals(options.covariance);
  FitResult result;
  if (reason.empty()) try {
      const auto gram = [&](double wavelength, std::size_t block) { return rounds.gram(wavelength, block); };
      const auto directions = [&](double wavelength) { return rounds.directions(wavelength); };
      result = mixed_fit(rounds, options, {gram, directions});
    } catch (const MixedFailure& failure) {
      reason = failure.what();
    }
  if (!reason.empty()) result = noise_fit(rounds, options, reason);
  result.weights = weights_;
  return result;
}

}  // namespace mmbrdf
