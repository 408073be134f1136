// SPDX-License-Identifier: BSD-3-Clause
/// Whether samples are in the frame and the signs in which they are taken: how well they fit as if they were not.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/samples/inspection.hpp"

namespace mmbrdf {

/// Samples taken for something else, and what a fit of the normalised elements then leaves.
struct ConventionFit {
  std::string read_as;  ///< "frame xy, as declared", "frame sp", "S3 of the source reversed", …
  std::string remedy;   ///< what mends it, if it is so: "--frame sp"
  double rms = 0;       ///< of these elements together, not weighted
};

/// First as they were given (Sample::given_in), "as declared"; then in the other frames; and in the frame in which they were
/// given with Stokes components reversed in both beams or one, with the axes of one beam turned by 90 degrees and, where that
/// frame turns with the beams, transposed or with exchanged arms. One change at a time, of the samples at the wavelength of the
/// first, and of no more than `most`, evenly spread. The basis is isotropic: no other says what a matrix must be like. Where
/// elements are missing, changes of these alone are left out, and readings in which a fit knows fewer or more than as declared;
/// nothing is left if it then knows f11 alone.
///
/// What no fit can tell is left out. An isotropic and reciprocal sample stays one with S4 reversed in both beams, with the
/// axes of both turned by 90 degrees, and in xy with the arms exchanged; S2 reversed in both beams is as S3 reversed in both,
/// and so are azimuths that are counted the other way, and in xy a transposed matrix. Throws std::invalid_argument as fit() does.
inline constexpr std::size_t most_tried = 1500;
std::vector<ConventionFit> convention_fits(std::span<const Sample> samples, const Orders& orders = {},
                                           DiscMapping mapping = DiscMapping::lambert, std::size_t most = most_tried);

/// "read as frame sp the residuals would be 0.0060 instead of 0.0178: …", and "--frame sp", if another is better by more than
/// this factor; no fault if none is.
Finding convention_finding(std::span<const ConventionFit> fits);
inline constexpr const char* convention_fault = "frame or signs";
inline constexpr double better_convention = 1.5;

/// The same in a line; empty if there is no fault.
std::string convention_warning(std::span<const ConventionFit> fits);

/// That of these samples. Quick: only if low orders and few samples give cause are all fitted.
std::string convention_warning(std::span<const Sample> samples, const Orders& orders, DiscMapping mapping);

}  // namespace mmbrdf
