// SPDX-License-Identifier: BSD-3-Clause
// What all warnings of a fit go by.
#pragma once

namespace mmbrdf {

inline constexpr int coarser = 2;          // than the steps of a report
inline constexpr double exact_rms = 1e-9;  // rms of simulated data without noise

}  // namespace mmbrdf
