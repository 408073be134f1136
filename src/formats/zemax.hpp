// SPDX-License-Identifier: BSD-3-Clause
// Zemax tabular BSDF text: keywords with lists of angles, then for each incidence a line TIS and a table of azimuth and
// radial angle about the specular ray.
#pragma once

#include "formats/reader.hpp"

namespace mmbrdf {

bool is_zemax(std::string_view head, std::uint64_t size);
std::unique_ptr<ForeignFile::Reader> open_zemax(const Source& source);

}  // namespace mmbrdf
