// SPDX-License-Identifier: BSD-3-Clause
// What people read of a command: lines and tables, as text or as a page of HTML that needs nothing else.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "pages/table.hpp"

namespace mmbrdf::program {

class Page {
 public:
  /// As they are; each ends with a line end.
  void add(const std::string& lines);
  void add(const Table& table) { parts_.emplace_back(table); }
  /// All of another one.
  void add(const Page& other);

  std::string text() const;
  /// The first line is its title.
  std::string html() const;
  /// Throws std::logic_error for the formats of programs.
  std::string written(Format format) const;

 private:
  std::vector<std::variant<std::string, Table>> parts_;  // no two texts beside each other
};

}  // namespace mmbrdf::program
