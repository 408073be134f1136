// SPDX-License-Identifier: BSD-3-Clause
/// Models of one family in the modes of another.
#pragma once

#include "mmbrdf/model/model.hpp"

namespace mmbrdf {

/// An isotropic model in the modes of germer2017: the published coefficient layout. Exact, since that family is
/// evaluated at phi_i = 0 and turned: Rotation::covariant. The covariance is not carried over. Returns germer2017
/// models unchanged. Throws std::invalid_argument for an invalid or an anisotropic model.
Model in_published_form(const Model& model);

/// The isotropic model nearest to another one: least squares over the model's range of angles, in solid angle on both
/// sides, for f11 and m_ij apart, at phi_i = 0 (where Rotation makes no difference). f11 of a germer2017 model is
/// carried over exactly if the orders suffice. Name, reflectance table, validity and provenance are carried over, the
/// covariance is not.
/// Throws std::invalid_argument for an invalid or an anisotropic model, or orders above max_projected_order.
Model projected_on_isotropic(const Model& model, const Orders& orders);
inline constexpr int max_projected_order = 12;

}  // namespace mmbrdf
