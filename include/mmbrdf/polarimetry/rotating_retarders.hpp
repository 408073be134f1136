// SPDX-License-Identifier: BSD-3-Clause
/// The polarimeter of two turning retarders (Azzam): a polarizer and a retarder behind it, the sample, a retarder and a
/// polarizer before the detector; each reading is one pair of azimuths of the retarders. A few numbers describe all its
/// states. Axes, signs and azimuths are those of mueller.hpp, angles in radians.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/geometry/geometry.hpp"
#include "mmbrdf/polarimetry/polarimeter.hpp"

namespace mmbrdf {

/// A polarizer and a retarder, as retarder() of elements.hpp: the axis of a positive retardance is the fast one.
struct RetarderArm {
  double retardance = radians(90);
  double offset = 0;         ///< azimuth of the retarder's axis at dial 0
  double polarizer = 0;      ///< azimuth of the axis that passes
  double diattenuation = 0;  ///< of the retarder along its axis: within −1 … 1
};

struct RotatingRetarders {
  RetarderArm generator, analyzer;
  double extinction = 0;    ///< of both polarizers: the part that passes across their axes
  double responsivity = 1;  ///< of the detector, relative to a reading of ½ (1, 1, 0, 0) · retarder · M · w
};

/// How far the dials of the two retarders are turned for a reading.
struct DialAngles {
  double generator = 0, analyzer = 0;
  friend bool operator==(const DialAngles&, const DialAngles&) = default;
};

/// Frames in equal steps from 0: the analyzer turns `ratio` times as far as the generator, which does `step` each frame.
/// Throws std::invalid_argument for a ratio or step that is not finite or 0, and for no frame or more than most_states.
std::vector<DialAngles> dial_angles(double ratio, double step, std::size_t frames);

/// w_j = retarder · polarizer · (2, 0, 0, 0) and a_j = responsivity · polarizer's first row · retarder, read pairwise.
/// Throws std::invalid_argument for numbers that are not finite, a diattenuation beyond ±1 or an extinction that is not
/// in [0, 1].
Polarimeter polarimeter(const RotatingRetarders& retarders, std::span<const DialAngles> dials);

/// The numbers of RotatingRetarders in the order of its covariances: retardance, offset, polarizer and diattenuation of
/// the generator, then of the analyzer, then extinction and responsivity.
inline constexpr std::size_t retarder_parameters = 10;
std::array<double*, retarder_parameters> parameters(RotatingRetarders& retarders);
std::array<double, retarder_parameters> parameters(const RotatingRetarders& retarders);
/// "retardance of the generator", …
std::string parameter_name(std::size_t parameter);

/// Slopes of the components of w_1, w_2, …, a_1, a_2, … over these numbers: 8 (frames) × retarder_parameters, row-major.
std::vector<double> slopes(const RotatingRetarders& retarders, std::span<const DialAngles> dials);

/// The covariance of those components, as Reduction takes it, from that of the numbers (row-major).
std::vector<double> state_covariance(const RotatingRetarders& retarders, std::span<const DialAngles> dials,
                                     std::span<const double> covariance);

}  // namespace mmbrdf
