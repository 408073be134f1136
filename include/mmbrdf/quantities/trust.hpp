// SPDX-License-Identifier: BSD-3-Clause
/// Where a model is not physical.
#pragma once

#include "mmbrdf/model/model.hpp"

namespace mmbrdf {

/// A model alone, at one wavelength: theta_i and theta_r in steps of 2.5 degrees up to theta_max, phi_r − phi_i in
/// steps of 7.5 degrees from 0 to 180 (theory 6.2).
struct ModelDiagnostics {
  struct Extreme {
    double value = 0;
    Geometry geometry;
  };
  double wavelength = 0, theta_max = 0;
  int geometries = 0;
  Extreme margin;            ///< smallest coherency eigenvalue of M / f11: negative is not realizable (Cloude 1986)
  int unrealizable = 0;      ///< how many are negative
  Extreme f11;               ///< smallest, sr⁻¹
  int not_positive_f11 = 0;  ///< how many are
  double dhr = 0;  ///< largest directional-hemispherical reflectance, in steps of 0.5 degrees: above 1, the model
                   ///< or the scale of its data creates energy
  double dhr_theta_i = 0;
};

/// Throws std::invalid_argument for an invalid model or wavelength, or theta_max not in [0, π/2].
ModelDiagnostics model_diagnostics(const Model& model, double wavelength, double theta_max = radians(90));

}  // namespace mmbrdf
