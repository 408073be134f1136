// SPDX-License-Identifier: BSD-3-Clause
// Materials of the RGL data base: a tensor file of spectra over samples of the unit square, which the density vndf of
// visible normals, another one for each direction to the source, turns into normals of mirrors.
#pragma once

#include "formats/reader.hpp"
#include "mmbrdf/formats/export.hpp"

namespace mmbrdf {

bool is_rgl(std::string_view head, std::uint64_t size);
std::unique_ptr<ForeignFile::Reader> open_rgl(const Source& source);
Export::Made make_rgl(const Model& model, const ExportOptions& options);

}  // namespace mmbrdf
