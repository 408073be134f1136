// SPDX-License-Identifier: BSD-3-Clause
// One number at each of the polar angles of both directions, 0 to 90 degrees, and of azimuths all around: what formats
// without polarization hold of an isotropic sample.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/formats/export.hpp"

namespace mmbrdf {

class AngleTable {
 public:
  /// The coarsest that has the error asked for. Throws std::invalid_argument if none has, or for a channel that is no
  /// quantity in sr⁻¹ or is made of unknown elements. `what` names the format.
  AngleTable(const Model& model, const ExportOptions& options, const std::string& what);

  struct Row {
    double theta_i, theta_r, phi_r;  ///< radians; phi_i = 0
    std::span<const double> values;  ///< of each wavelength
  };
  /// Rows in the order of theta_i, theta_r and phi_r, which rises fastest.
  void each(const std::function<void(const Row&)>& use) const;

  std::size_t rows() const { return thetas_ * thetas_ * azimuths_; }
  const ExportError& error() const { return error_; }

  /// "f11 in sr^-1 at 0, 5 … 90 degrees and azimuths of 5 degrees, at 532 nm", and what of it is negative
  const std::string& understood() const { return understood_; }

 private:
  double looked_up(const Geometry& geometry, std::size_t w) const;

  std::size_t thetas_ = 0, azimuths_ = 0, wavelengths_ = 0;
  std::vector<double> values_;
  ExportError error_;
  std::string understood_;
};

}  // namespace mmbrdf
