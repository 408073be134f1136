// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/files/materials.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "files/embedded_materials.hpp"
#include "files/posterior_json.hpp"
#include "mmbrdf/files/model_file.hpp"
#include "text/json_text.hpp"

namespace mmbrdf {
namespace {

/// Its posterior is read when somebody asks for an uncertainty.
Model model_of(const EmbeddedMaterial& embedded) {
  const std::string name = "material " + std::string(embedded.name);
  Model model = model_from_json(embedded.json, name);
  if (embedded.posterior.empty()) return model;
  const auto data = [text = embedded.posterior, name, mapping = model.mapping, not_measured = model.not_measured] {
    const nlohmann::json root = parsed_json(text, name);
    return read_posterior_data(Field(root, name, "posterior"), mapping, not_measured);
  };
  model.posterior = Posterior(embedded.orders, model.mapping, model.not_measured, data);
  return model;
}

}  // namespace

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
    if (embedded.name == name) return model_of(embedded);
  std::string known;
  for (const std::string& other : materials()) known += (known.empty() ? "" : ", ") + other;
  throw std::invalid_argument("material '" + std::string(name) + "' is not one of " + known);
}

}  // namespace mmbrdf
