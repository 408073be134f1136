// SPDX-License-Identifier: BSD-3-Clause
/// Whether samples are in the frame and the signs in which they are taken: how well they fit as if they were not.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mmbrdf/fitting/fit.hpp"

namespace mmbrdf {

/// Samples taken for something else, and what a fit of the 15 normalised elements then leaves.
struct ConventionFit {
  std::string read_as;  ///< "frame xy", "frame sp", "S3 of the source reversed", …
  double rms = 0;       ///< of the 15 elements together, not weighted
};

/// First as they are ("frame xy"), then in the frames sp and scattering_plane; with Stokes components reversed in both beams
/// or one; and with the axes of one beam turned by 90 degrees. One change at a time, of the samples at the wavelength of the
/// first, and of no more than `most`, evenly spread. The basis is isotropic: no other says what a matrix must be like.
///
/// What no fit can tell is left out. An isotropic and reciprocal sample stays one with S4 reversed in both beams, with the
/// axes of both turned by 90 degrees, and with the arms exchanged; S2 reversed in both beams, or a transposed matrix, is as S3
/// reversed in both. Throws std::invalid_argument as fit() does.
inline constexpr std::size_t most_tried = 1500;
std::vector<ConventionFit> convention_fits(std::span<const Sample> samples, const Orders& orders = {},
                                           DiscMapping mapping = DiscMapping::lambert, std::size_t most = most_tried);

/// "read as frame sp the residuals would be 0.0060 instead of 0.0178: …", if another is better by more than this factor.
/// Empty if none is.
std::string convention_warning(std::span<const ConventionFit> fits);
inline constexpr double better_convention = 1.5;

/// The same of these samples. Quick: only if low orders and few samples give cause are all fitted.
std::string convention_warning(std::span<const Sample> samples, const Orders& orders, DiscMapping mapping);

}  // namespace mmbrdf
