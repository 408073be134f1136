// SPDX-License-Identifier: BSD-3-Clause
/// What a mixed model says of a sample: isotropic modes of generous order with their posterior mean and covariance, and
/// the parts of the sample, the instrument and the noise that an isotropic model has no place for (theory 8).
///
/// Each block of the isotropic family at each wavelength has readings y = X β + ε, the coefficients β normal with
/// variances v that depend on a few hyperparameters, the noise ε with variance s² law², relative for f11. The
/// covariance of β given the readings depends on where was measured, not on what: it is kept as the directions of the
/// readings, or, for too many of them, rounded to 12 bits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/basis/modes.hpp"

namespace mmbrdf {

/// An error that all readings of a series share and that it cannot show.
struct SharedError {
  std::string name;  ///< errors of one name are one part of an uncertainty
  double size = 0;   ///< standard uncertainty, in the unit of its effects
  friend bool operator==(const SharedError&, const SharedError&) = default;
};

/// Those that are declared: none by default.
struct DeclaredErrors {
  double scale = 0;     ///< of f11, relative
  double source = 0;    ///< polar angle of the source's arm, radians
  double receiver = 0;  ///< polar angle of the receiver's arm, radians
  friend bool operator==(const DeclaredErrors&, const DeclaredErrors&) = default;
};
/// "declared scale", "declared source arm", "declared receiver arm": the first of every posterior, of size 0 too.
std::vector<SharedError> shared_errors(const DeclaredErrors& declared);
inline constexpr std::size_t declared_errors = 3;

/// Where was measured, and how often: theta_i, phi_i, theta_r, phi_r in radians. Rounded to 24 bits, u changes by less
/// than 5e-5 of itself.
struct ReadingDirections {
  std::array<float, 4> angles{};
  std::uint32_t count = 1;
  friend bool operator==(const ReadingDirections&, const ReadingDirections&) = default;
};

/// σ = s √(cos^a θi / cos^b θr) of the readings, the law of the weights.
struct ReadingLaw {
  double incident_exponent = 1, reflected_exponent = 1;
  bool relative = true;  ///< the noise of f11 is relative to f11
  friend bool operator==(const ReadingLaw&, const ReadingLaw&) = default;
};

struct BlockPosterior {
  std::vector<double> hyperparameters;  ///< in the order of hyperparameter_names()
  double noise_variance = 0;            ///< s²
  double evidence = 0;                  ///< logarithm, with the hyperprior, less constants
  std::vector<double> mean;             ///< of the isotropic modes of the generous orders, in canonical order
  std::vector<float> free_mean;         ///< of the other columns
  std::vector<float> shared;      ///< what each shared error of size 1 does to the isotropic modes: errors × modes
  std::vector<float> deviations;  ///< rounded form only: standard deviations of the isotropic modes
  std::vector<std::int16_t>
      factor;  ///< rounded form only: lower triangle of the factor of their correlations × full_scale
};

inline constexpr double full_scale = 2047;  ///< of 12 bits with a sign

struct PosteriorAt {
  double wavelength = 0;               ///< micrometres
  ReadingLaw law;                      ///< of the noise
  std::vector<double> f11;             ///< what the noise of f11 is relative to: isotropic modes of order first_order
  std::size_t readings = 0;            ///< which of the lists of directions
  std::vector<BlockPosterior> blocks;  ///< those of the isotropic family that were measured, in canonical order
};

inline constexpr int first_order = 7;                 ///< of the fit that weights are relative to
inline constexpr std::size_t most_directions = 9000;  ///< beyond these the covariance is kept in its rounded form

struct PosteriorData {
  Orders orders;  ///< of the isotropic modes: generous
  DiscMapping mapping = DiscMapping::lambert;
  Elements not_measured{};          ///< unknown: of blocks that are not there, or left open by the readings of theirs
  std::vector<SharedError> errors;  ///< those that are declared first
  std::vector<std::vector<ReadingDirections>> readings;  ///< lists of directions, each for one or several wavelengths
  std::vector<PosteriorAt> wavelengths;                  ///< rising
  Elements unread{};  ///< of blocks that are there, elements of which no reading tells
};

/// iso, slope, q1, q2, q3, free_slope, odd, and nonreciprocal for block 11 or calibration for the others.
std::vector<std::string> hyperparameter_names(const Block& block);

/// A posterior as it was found: it does not change, so that covariances are worked out once, when they are asked for,
/// for all copies. May be used in many threads at once.
class Posterior {
 public:
  /// Throws std::invalid_argument unless sizes agree, numbers are finite, variances positive and wavelengths rise, and of each
  /// block some element is read.
  explicit Posterior(PosteriorData data);
  /// The same, of data that are made when more of them is asked for than is given here. Whatever asks then throws what
  /// `data` throws, and std::invalid_argument as above or for data that are of something else.
  Posterior(const Orders& orders, DiscMapping mapping, const Elements& not_measured,
            std::function<PosteriorData()> data);

  const PosteriorData& data() const;
  DiscMapping mapping() const;
  const Elements& not_measured() const;
  const std::vector<Block>& blocks() const;  ///< of the isotropic modes, in canonical order
  /// Of the isotropic modes of a block at one of the wavelengths, without declared errors: square.
  std::span<const double> covariance(std::size_t wavelength, std::size_t block) const;

 private:
  struct State;
  std::shared_ptr<const State> state_;
};

}  // namespace mmbrdf
