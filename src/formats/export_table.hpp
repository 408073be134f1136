// SPDX-License-Identifier: BSD-3-Clause
// What writers of foreign formats share.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "mmbrdf/formats/export.hpp"
#include "mmbrdf/geometry/geometry.hpp"
#include "mmbrdf/polarization/mueller.hpp"

namespace mmbrdf {

/// Directions of a table are compared up to this polar angle: that of the fit, but compared_theta at most; 30 degrees of
/// a fit to the normal alone (below 1 degree), where there would be nothing to compare.
double compared_up_to(const Model& model);

/// Whether a turn of the sample changes what the model says.
bool depends_on_azimuth_of_source(const Model& model);

/// Throws std::invalid_argument unless a turn of the sample changes nothing.
void require_isotropic(const Model& model, const std::string& format);

/// Throws std::invalid_argument if the finest `table` is too coarse.
void require_error(const ExportError& error, const ExportOptions& options, const std::string& table);

/// The number at a geometry that a format without polarization holds, out of the matrix in the frame sp.
using Channel = std::function<double(const Mueller&)>;

/// Throws std::invalid_argument for a channel that is no quantity in sr⁻¹ or is made of unknown elements.
Channel channel_of(const Model& model, const std::string& name);

/// The only wavelength of the options. Throws std::invalid_argument if there are more; `format` as in "a Zemax file".
double one_wavelength(const ExportOptions& options, const std::string& format);

/// A direction at or below the horizon, moved to it; any other as it is.
Vector3 raised(const Vector3& v);

/// Of what a reader finds, beside what the model gives.
class Deviation {
 public:
  void add(double found, double expected, double f11) {
    const double part = found == expected ? 0 : (found - expected) / f11;
    squares_ += part * part;
    largest_ = std::max(largest_, std::abs(part));
    ++count_;
  }
  ExportError error(double theta_max) const {
    return {std::sqrt(squares_ / static_cast<double>(count_)), largest_, theta_max};
  }

 private:
  double squares_ = 0, largest_ = 0;
  long count_ = 0;
};

}  // namespace mmbrdf
