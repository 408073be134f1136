// SPDX-License-Identifier: BSD-3-Clause
// The text of the files materials/*.json, compiled into the library by cmake/embed_materials.cmake.
#pragma once

#include <span>
#include <string_view>

#include "mmbrdf/basis/modes.hpp"

namespace mmbrdf {

struct EmbeddedMaterial {
  std::string_view name;         ///< file name without .json
  std::string_view json;         ///< the file's text without its posterior, nine tenths of it
  std::string_view posterior{};  ///< the text of that field; empty if there is none
  Orders orders{};               ///< of the posterior
};

/// All of them, in any order; they live as long as the program.
std::span<const EmbeddedMaterial> embedded_materials();

}  // namespace mmbrdf
