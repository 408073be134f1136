// SPDX-License-Identifier: BSD-3-Clause
/// Where a model is not physical, and in which words.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mmbrdf/model/model.hpp"

namespace mmbrdf {

/// What f11 of a model says at one wavelength, in a few milliseconds: theta_i and theta_r in steps of 2.5 degrees up to
/// theta_max, phi_r − phi_i in steps of 7.5 degrees from 0 to 180 (theory 6.2); or `coarser` times these steps.
struct F11Diagnostics {
  struct Extreme {
    double value = 0;
    Geometry geometry;
  };
  double wavelength = 0, theta_max = 0;
  int geometries = 0;
  Extreme f11;               ///< smallest, sr⁻¹
  int not_positive_f11 = 0;  ///< how many are
  double dhr = 0;  ///< largest directional-hemispherical reflectance, in steps of 0.5 degrees: above 1, the model
                   ///< or the scale of its data creates energy
  double dhr_theta_i = 0;
  double u_dhr = 0;  ///< standard uncertainty of a dhr above 1; else, and where it is not known, 0
};

/// And the whole matrix, at the same places.
struct ModelDiagnostics : F11Diagnostics {
  Extreme margin;        ///< smallest coherency eigenvalue of M / f11: negative is not realizable (Cloude 1986)
  int unrealizable = 0;  ///< how many are negative
  bool whole = true;     ///< all elements were measured; else neither is known
};

/// Both throw std::invalid_argument for an invalid model or wavelength, or theta_max not in [0, π/2].
F11Diagnostics f11_diagnostics(const Model& model, double wavelength, double theta_max = radians(90), int coarser = 1);
ModelDiagnostics model_diagnostics(const Model& model, double wavelength, double theta_max = radians(90));

/// The largest polar angle of the data that a model was fitted to; π/2 if that is not known.
double fitted_theta_max(const Validity& validity);

/// A sentence on f11 that is not positive, and one on a reflectance above 1 by more than `surely` standard
/// uncertainties, or above `impossible`, with what is usually the cause; empty if there is none. `where` is such as
/// "within the fitted angles at 532 nm".
std::string not_positive_line(const F11Diagnostics& found, const std::string& where);
std::string energy_line(const F11Diagnostics& found, const std::string& where);
inline constexpr double surely = 5;       ///< honest fits of shiny samples are above 1 by two or three
inline constexpr double impossible = 10;  ///< a reflectance is not, whatever its uncertainty

/// Share of the pairs of directions within the fitted polar angles that no samples support at a wavelength, by their
/// projected solid angles. And a sentence on it where it is more than a twentieth, with the part where most are missing.
double unsupported_share(const Validity& validity, double wavelength);
std::string unsupported_line(const Validity& validity, double wavelength);

inline constexpr double much_unsupported = 0.05;

/// That part in numbers, from one node of DirectionPairs to another: where more than half of the pairs at such an angle are
/// missing. None where that is at all angles, or at no such angle.
struct Hole {
  struct Degrees {
    double from = 0, to = 0;
  };
  std::optional<Degrees> theta_i, theta_r, phi;  ///< phi: |phi_r - phi_i|
};
Hole unsupported_part(const Validity& validity, double wavelength);

/// And for pictures: which share of the pairs is missing for each theta_i, and for each theta_r and |phi_r - phi_i|; NaN
/// beyond the fitted angles. Empty where no pairs are known, or not those of an isotropic sample.
struct MissingShares {
  std::vector<double> theta_deg, phi_deg;  ///< of the nodes
  std::vector<double> theta_i;             ///< at each of theta_deg
  std::vector<double> detector;            ///< at each of theta_deg, and there at each of phi_deg
};
MissingShares missing_shares(const Validity& validity, double wavelength);

/// What the uncertainties of a model hold: "the fit, its instrument and its certificate"
std::string uncertain_of(const Model& model);
/// "scale, angles and sample are not in it": what uncertainties of that leave out, as far as is known. Empty for nothing.
std::string missing_from_uncertainty(const Model& model);

/// How a geometry is called in sentences: "theta_i 45, theta_r 60, phi_r - phi_i 90 degrees".
std::string place_line(const Geometry& geometry);

}  // namespace mmbrdf
