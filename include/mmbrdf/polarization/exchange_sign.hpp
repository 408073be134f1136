// SPDX-License-Identifier: BSD-3-Clause
/// The sign of reciprocity, alone: the evaluation kernels include nothing of the standard library.
#pragma once

namespace mmbrdf {

/// −1 for elements 13, 23, 34 and their transposes, else 1 (Eq. 13); row and column from 0.
constexpr int exchange_sign(int row, int column) { return (row == 2) != (column == 2) ? -1 : 1; }

}  // namespace mmbrdf
