// SPDX-License-Identifier: BSD-3-Clause
/// Files of models (docs/formats.md).
///
/// Reading throws std::runtime_error with "file:line: …" and the value that is wrong.
/// Writing replaces a file as a whole: write_file.hpp.
#pragma once

#include <string>
#include <string_view>

#include "mmbrdf/model/model.hpp"

namespace mmbrdf {

/// The project's own model files (docs/formats.md). A model read back has the same bits, but for the angles of its
/// validity. Reading throws std::runtime_error with "name: field: …"; writing std::invalid_argument for an invalid
/// model.
inline constexpr int schema_version = 1;
Model model_from_json(std::string_view text, const std::string& name);
std::string to_json(const Model& model);

/// A model from a file: JSON if the first character that is not white space is {, else published coefficients. A model
/// without a name gets that of the file, without folder and extension.
Model load_model(const std::string& path);

/// JSON, or the published coefficient layout if the path ends in .csv or .CSV.
void save_model(const std::string& path, const Model& model);

}  // namespace mmbrdf
