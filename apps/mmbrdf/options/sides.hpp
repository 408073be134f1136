// SPDX-License-Identifier: BSD-3-Clause
// Source and receiver as they are typed: 0:45, 45a:0, 8:d-cone(8,180,4) …
#pragma once

#include <string>
#include <vector>

#include "mmbrdf/geometry/apertures.hpp"

namespace mmbrdf::program {

/// A shape with its numbers in degrees. Names: direction, a (a ring without width), d (the hemisphere), cone, annulus,
/// ellipse, rectangle, ring, cap.
struct Shape {
  std::string name;
  std::vector<double> numbers;
};

/// An aperture and the ports cut out of it.
struct Side {
  std::string text;
  std::vector<Shape> shapes;
};

struct Sides {
  Side source, receiver;
};

/// SOURCE:RECEIVER. Throws std::invalid_argument if the text has another form.
Sides sides_from(const std::string& text);

/// In radians. A direction without azimuth has `phi_deg`: 0 for sources, 180 for receivers, which is forward. Throws
/// std::invalid_argument for sizes that make no sense, or apertures that reach below the horizon.
Aperture aperture_of(const Side& side, double phi_deg);

/// What it is, with the projected solid angle.
std::string description(const Side& side, double phi_deg);

/// Whether the side is all or nearly all of the hemisphere by definition.
bool is_hemisphere(const Side& side);

/// What the help says about sides.
extern const char* const sides_help;

}  // namespace mmbrdf::program
