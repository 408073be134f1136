// SPDX-License-Identifier: BSD-3-Clause
// The NetCDF dataset of eradiate's mqdiffuse: brdf over (cos_theta_o, phi_d, cos_theta_i), evenly spaced.
#pragma once

#include "mmbrdf/formats/export.hpp"

namespace mmbrdf {

Export::Made make_mqdiffuse(const Model& model, const ExportOptions& options);

}  // namespace mmbrdf
