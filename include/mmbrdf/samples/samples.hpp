// SPDX-License-Identifier: BSD-3-Clause
/// Measured or simulated samples of a Mueller-matrix BRDF.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/geometry/geometry.hpp"
#include "mmbrdf/polarization/mueller.hpp"

namespace mmbrdf {

/// Elements as they were measured in one of the frames of the plane of incidence, `sp` or `scattering_plane`, which turn
/// with the beams. As in a Sample, but for element 11 of `normalized`, which is 1.
struct AsMeasured {
  Frame frame = Frame::sp;
  Mueller normalized;     ///< NaN: not measured
  Mueller uncertainty{};  ///< 0: not known
};

/// One measured matrix, in the xy frame.
struct Sample {
  double wavelength = 0;  ///< micrometres
  Geometry geometry;
  double f11 = 0;      ///< unpolarized BRDF in sr⁻¹; NaN: not measured
  Mueller normalized;  ///< f_ij / f11; element 11 is 1; NaN: not measured
  /// Standard uncertainties: element 11 of f11 in sr⁻¹, the others of f_ij / f11. 0: not known.
  Mueller uncertainty{};
  /// Only of a sample that loses elements on the way to xy: fits take it as it was measured where their rows can be turned
  /// (rows_turn() of fit.hpp).
  std::shared_ptr<const AsMeasured> as_measured{};
  Frame given_in = Frame::xy;  ///< from which its elements were turned to xy: faults of their signs are in this frame
};

/// The sample with its elements in the frame in which they were measured, if that is known, else in xy: to be looked at, not
/// to be fitted.
Sample in_own_frame(const Sample& sample);
inline Frame own_frame(const Sample& sample) { return sample.as_measured ? sample.as_measured->frame : Frame::xy; }

/// What is not measured in a sample, or in none of several.
Elements not_measured(const Sample& sample);
Elements not_measured(std::span<const Sample> samples);

/// What is measured in any of several, each in its own frame.
Elements measured_elements(std::span<const Sample> samples);

/// Those of several samples that are in a frame of their own.
struct SamplesInFrame {
  Frame frame = Frame::xy;
  std::size_t samples = 0;
  Elements measured;  ///< in any of them
};
std::vector<SamplesInFrame> by_own_frame(std::span<const Sample> samples);

/// Whether the uncertainty of any of its elements is known.
bool has_uncertainty(const Sample& sample);

/// On which side of its plane of incidence a geometry lies; a bit each, so that many can be told in one number.
enum Sides : unsigned {
  no_side = 0,
  plane_of_incidence =
      1,  ///< source, normal and receiver lie in one plane, to side_tolerance: also all that is at the normal
  negative_side = 2,  ///< sin(φr − φi) < 0
  positive_side = 4,
};
Sides side(const Geometry& geometry);
inline constexpr double side_tolerance = radians(0.1);  ///< of the one direction against the plane of the other

/// What samples hold, as their columns are called: "f11", "m12" … "m44" for 0, 1 … 15.
std::string sample_element(std::size_t element);

/// The distinct wavelengths, rising. Values are distinct if they differ by more than wavelength_resolution.
/// Throws std::invalid_argument, with the sample's number from 1, for a wavelength that is not positive and finite.
std::vector<double> wavelengths(std::span<const Sample> samples);
inline constexpr double wavelength_resolution = 1e-7;  ///< micrometres; files give at most 0.1 pm

/// Whether they differ by no more than that.
bool same_wavelength(double a, double b);

/// Which of these rising wavelengths it is, counted from 0; their number if it is none of them.
std::size_t wavelength_index(std::span<const double> wavelengths, double wavelength);

/// Only the samples at these wavelengths, in the order they had. Throws std::invalid_argument, with the wavelengths
/// there are, if one of them has no sample, and as wavelengths() does.
std::vector<Sample> at_wavelengths(std::span<const Sample> samples, std::span<const double> wavelengths);

/// Throws std::invalid_argument, with the sample's number from 1, for a wavelength that is not positive, an invalid
/// geometry, an infinite number, an uncertainty that is not finite or below 0, or a sample of which nothing is measured.
void require_valid(std::span<const Sample> samples);

/// What is measured at azimuths that are larger by `angle` (radians) if sample and beams are turned together: matrix and
/// uncertainties in the xy frame are turned with them, the latter as at_zero_azimuth() says.
Sample turned(const Sample& sample, double angle);

/// The sample as an isotropic specimen would give it at phi_i = 0: in axes turned with the plane of incidence. Its
/// uncertainties are turned as if the errors of its elements were uncorrelated, as a sample holds no correlations:
/// u'² = Σ c² u², c the coefficients of the rotation. Where one that counts is not known, neither is the result.
Sample at_zero_azimuth(const Sample& sample);

/// The sample whose matrix is in a frame, in the xy frame. What is unknown leaves unknown what it is mixed with, and is then
/// kept `as_measured`; uncertainties are turned as at_zero_azimuth() does.
Sample from_frame(const Sample& sample, Frame frame);

/// The other way: a sample, whose matrix is in the xy frame, with matrix and uncertainties in another, turned likewise. As it was
/// measured, if that was in this frame.
Sample in_frame(const Sample& sample, Frame frame);

/// Its matrix in sr⁻¹, in the frame of the sample. NaN: not measured.
Mueller measured_matrix(const Sample& sample);

/// Of the elements of measured_matrix(), as if the errors of f11 and of the normalised elements were uncorrelated: with F = f11 m,
///   u²(F) = m² u²(f11) + f11² u²(m),   all correlated through f11.
/// NaN where u of f11 or of an element is not known, or it was not measured.
MuellerCovariance covariance(const Sample& sample);

/// The group of each value, counted from 0 in rising order: values belong together if no gap between them exceeds the
/// tolerance. For angles and wavelengths that a file has rounded. The values must be finite.
std::vector<std::size_t> grouped(std::span<const double> values, double tolerance);

/// The grid of the published measurement (theory 3.1): theta_i = 0, 15, …, 75 degrees at azimuth π; reflected
/// directions with direction cosines 0.1 (i, j), i² + j² < 100; none closer than 5 degrees to retro-reflection. 1824
/// geometries, sorted by theta_i, then i, then j, as in the published file.
std::vector<Geometry> germer2017_grid();

/// Pairs of directions, each uniform in projected direction cosines with θ ≤ theta_max (radians), as in the published
/// random set. The same seed gives the same pairs. Throws std::invalid_argument for a negative count, or theta_max not
/// in (0, π/2].
std::vector<Geometry> random_geometries(int count, unsigned long seed, double theta_max = radians(75));

}  // namespace mmbrdf
