// SPDX-License-Identifier: BSD-3-Clause
// The names that files and the program use for enumerators: a table of each enum stands where the enum is defined.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "mmbrdf/text/printable.hpp"

namespace mmbrdf {

/// A row of such a table.
template <class Enum>
using Named = std::pair<Enum, const char*>;

/// Throws std::invalid_argument for a value that is no enumerator.
template <class Names, class Value>
std::string name_of(const Names& names, Value value) {
  for (const auto& [candidate, name] : names)
    if (candidate == value) return name;
  throw std::invalid_argument("unknown enumerator " + std::to_string(static_cast<int>(value)));
}

/// Throws std::invalid_argument, with what there is, for another name; `what` says of what it is one.
template <class Names>
auto value_of(const Names& names, const std::string& text, const char* what) {
  std::string known;
  for (const auto& [value, name] : names) {
    if (name == text) return value;
    known += (known.empty() ? "" : ", ") + std::string(name);
  }
  throw std::invalid_argument(std::string(what) + " " + in_quotes(text) + " is not one of " + known);
}

}  // namespace mmbrdf
