// SPDX-License-Identifier: BSD-3-Clause
// MERL binary: three 32-bit counts of theta_h, theta_d and phi_d, then red, green and blue planes of doubles.
#pragma once

#include "formats/reader.hpp"

namespace mmbrdf {

bool is_merl(std::string_view head, std::uint64_t size);
std::unique_ptr<ForeignFile::Reader> open_merl(const Source& source);

}  // namespace mmbrdf
