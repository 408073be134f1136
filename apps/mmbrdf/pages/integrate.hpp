// SPDX-License-Identifier: BSD-3-Clause
// What `mmbrdf integrate` found, and how it is written.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mmbrdf/model/model.hpp"
#include "mmbrdf/polarization/mueller.hpp"
#include "pages/budget.hpp"
#include "pages/output.hpp"

namespace mmbrdf::program {

enum class Integral { dhr, hdr, bhr, brdf, reflectance_factor, radiance_factor, reflectance, mueller };

/// Throws std::invalid_argument for another name.
Integral quantity_from(const std::string& name);
std::string to_string(Integral quantity);

/// Whether it is one of a source and a receiver, and not of the whole hemisphere.
bool needs_geometry(Integral quantity);

/// One number, or all sixteen of a matrix. Matrices are in the frame xy.
struct IntegratedRow {
  std::optional<double> wavelength_nm;       // none: unknown
  std::optional<double> theta_deg;           // of dhr and hdr
  std::vector<double> values;                // 1 or 16
  std::vector<double> uncertainties;         // as many, or none: not known
  std::vector<ExpandedUncertainty> budgets;  // with --budget, of each
  double quadrature_error = 0;               // in units of the values
  long geometries = 1;
  Outside outside = inside;
};

struct Integrated {
  std::string model;
  Integral quantity;
  std::string polarization;            // as typed
  std::string source, receiver;        // descriptions, with --geometry
  std::optional<double> extrapolated;  // share of the hemisphere's projected solid angle beyond the fitted angles
  std::vector<IntegratedRow> rows;
  bool several_wavelengths = false;
  std::string uncertain;           // what the uncertainties are of: uncertain_of()
  std::string not_in_it;           // missing_from_uncertainty()
  std::vector<std::string> terms;  // and of these
  std::optional<double> coverage;  // of the budgets, beside that of 95 %
};

/// As CSV the columns are [wavelength_nm,][theta_i_deg,|theta_r_deg,]QUANTITY,u_QUANTITY, with --geometry followed by
/// quadrature_error,validity; the sixteen elements and their uncertainties for mueller.
std::string written(const Integrated& result, Format format);

}  // namespace mmbrdf::program
