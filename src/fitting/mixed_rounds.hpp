// SPDX-License-Identifier: BSD-3-Clause
/// What the mixed model asks of samples, as sums in rounds over all of them: what a sum is weighed by comes from the
/// rounds before it. Sums of parts of the samples add up; memory does not grow with their number.
///
///   1  number and mean of f11, what was measured; f°, f11 of first_order, weighed by the law alone
///   2  where the law is relative: least f° and the sizes of f11 − f°, which say whether noise is relative to f11; f^,
///      f11 of first_order weighed as if the readings were without noise
///   3  least f^; least squares of the evaluated modes with the weights of the mixed model
///   4  where there is a mixed model: sums of each block (mixed/evidence.hpp), and directions
///
/// Rounds 3 and 4 are of complete samples alone, if that makes a mixed model.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fitting/measured_kinds.hpp"
#include "mixed/evidence.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "numerics/typical_size.hpp"

namespace mmbrdf {

/// What readings of a wavelength are weighed by, and what errors that they share do to them.
struct FirstPass {
  double mean = 0;  ///< of f11
  ReadingLaw law;
  std::vector<double> f11;  ///< f°, later f^: what the noise of f11 is relative to
  double least = 0;         ///< of the samples' f^
  Model model;              ///< least squares of the evaluated modes
};

/// Sums of a block over samples of one wavelength; the columns d are those of declared errors of 1.
Gram sums_of(const MixedColumns& columns, std::span<const Sample> samples, const FirstPass& first);

/// The orders of the isotropic modes behind a model of these.
Orders generous(const Orders& evaluated);
/// The columns of each block that was measured.
std::vector<MixedColumns> mixed_columns(const Basis& basis, const Elements& not_measured);

class MixedRounds {
 public:
  /// `laws` of some wavelengths in place of `law`.
  MixedRounds(const Basis& basis, const ReadingLaw& law, std::map<double, ReadingLaw> laws = {});

  /// To the sums of this round. Throws std::invalid_argument for samples that an earlier round did not have, and as
  /// FitAccumulator does; then nothing is added, or what is of this round is of no use.
  void add(const Series& series, int threads = 0);
  /// Throws std::invalid_argument for another basis, law or round, or where the rounds before were of other samples.
  void merge(const MixedRounds& other);
  /// Ends a round; false: that was the last. Throws std::invalid_argument without samples, or if they are not those of
  /// the first round.
  bool next();

  int round() const { return round_; }
  bool finished() const { return finished_; }
  long samples() const { return samples_; }  ///< of this round
  const Basis& basis() const { return basis_; }
  const MeasuredKinds& kinds() const { return kinds_; }
  /// Whether a mixed model is to be had of complete samples alone, which is what rounds 3 and 4 are of.
  bool leaves_out() const;
  /// Why there is no mixed model, as far as the rounds that are over tell; empty if there may be.
  std::string reason() const;

  const std::map<double, FirstPass>& first() const { return first_; }
  /// Of round 3. Rows of f11 are over a reflectance, and their noise is that of the law.
  FitAccumulator squares(const ReflectanceTable& reflectance) const;
  /// w² of each sample of a wavelength in round 3, relative to f11 / reflectance.
  std::vector<Mueller> weights(std::span<const Sample> samples, const FirstPass& first, double reflectance) const;
  /// Of round 4.
  const Gram& gram(double wavelength, std::size_t block) const { return sums_.at(wavelength).grams[block]; }
  const DirectionCounts& directions(double wavelength) const { return sums_.at(wavelength).directions; }

  std::vector<double> state() const;
  static MixedRounds from_state(const Basis& basis, const ReadingLaw& law, std::span<const double> state);

 private:
  struct Sums {  // of a round and a wavelength
    long count = 0;
    double f11 = 0;
    LeastSquares fit{1};
    double least = std::numeric_limits<double>::infinity();
    SizeCounts sizes;
    std::vector<Gram> grams;
    DirectionCounts directions;
  };

  void add_first(std::span<const Sample> samples, const ReadingLaw& law, Sums& sums) const;
  void add_second(std::span<const Sample> samples, const FirstPass& first, Sums& sums) const;
  void add_third(std::vector<Sample> samples, double wavelength, Sums& sums);
  void add_fourth(const Series& series, int threads);
  double known(double wavelength) const;
  void settle_first();
  void settle_second();
  void settle_third();
  void begin_fourth();
  const ReadingLaw& law_at(double wavelength) const;
  Sums& sums_at(double wavelength);
  std::vector<double> settled() const;
  void append_sums(std::vector<double>& state) const;
  void read_settled(StateReader& reader);
  void read_sums(StateReader& reader);

  Basis basis_;
  ReadingLaw law_;
  std::map<double, ReadingLaw> laws_;
  int round_ = 1;
  bool finished_ = false;
  long samples_ = 0, first_samples_ = 0;
  std::uint64_t digest_ = 0, first_digest_ = 0;  // of the samples, in whatever order
  MeasuredKinds kinds_;
  std::map<double, FirstPass> first_;
  std::map<double, FitAccumulator> squares_;
  std::map<double, Sums> sums_;
  std::shared_ptr<const std::vector<MixedColumns>> columns_;  // of round 4
};

}  // namespace mmbrdf
