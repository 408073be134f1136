// SPDX-License-Identifier: BSD-3-Clause
// Rusinkiewicz' coordinates: the half direction h between source and detector, and the source as seen from it.
#pragma once

#include "mmbrdf/geometry/geometry.hpp"
#include "mmbrdf/polarization/mueller.hpp"

namespace mmbrdf {

/// With h at azimuth 0; z may be below the horizon.
struct HalfDifference {
  Vector3 incident, reflected;
  /// (i × o) / |i × o|, and its limit where i = o: perpendicular to the scattering plane.
  Vector3 perpendicular;
};

/// At difference azimuth 0 the source is farther from the normal than h. Angles in radians.
HalfDifference half_difference(double theta_h, double theta_d, double phi_d);

/// Whether both directions are above the horizon.
bool above_horizon(const HalfDifference& directions);

/// Of an isotropic sample: φ_i = 0 and φ_r = φ_r − φ_i in (−π, π]. Along the normal azimuths are 0. The directions must be
/// above the horizon.
Geometry isotropic_geometry(const Vector3& incident, const Vector3& reflected);

/// The coordinates of two directions above the horizon, with phi_d in (−π, π]; 0 where it has no meaning.
struct HalfAngles {
  double theta_h = 0, theta_d = 0, phi_d = 0;
};
HalfAngles half_angles(const Vector3& incident, const Vector3& reflected);

/// Of directions above the horizon: the geometry, and what turns a matrix about the perpendicular axis of both beams
/// into one in the frame xy there, left × M × right.
struct NodeAxes {
  explicit NodeAxes(const HalfDifference& directions);
  Geometry geometry;
  Mueller left, right;
};

}  // namespace mmbrdf
