// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/files/materials.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "files/embedded_materials.hpp"
#include "mmbrdf/files/model_file.hpp"

namespace mmbrdf {

std::vector<std::string> materials() {
  std::vector<std::string> names;
  for (const EmbeddedMaterial& embedded : embedded_materials()) names.emplace_back(embedded.name);
  std::sort(names.begin(), names.end(), [](const std::string& a, const std::string& b) {  // ptfe-351 before ptfe-1064
    return std::pair(a.size(), a) < std::pair(b.size(), b);
  });
  return names;
}

Model material(std::string_view name) {
  for (const EmbeddedMaterial& embedded : embedded_materials())
    if (embedded.name == name) return model_from_json(embedded.json, "material " + std::string(name));
  std::string known;
  for (const std::string& other : materials()) known += (known.empty() ? "" : ", ") + other;
  throw std::invalid_argument("material '" + std::string(name) + "' is not one of " + known);
}

}  // namespace mmbrdf
