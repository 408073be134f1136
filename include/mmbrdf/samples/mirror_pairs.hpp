// SPDX-License-Identifier: BSD-3-Clause
/// What two samples that are each other's mirror image say without any model.
#pragma once

#include <span>

#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf {

/// Samples that are each other's mirror image in the plane of incidence: the same theta_i ≥ pair_tolerance, phi_i and
/// theta_r, and opposite phi_r − phi_i, all within pair_tolerance. A sample without handedness has
/// m(−δ) = P m(δ) P, P = diag(1, 1, −1, −1), in axes turned with phi_i (theory 1.2). No model is involved.
struct MirrorPairs {
  long pairs = 0;
  Mueller rms;  ///< of m(δ) − P m(−δ) P, over √2: the noise of one sample, and what breaks the symmetry. Of f11:
                ///< relative to the mean of the two.
  Mueller mean;  ///< half the mean of that difference, with sin δ > 0 in the first: 0 but for noise / √(2 pairs)
};
inline constexpr double pair_tolerance = radians(0.01);
MirrorPairs mirror_pairs(std::span<const Sample> samples);

}  // namespace mmbrdf
