// SPDX-License-Identifier: BSD-3-Clause
// What `mmbrdf compare` prints.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "mmbrdf/model/model.hpp"
#include "mmbrdf/quantities/significance.hpp"
#include "mmbrdf/samples/comparison.hpp"
#include "pages/output.hpp"

namespace mmbrdf::program {

struct CompareReport {
  std::string first, second;
  std::vector<double> wavelengths = {};  ///< micrometres
  Comparison comparison = {};
  std::optional<std::array<Significance, 16>> significance = {};  ///< none: an uncertainty is not known
  std::string uncertain = {};                                     ///< of what u is, in words; or that it is not known
  std::optional<Rotation> rotation = {};                          ///< of the first model
  std::string matched = {};                                       ///< how samples were set beside samples, in words
};

std::string written(const CompareReport& report, Format format);

/// Wavelength in nm, and the four angles in degrees, of the largest difference.
std::array<double, 5> place(const Difference& d);

}  // namespace mmbrdf::program
