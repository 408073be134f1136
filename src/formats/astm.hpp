// SPDX-License-Identifier: BSD-3-Clause
// ASTM E1392 and E2387 text: a header of keywords, NUM_POINTS and at last VARS with the names of columns, then rows.
#pragma once

#include "formats/reader.hpp"
#include "mmbrdf/formats/export.hpp"

namespace mmbrdf {

bool is_astm(std::string_view head, std::uint64_t size);
std::unique_ptr<ForeignFile::Reader> open_astm(const Source& source);

Export::Made make_astm(const Model& model, const ExportOptions& options);

}  // namespace mmbrdf
