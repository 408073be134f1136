// SPDX-License-Identifier: BSD-3-Clause
/// Readings of a series as weighted rows of a mixed model.
#pragma once

#include <Eigen/Core>
#include <span>

#include "mixed/columns.hpp"
#include "mixed/evidence.hpp"
#include "mmbrdf/mixed/posterior.hpp"

namespace mmbrdf {

/// f11 of order first_order at some geometries.
Eigen::VectorXd first_f11(std::span<const double> coefficients, DiscMapping mapping,
                          std::span<const Geometry> geometries);

/// 1 / σ of noise variance 1 at each geometry. `f11` is what that of element 11 is relative to; empty: to nothing.
Eigen::VectorXd reading_weights(const ReadingLaw& law, std::span<const Geometry> geometries,
                                const Eigen::VectorXd& f11);

/// The sums G of readings at these directions, with the counts that they have.
Gram gram_of(const MixedColumns& columns, std::span<const ReadingDirections> readings, const ReadingLaw& law,
             std::span<const double> f11);

/// Posterior covariance of all columns of a block, not only of the isotropic ones. Throws std::invalid_argument for one in
/// its rounded form.
Eigen::MatrixXd covariance_of_all(const PosteriorData& data, const PosteriorAt& at, const BlockPosterior& block,
                                  const MixedColumns& columns);

/// How many geometries are worked on at once.
inline constexpr std::size_t readings_at_once = 256;

}  // namespace mmbrdf
