// SPDX-License-Identifier: BSD-3-Clause
/// The first three rounds of a mixed model over samples of one wavelength.
#pragma once

#include <span>

#include "fitting/mixed_rounds.hpp"

namespace mmbrdf {

inline FirstPass first_pass(std::span<const Sample> samples, const Basis& basis, const ReadingLaw& law) {
  MixedRounds rounds(basis, law);
  do rounds.add(by_wavelength(samples));
  while (rounds.next() && rounds.round() < 4);
  return rounds.first().begin()->second;
}

}  // namespace mmbrdf
