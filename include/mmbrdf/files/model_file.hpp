// SPDX-License-Identifier: BSD-3-Clause
/// Files of models (docs/formats.md).
///
/// Reading throws std::runtime_error with "file:line: …" and the value that is wrong.
/// Writing replaces a file as a whole: write_file.hpp.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mmbrdf/model/model.hpp"

namespace mmbrdf {

/// The project's own model files (docs/formats.md). A model read back has the same bits, but for the angles of its
/// validity. Reading throws std::runtime_error with "name: field: …"; writing std::invalid_argument for an invalid
/// model.
inline constexpr int schema_version = 1;
Model model_from_json(std::string_view text, const std::string& name);
std::string to_json(const Model& model);

/// A way to write a model. What the library and its users know of formats is in these.
struct ModelFormat {
  std::string_view ending;  ///< of the paths that are written so, as .csv or .CSV; empty: of all others
  char first;               ///< with which its text begins, blanks apart; 0: with what no other one begins with
  Model (*read)(std::string_view text, const std::string& name);
  std::string (*write)(const Model& model);
  /// What is known about a model, besides its name, and has no place in such a text: "the covariance". Null: all has.
  std::vector<std::string> (*lost)(const Model& model);
};

/// The format of a path to write: published coefficients if it ends in .csv, else JSON.
const ModelFormat& model_format(const std::string& path);

/// A model from a file: JSON if the first character that is not white space is {, else published coefficients. A model
/// without a name gets that of the file, without folder and extension.
Model load_model(const std::string& path);

/// The text of such a file, which load_model() reads. Throws std::runtime_error for a file that cannot be read, or is no text.
std::string model_text(const std::string& path);
/// The same of that text, which messages call `path`.
Model model_from_text(std::string_view text, const std::string& path);

/// In the format of the path.
void save_model(const std::string& path, const Model& model);

}  // namespace mmbrdf
