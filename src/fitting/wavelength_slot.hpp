// SPDX-License-Identifier: BSD-3-Clause
/// What there is of wavelengths, which are distinct to wavelength_resolution.
#pragma once

#include <map>

#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf {

/// all.end() if there is nothing of it.
auto find_wavelength(auto& all, double wavelength) {
  const auto near = all.lower_bound(wavelength - wavelength_resolution);
  return near != all.end() && near->first <= wavelength + wavelength_resolution ? near : all.end();
}

/// New where there is nothing yet.
template <class Of>
Of& wavelength_slot(std::map<double, Of>& all, double wavelength) {
  const auto found = find_wavelength(all, wavelength);
  return found != all.end() ? found->second : all[wavelength];
}

}  // namespace mmbrdf
