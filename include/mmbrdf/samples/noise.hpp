// SPDX-License-Identifier: BSD-3-Clause
/// The noise of a measurement, as a law of the two polar angles, and its estimate from the residuals of a fit.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf {

/// σ² = scale² cos^a θi / cos^b θr: absolute for the normalised elements, relative for f11. The number of speckles in
/// the receiver is proportional to cos θr / cos θi, so speckle alone has a = b = 1 (theory 3.3).
struct NoiseLaw {
  double scale = 1;               ///< σ at normal incidence and normal reflection
  double incident_exponent = 1;   ///< a
  double reflected_exponent = 1;  ///< b
};

/// σ at a geometry. Throws std::invalid_argument where it is infinite: at θr = 90 degrees if b > 0, at θi = 90 degrees
/// if a < 0 (to 1e-9).
double standard_deviation(const NoiseLaw& law, const Geometry& geometry);

/// 1 / σ², the weight of a sample in a fit. Throws std::invalid_argument where that is infinite: for scale 0, at θi =
/// 90 degrees if a > 0, at θr = 90 degrees if b < 0.
double weight(const NoiseLaw& law, const Geometry& geometry);

/// What samples of sintered PTFE leave almost empty, so that the residuals are noise: elements 14 and 41.
inline constexpr std::array<Element, 2> quiet_elements{{{0, 3}, {3, 0}}};

struct NoiseEstimate {
  NoiseLaw law;
  /// Of (ln scale, a, b), row-major: the inverse of Fisher's information. The standard uncertainty of the scale is
  /// scale × √(first element).
  std::array<double, 9> covariance{};
  long rows = 0;  ///< residuals that were used
};

/// "sigma^2 = 0.00510^2 cos(theta_i)^0.803 / cos(theta_r)^1.042, u 0.00012, 0.060, 0.040": the law, and the standard
/// uncertainties of its three numbers.
std::string to_string(const NoiseEstimate& estimate);

/// The law under which these residuals are most likely, if they are Gaussian, independent and of mean 0. ln σ² is
/// linear in (ln scale, a, b), so the likelihood has one maximum, found by Fisher's scoring. The residuals of a fit are
/// a little smaller than the noise, by one part in 2 rows / coefficients: a scale that is too small by that. Element 11
/// stands for f11: its residuals are divided by f11 of the sample. Throws std::invalid_argument if there is not one
/// residual for each sample, no element, fewer than 4 residuals, one that is not finite, or a polar angle of 90
/// degrees; where the polar angles do not determine the law, as with one angle of incidence only; and where all
/// residuals, or all but few, are 0.
NoiseEstimate estimate_noise(std::span<const Sample> samples, std::span<const Mueller> residuals,
                             std::span<const Element> elements = quiet_elements);

}  // namespace mmbrdf
