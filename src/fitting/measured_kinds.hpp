// SPDX-License-Identifier: BSD-3-Clause
/// What was measured, and where, as far as a mixed model asks; of parts of the samples it adds up.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "fitting/state_reader.hpp"
#include "mmbrdf/mixed/posterior.hpp"

namespace mmbrdf {

/// Samples by wavelength.
using Series = std::map<double, std::vector<Sample>>;
Series by_wavelength(std::span<const Sample> samples);

/// What is not known of samples, as they are in xy, and how often. A sample is complete if it knows all that any does,
/// and lost nothing on the way from another frame.
class MeasuredKinds {
 public:
  void add(const Series& series);
  void merge(const MeasuredKinds& other);

  std::vector<double> wavelengths() const;
  Elements known() const;    ///< in any of them
  Elements missing() const;  ///< in any of them
  long samples(double wavelength) const;
  long incomplete(double wavelength) const;  ///< of them
  bool any_as_measured() const;              ///< in another frame

  void append(std::vector<double>& state) const;
  static MeasuredKinds from_state(StateReader& reader);

 private:
  using Counts = std::map<unsigned long, long>;  // by bits of elements, and one of as_measured
  std::map<double, Counts> at_;
};
bool is_complete(const Sample& sample, const Elements& known);
/// Those that are complete.
Series complete(const Series& series, const MeasuredKinds& kinds);
/// Why there is no mixed model of these; empty if there may be: of those that are complete, if few are not.
std::string no_mixed_model(const MeasuredKinds& kinds, const Basis& basis);

/// Distinct directions with their counts, as long as there are not too many of them.
class DirectionCounts {
 public:
  void add(std::span<const Sample> samples);
  void merge(const DirectionCounts& other);
  bool too_many() const { return too_many_; }
  std::vector<ReadingDirections> rising() const;

  void append(std::vector<double>& state) const;
  static DirectionCounts from_state(StateReader& reader);

 private:
  void limit();
  std::map<std::array<float, 4>, std::uint32_t> counts_;
  bool too_many_ = false;
};

}  // namespace mmbrdf
