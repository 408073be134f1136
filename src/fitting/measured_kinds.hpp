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

struct MeasuredKinds {
  std::map<double, long> samples;  ///< at each wavelength
  Elements known, unknown;         ///< in any of them
  bool as_measured = false;        ///< any of them

  void add(const Series& series);
  void merge(const MeasuredKinds& other);
};
/// Why there is no mixed model of these; empty if there may be.
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
