// SPDX-License-Identifier: BSD-3-Clause
/// The posterior in a model file (docs/formats.md).
#pragma once

#include "files/json_field.hpp"
#include "mmbrdf/mixed/posterior.hpp"

namespace mmbrdf {

nlohmann::ordered_json posterior_json(const Posterior& posterior);
PosteriorData read_posterior_data(const Field& field, DiscMapping mapping, const Elements& not_measured);
Posterior read_posterior(const Field& field, DiscMapping mapping, const Elements& not_measured);

}  // namespace mmbrdf
