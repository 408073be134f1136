// SPDX-License-Identifier: BSD-3-Clause
// Zemax tabular BSDF text: keywords with lists of angles, then for each incidence a line TIS and a table of azimuth and
// radial angle about the specular ray.
#pragma once

#include "formats/reader.hpp"
#include "mmbrdf/formats/export.hpp"

namespace mmbrdf {

bool is_zemax(std::string_view head, std::uint64_t size);
std::unique_ptr<ForeignFile::Reader> open_zemax(const Source& source);
Export::Made make_zemax(const Model& model, const ExportOptions& options);

/// The direction at polar angle `radial` and azimuth about the specular ray, whose azimuth 0 points towards the normal,
/// for light from theta_i at azimuth 0 (radians). May be below the horizon.
Vector3 about_specular(double theta_i, double azimuth, double radial);

}  // namespace mmbrdf
