// SPDX-License-Identifier: BSD-3-Clause
/// Directions, pairs of directions, and the reference frames of a Mueller-matrix BRDF.
///
/// Both directions point away from the sample: to the source and to the detector. phi is counted from x towards y.
/// Forward scattering is phi_r − phi_i = π; retro-reflection is theta_r = theta_i, phi_r = phi_i.
/// The light itself propagates along k_in = −unit_vector(incident) and k_out = unit_vector(reflected).
#pragma once

#include <array>
#include <numbers>
#include <string>

#include "mmbrdf/polarization/covariance.hpp"
#include "mmbrdf/text/units.hpp"

namespace mmbrdf {

/// Components along x, y and z; z is the surface normal.
using Vector3 = std::array<double, 3>;

/// Polar angle from the surface normal and azimuth, in radians. At theta = 0 the azimuth still has a meaning: it
/// chooses the axes s and p there.
struct Direction {
  double theta = 0;
  double phi = 0;
  friend bool operator==(const Direction&, const Direction&) = default;
};

Vector3 unit_vector(const Direction& direction);

/// The direction of a vector of any length; phi in (−π, π], and phi = 0 along the normal.
/// Throws std::invalid_argument if the vector is 0, not finite, or points below the surface (z < 0).
Direction direction(const Vector3& vector);

/// The direction with theta ≥ 0 that files write with a negative polar angle: (−θ, φ) is (θ, φ + π). The published
/// data have theta_i < 0 and phi_i = 0, that is the source at azimuth π. Directions with theta ≥ 0 come back unchanged.
Direction unfolded(const Direction& direction);

/// The direction at these angles in degrees, as files, the program and Python give them: unfolded, and exactly so,
/// since 180 is exact in degrees. Throws std::invalid_argument for a polar angle that is not in [−90, 90].
Direction direction_from_degrees(double theta, double phi);

struct Geometry {
  Direction incident;   ///< towards the source
  Direction reflected;  ///< towards the detector
  friend bool operator==(const Geometry&, const Geometry&) = default;
};

/// A term of a weighted sum over geometries, such as a quadrature.
struct WeightedGeometry {
  Geometry geometry;
  double weight = 0;
};

/// Throws std::invalid_argument, naming the angle in degrees, unless both polar angles are in [0, π/2] and all four
/// angles are finite. `where`, such as "sample 3", begins the message.
void require_valid(const Geometry& geometry, const char* where = "");

/// Source and detector exchanged.
Geometry exchanged(const Geometry& geometry);

/// Which axes (e1, e2) the Stokes components refer to, for each of the two beams.
enum class Frame {
  xy,                ///< (y, x): the axes at the surface normal, carried along the meridian to the beam. No
                     ///< singularity. y ≈ −y_lab for scattered and +y_lab for incident light near the normal.
  sp,                ///< (s, p): s = z × k / |z × k|, p = k × s. At theta = 0, s follows the azimuth that was given.
  scattering_plane,  ///< (⊥, ∥): ⊥ = k_in × k_out / |…| for both beams, ∥ = k × ⊥.
};

/// "xy", "sp", "scattering_plane"; the opposite throws std::invalid_argument for another name.
std::string to_string(Frame frame);
Frame frame_from(const std::string& name);

/// Angle in radians from the frame's (e1, e2) axes to (y, x), separately for each beam:
///   M_xy = rotator(scattered) · M_frame · rotator(incident)ᵀ          (theory 1.1)
struct FrameAngles {
  double scattered = 0;
  double incident = 0;
};

/// Singular cases, all decided by the azimuths that were given:
///   theta = 0 in `sp`          s follows phi, as elsewhere: scattered = −phi_r, incident = +phi_i (theory 1.1);
///   |k_in × k_out| < parallel_limit in `scattering_plane`, which is retro-reflection (k_out = −k_in) or light straight
///   through (k_out = +k_in, both beams grazing): ⊥ is the s axis of the incident beam, the limit within the plane of
///   incidence.
/// Not checked: the geometry must be valid.
FrameAngles angles_to_xy(const Geometry& geometry, Frame frame);
inline constexpr double parallel_limit = 1e-8;

/// A Mueller matrix in another frame. Exact to frame_error × |largest element|; round trips too. To and from
/// scattering_plane the rounding of phi_r − phi_i, some 4e-16, adds up to 8 / |k_in × k_out| times itself.
/// Throws std::invalid_argument for an invalid geometry.
Mueller change_frame(const Mueller& m, const Geometry& geometry, Frame from, Frame to);

/// The covariance of a matrix's elements, of all sixteen or of f11 and the normalised ones, in another frame.
/// Throws std::invalid_argument for an invalid geometry.
MuellerCovariance change_frame(const MuellerCovariance& covariance, const Geometry& geometry, Frame from, Frame to);
inline constexpr double frame_error = 1e-14;

/// The matrix of an isotropic sample at the geometry turned by `angle` about the normal, in the xy frame (theory 1.2):
///   M_xy(phi_i + a, phi_r + a) = R(−a) M_xy(phi_i, phi_r) R(−a).
Mueller turned(const Mueller& m_xy, double angle);

}  // namespace mmbrdf
