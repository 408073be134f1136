// SPDX-License-Identifier: BSD-3-Clause
/// Cameras: a polarimeter in each pixel. All of them have the same numbers of states, read in the same pairs; their
/// states are their own. Pixels stand one behind the other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mmbrdf/polarimetry/calibration.hpp"
#include "mmbrdf/polarization/analysis_batch.hpp"

namespace mmbrdf {

/// What readings of pixels are reduced with: the inverse of each pixel's matrix, in single precision. Of a grid of at
/// least four states in each arm it is that of the arms, 4 (analyzers + generators) numbers; else 16 for each reading.
struct PixelInverses {
  std::size_t analyzers = 0, generators = 0;  ///< of arms; 0: whole inverses
  std::size_t readings = 0;                   ///< of a pixel
  /// Of arms A⁺ of each pixel, 4 × analyzers in rows, then W⁺ of each pixel, generators × 4. Else 16 numbers for each
  /// reading of each pixel.
  std::vector<float> numbers = {};
  std::size_t pixels() const;
};

/// Of pixels whose states are `generators` (4 for each state, state after state, pixel after pixel) and `analyzers`,
/// read in these pairs, or all for none. Pixels whose states do not determine all elements, or are not finite, have NaN.
/// Throws std::invalid_argument for sizes that are not those of as many pixels, and for more than most_states.
PixelInverses pixel_inverses(std::span<const double> generators, std::span<const double> analyzers,
                             const Polarimeter& like, int threads = 1);

/// The matrices of pixels, from `first` on as many as there are elements for, 16 numbers each in rows, from their
/// readings, summed in double precision. NaN for a pixel with a reading or an inverse that is not finite. Throws
/// std::invalid_argument for sizes that are not those of as many pixels, and for more of them than there are.
void muellers(const PixelInverses& inverses, std::span<const float> readings, std::span<float> elements,
              int threads = 1, std::size_t first = 0);

/// Why a pixel has no calibration.
enum class PixelFailure : std::uint8_t {
  none,
  not_finite,      ///< a reading is not finite, or the mean of its empty references not positive
  no_convergence,  ///< the fit did not end within most_pixel_steps, or left no finite numbers
  misfit,          ///< chi squared per degree of freedom above PixelOptions::most_misfit
  dependent,       ///< condition number of an arm above worst_condition
};

inline constexpr int most_pixel_steps = 20;

struct PixelOptions {
  int threads = 1;  ///< 0: one for each core. Results do not depend on it
  double most_misfit = 100;
};

/// Calibrations of pixels: one behind the other, states as pixel_inverses() takes them. NaN where one failed.
struct PixelCalibrations {
  std::vector<double> generators, analyzers;                            ///< 4 for each state
  std::vector<double> generator_uncertainties, analyzer_uncertainties;  ///< standard, of the same numbers
  std::vector<double> retarders, retarder_uncertainties;  ///< parameters() of each pixel, if they are such; else empty
  std::vector<double> misfit;                             ///< chi squared per degree of freedom
  std::vector<PixelFailure> failures;
};

/// Maximum likelihood in each pixel, as calibrate() ends, from one start: what calibrate() made of the mean of the image,
/// with the same references and options. Each pixel has its own states, gains, and properties of the references.
/// `readings` of a pixel are those of all references, one reference after the other; those within `references` are not
/// asked. Uncertainties are scaled by the misfit, and include that of the scale, as those of calibrate().
/// Pixels that fail are flagged, not thrown. Throws std::invalid_argument for a start from other references, or without
/// refinement; for sizes that are not those of as many pixels; and where there are not more readings than unknowns.
PixelCalibrations calibrate_pixels(const Calibration& start, std::span<const Reference> references,
                                   std::span<const float> readings, const CalibrationOptions& options,
                                   const PixelOptions& pixel_options = {});

}  // namespace mmbrdf
