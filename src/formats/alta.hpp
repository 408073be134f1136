// SPDX-License-Identifier: BSD-3-Clause
// ALTA text: a header of lines that begin with # and a letter, then rows of coordinates and values.
#pragma once

#include "formats/reader.hpp"

namespace mmbrdf {

bool is_alta(std::string_view head, std::uint64_t size);
std::unique_ptr<ForeignFile::Reader> open_alta(const Source& source);

}  // namespace mmbrdf
