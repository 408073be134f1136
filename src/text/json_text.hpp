// SPDX-License-Identifier: BSD-3-Clause
// JSON as the text of a file.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace mmbrdf {

/// Throws std::runtime_error with "name:line: ..." for what is not JSON, and for a field that is there twice.
nlohmann::json parsed_json(std::string_view text, const std::string& name);

/// Lines of at most 120 characters; short arrays stay in one.
std::string json_text(const nlohmann::ordered_json& value);

}  // namespace mmbrdf
