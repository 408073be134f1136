// SPDX-License-Identifier: BSD-3-Clause
/// Whether angles that are taken for degrees are radians.
#pragma once

#include <span>

#include "mmbrdf/quantities/fit_warnings.hpp"

namespace mmbrdf {

/// Whether all angles of the samples would do as radians too, and the largest polar angle is no small one then.
bool may_be_radians(std::span<const Sample> samples);

/// That they are radians, if one of these holds:
///
///   - nine in ten of the polar angles of one direction, of four different ones at least, are multiples of half a degree
///     if they are radians
///   - f11, or the other elements, fit better by better_convention if they are radians, both than as they are and than
///     with polar angles as large as that and azimuths as they are. It takes twice as many samples as coefficients, and
///     azimuths that differ.
///
/// Else a finding without a fault. Of real data in a narrow cone polar angles are no multiples of 0.5 pi / 180 degrees, and
/// if they vary as much as a whole hemisphere would, azimuths do not explain it. `samples` may_be_radians().
Finding radian_finding(std::span<const Sample> samples);

}  // namespace mmbrdf
