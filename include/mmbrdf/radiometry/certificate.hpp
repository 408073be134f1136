// SPDX-License-Identifier: BSD-3-Clause
/// Models of samples whose reflectance a laboratory has certified: as 8°:d values, of one direction to the hemisphere.
#pragma once

#include <span>

#include "mmbrdf/model/model.hpp"

namespace mmbrdf {

/// A directional-hemispherical reflectance for unpolarized light, a part of 1.
struct CertifiedReflectance {
  double wavelength = 0;      ///< micrometres
  double value = 0;           ///< in (0, largest_reflectance]
  double uncertainty = 0;     ///< standard (k = 1)
  double theta = radians(8);  ///< polar angle of the direction, radians, below 90 degrees
};
inline constexpr double largest_reflectance = 1.2;

struct CertifiedModel {
  Model model;
  double change = 0;      ///< largest |f11 / f11 before − 1|, of the wavelengths of the certificate
  double wavelength = 0;  ///< where that is, micrometres
};

/// Beyond such a change the sample is another one than the certificate is of, or grey where the model is white. f11 alone
/// is rescaled: a darker sample scatters less often and so depolarizes less, which a factor does not know.
inline constexpr double noticeable_change = 0.03;

/// The model with another reflectance table, which makes its directional-hemispherical reflectance the certified one at
/// the wavelengths of the certificate; between them the factor of f11 is linear. Its validity ends where the certificate
/// does. Errors of the certificate count as one, the same at all its wavelengths; they replace what the fit leaves
/// uncertain of the scale of f11, so that u of the certified reflectance is that of the certificate, and are known where
/// the covariance of f11 is.
/// Throws std::invalid_argument for an invalid model, without values, for a wavelength that is there twice or outside
/// the fitted ones, a value, an uncertainty or an angle that makes no sense, and where the reflectance of the model is
/// not positive.
CertifiedModel certified(Model model, std::span<const CertifiedReflectance> certificate);

}  // namespace mmbrdf
