// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace mmbrdf {

/// Eigen counts with signed numbers, the standard library without.
inline Eigen::Index index(std::size_t n) { return static_cast<Eigen::Index>(n); }

}  // namespace mmbrdf
