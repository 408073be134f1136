// SPDX-License-Identifier: BSD-3-Clause
#include "pages/rounded.hpp"

#include <cmath>

#include "pages/output.hpp"

namespace mmbrdf::program {

std::string to_place_of(double value, const std::optional<double>& uncertainty) {
  const int decimals =
      uncertainty && *uncertainty > 0 ? 1 - static_cast<int>(std::floor(std::log10(*uncertainty))) : -1;
  return decimals < 0 || decimals > 12 ? format("%.6g", value) : format("%.*f", decimals, value);
}

std::string rounded(double value, const std::optional<double>& uncertainty) {
  if (!uncertainty) return to_place_of(value, uncertainty);
  return to_place_of(value, uncertainty) + " +- " + (*uncertainty > 0 ? to_place_of(*uncertainty, uncertainty) : "0");
}

}  // namespace mmbrdf::program
