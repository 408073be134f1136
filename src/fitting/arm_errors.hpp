// SPDX-License-Identifier: BSD-3-Clause
/// What a reading changes by when an arm of the goniometer stands at another polar angle than it says.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mmbrdf/model/prepared.hpp"

namespace mmbrdf {

/// d(f11), d(m_ij) per radian that the arm of the source, or of the receiver, turns about the normal of the plane of
/// incidence, (sin φi, −cos φi, 0), with its polarization axes; in the xy frame of the direction that is said. By central
/// differences, relative error 1e-8.
struct ArmErrors {
  std::vector<Mueller> source, receiver;
};
ArmErrors arm_errors(const PreparedModel& model, std::span<const Geometry> geometries);

}  // namespace mmbrdf
