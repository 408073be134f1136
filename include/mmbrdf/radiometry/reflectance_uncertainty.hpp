// SPDX-License-Identifier: BSD-3-Clause
/// Standard uncertainties of the quantities of reflectance.hpp: the slopes of the matrix over the coefficients,
/// integrated as the matrix is. Both arguments are of the same model, `prepared` at the wavelength asked for. What they
/// hold and leave out is said in prediction.hpp. All throw std::invalid_argument where the values do.
#pragma once

#include "mmbrdf/geometry/apertures.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"

namespace mmbrdf {

/// For light of any polarization in the sp frame of the incident beam.
double directional_hemispherical_uncertainty(const Model& model, const PreparedUncertainty& prepared,
                                             const Direction& incident, const Stokes& light_sp = {1, 0, 0, 0});

/// Through an analyzer in the sp frame of the reflected beam.
double hemispherical_directional_uncertainty(const Model& model, const PreparedUncertainty& prepared,
                                             const Direction& reflected, const Stokes& analyzer_sp = {1, 0, 0, 0});

double bihemispherical_uncertainty(const Model& model, const PreparedUncertainty& prepared);

/// Covariance of the mean matrix over two apertures, sr⁻², frame xy. `nodes` as in mean_rule: those of
/// an Average, or fewer, since an uncertainty needs few digits.
MuellerCovariance average_covariance(const PreparedUncertainty& prepared, const Aperture& source,
                                     const Aperture& receiver, int nodes);

}  // namespace mmbrdf
