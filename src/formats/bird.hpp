// SPDX-License-Identifier: BSD-3-Clause
// BiRD JSON v1.0: an object with metadata and data; in data a list of values for each variable, a row at each place.
#pragma once

#include "formats/reader.hpp"
#include "mmbrdf/formats/export.hpp"

namespace mmbrdf {

bool is_bird(std::string_view head, std::uint64_t size);
std::unique_ptr<ForeignFile::Reader> open_bird(const Source& source);
Export::Made make_bird(const Model& model, const ExportOptions& options);

}  // namespace mmbrdf
