// SPDX-License-Identifier: BSD-3-Clause
/// How far a model is from samples, or from another model: how much, and where.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/model/model.hpp"
#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf {

/// Differences d of one quantity over all samples.
struct Difference {
  long samples = 0;       ///< that have it, and the model too; 0: all else is 0, and nothing is known
  double rms = 0;         ///< √(mean of d²)
  double mean = 0;        ///< with its sign
  double largest = 0;     ///< |d| where it is largest
  double wavelength = 0;  ///< where that is, micrometres; the first such sample
  Geometry geometry;
};

struct Comparison {
  long samples = 0;
  long dark = 0;                          ///< of them: f11 of the model is not positive, and f11 alone is compared
  Difference f11;                         ///< in sr⁻¹
  Difference f11_relative;                ///< divided by f11 of the model
  std::array<Difference, 16> normalized;  ///< of f_ij / f11, in row-major order, xy frame; that of element 11 is 0
};

/// Measured − model for each sample, xy frame: f11 in sr⁻¹ (element 11), others m_ij. Throws std::invalid_argument for an
/// invalid model or geometry.
std::vector<Mueller> residuals(const Model& model, std::span<const Sample> samples);

/// Samples − model, for f11 and for the normalised elements.
/// Throws std::invalid_argument for an invalid model or sample, without samples, where f11 of the model is positive at
/// none of them (what would f_ij / f11 say there?), or for differences whose squares overflow.
Comparison compare(const Model& model, std::span<const Sample> samples);

/// Second − first model at each of the wavelengths (micrometres) and geometries. Throws
/// std::invalid_argument for an invalid model, wavelength or geometry, without geometries, where f11 of either model is
/// not positive (of the first: anywhere), or for differences whose squares overflow.
Comparison compare(const Model& first, const Model& second, std::span<const double> wavelengths,
                   std::span<const Geometry> geometries);

/// Second − first of samples that belong together (matching.hpp), pair by pair; `dark` counts those of the first. Throws
/// std::invalid_argument for lists of different lengths, and as compare() of a model does.
Comparison compare(std::span<const Sample> first, std::span<const Sample> second);

/// "f11 of the model is not positive at 3 of 40 samples: there f11 alone is compared"; empty where it is positive.
std::string dark_line(const Comparison& comparison);

/// The wavelengths to which both models were fitted; what one does not know is left to the other. Empty: neither knows,
/// or they share none.
std::vector<double> common_wavelengths(const Model& first, const Model& second);

/// How far a comparison goes: to where both polar angles are at most theta_max (radians); where that is not said, to the
/// angles to which a model was fitted at the wavelength of each sample, as far as these are known. Takes out the samples
/// beyond, and returns how many they were.
std::size_t leave_out_beyond(const Model& model, std::vector<Sample>& samples, std::optional<double> theta_max = {});

/// The same of samples that are compared with samples.
std::size_t leave_out_beyond(double theta_max, std::vector<Sample>& samples);

/// What the second model gives where both are compared: at each of the wavelengths (micrometres), and those of the
/// geometries that are not beyond for either. Throws std::invalid_argument as simulate() does.
std::vector<Sample> samples_to_compare(const Model& first, const Model& second, std::span<const double> wavelengths,
                                       std::span<const Geometry> geometries, std::optional<double> theta_max = {});

/// Root mean square over the 15 normalised elements, or those of them that are known; 0 of none.
double polarization_rms(const Comparison& comparison);

/// The largest difference of all, relative to f11: of f11_relative and the normalised elements.
Difference largest(const Comparison& comparison);

}  // namespace mmbrdf
