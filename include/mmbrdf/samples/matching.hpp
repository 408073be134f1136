// SPDX-License-Identifier: BSD-3-Clause
/// Samples of two measurements that were taken at the same places.
#pragma once

#include <span>
#include <vector>

#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf {

/// When two samples belong together: at the same wavelength (same_wavelength()), and each direction of the one within
/// `tolerance` (radians, the angle between them) of that of the other.
struct Matching {
  double tolerance = radians(0.1);
  bool mirrored = false;   ///< where there is none, also with the mirror image in the plane of incidence (theory 1.2)
  bool exchanged = false;  ///< also with source and detector exchanged (Eq. 12); with both, also with the image of that
};

/// Pairs: first[i] and second[i] belong together.
struct MatchedSamples {
  std::vector<Sample> first;
  std::vector<Sample> second;  ///< its images as they are measured where first[i] was, with their uncertainties
  long images = 0;             ///< how many of the second are images
};

/// Each sample of `second` with the nearest of `first`, where there is one; several may have the same. Matrices are in
/// the xy frame and are not moved within the tolerance. Throws std::invalid_argument for an invalid sample, or a tolerance that is
/// not in (0, largest_matching].
MatchedSamples matched(std::span<const Sample> first, std::span<const Sample> second, const Matching& matching = {});
inline constexpr double largest_matching = radians(5);

}  // namespace mmbrdf
