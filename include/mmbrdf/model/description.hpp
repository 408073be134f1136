// SPDX-License-Identifier: BSD-3-Clause
/// A model in words, a line each, as the program and reports have them. Units are degrees and nanometres.
#pragma once

#include <span>
#include <string>

#include "mmbrdf/model/model.hpp"

namespace mmbrdf {

/// "isotropic, orders 7,4, wavelength powers 0 to 1, lambert mapping: 142 modes, 284 coefficients"; for
/// Rotation::as_printed "germer2017 as printed, orders …"
std::string basis_line(const Model& model);

/// "theta_i <= 75, theta_r <= 81.87 degrees", or "not known"
std::string angles_line(const Validity& validity);

/// "f11 alone was measured", or "not measured: 12, 13 and 44".
std::string not_measured_line(const Elements& elements);

/// "theta_i <= 75, theta_r <= 81.87 degrees at 351, 532 nm", or what of it is known
std::string fitted_range(const Validity& validity);

/// What the model called `model` does not say about its range. Empty if it says all.
std::string unknown_range_line(const std::string& model, const Validity& validity);

/// "this model depends on the azimuth of the source: ", and how one of the same sample is made that does not: only models
/// of the anisotropic family are not converted.
std::string azimuth_of_source_line(Family family);

/// "outside the fitted range (theta_i+wavelength): fitted are theta_i <= 75, theta_r <= 81.87 degrees at 351, 532 nm"
std::string outside_line(Outside reasons, const Validity& validity);

/// Questions to a model, and those that leave the range to which it was fitted.
struct RangeCount {
  long asked = 0, outside = 0;
  Outside reasons = inside;  ///< of all together; also unknown_range

  void add(Outside where);  ///< one question
  void add(const RangeCount& more);

  /// "2 of 3 rows lie outside the fitted range" if `what` is "row". Empty if none does.
  std::string line(const std::string& what) const;
};

/// "351:0.97515,532:0.98416": the table but for its covariances, values with all their digits. Empty if there is none.
std::string reflectance_line(const ReflectanceTable& table);

/// "351, 532, 633, 1064 nm", of wavelengths in micrometres
std::string nanometre_list(std::span<const double> wavelengths);

/// For people, to 1e-9 nm: 0.532 micrometres give 532.
double nanometres(double wavelength);

/// "1 mode", "2 modes"
std::string counted(long count, const std::string& what);

}  // namespace mmbrdf
