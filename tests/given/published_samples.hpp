// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "given/published.hpp"
#include "mmbrdf/files/samples_file.hpp"

namespace mmbrdf {

/// The published grid at one wavelength, micrometres. Only where published("PTFE.data.csv") is there.
inline std::vector<Sample> grid_at(double wavelength) {
  return at_wavelengths(read_samples(published("PTFE.data.csv")), std::array{wavelength});
}

}  // namespace mmbrdf
