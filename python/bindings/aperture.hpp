// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mmbrdf/geometry/apertures.hpp"

#include <string>
#include <utility>
#include <vector>

#include "bindings.hpp"

namespace mmbrdf::python {

/// An aperture as Python holds it, and what it was made by: a function of this name, of these angles in degrees, and
/// ports.
struct ApertureObject : Aperture {
  ApertureObject(const Aperture& aperture, std::string its_name, std::vector<double> its_angles)
      : Aperture(aperture), name(std::move(its_name)), angles(std::move(its_angles)) {}
  std::string name;
  std::vector<double> angles;
  std::vector<ApertureObject> ports;
};

}  // namespace mmbrdf::python
