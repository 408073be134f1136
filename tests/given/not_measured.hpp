// SPDX-License-Identifier: BSD-3-Clause
/// Samples of which some elements were not measured.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/samples/simulation.hpp"

namespace mmbrdf {

inline constexpr Frame frames[] = {Frame::xy, Frame::sp, Frame::scattering_plane};
inline const Elements row_and_column_4 = 0x8888 | 0xf000, all_but_f11 = 0xfffe;

/// Samples that lack these elements, but for f11.
inline std::vector<Sample> without(const Elements& elements, std::vector<Sample> samples) {
  for (Sample& sample : samples)
    for (std::size_t e = 1; e < 16; ++e)
      if (elements[e]) sample.normalized.elements[e] = std::numeric_limits<double>::quiet_NaN();
  return samples;
}

/// 300 random geometries at 532 nm with this speckle.
inline std::vector<Sample> of_ptfe(double speckle = 0.006) {
  return simulate(material("ptfe-532"), std::array{0.532}, random_geometries(300, 3), speckle, 1);
}

}  // namespace mmbrdf
