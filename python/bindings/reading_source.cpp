// SPDX-License-Identifier: BSD-3-Clause
#include "reading_source.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <fstream>
#include <sstream>
#include <tuple>

namespace mmbrdf::python {

ReadingSource::ReadingSource(const Given& given, const ColumnNames& columns, const char* argument) {
  const py::tuple found = py::module_::import("mmbrdf._tables").attr("source")(given, columns, argument);
  path_ = found[0].is_none() ? std::filesystem::path() : found[0].cast<std::filesystem::path>();
  text_ = found[1].cast<std::optional<std::string>>();
  is_table_ = found[0].is_none();
  name_ = is_table_ ? argument : path_.filename().string();
  if (!text_) require_readable(path_);
}

std::unique_ptr<std::istream> ReadingSource::opened() const {
  if (text_) return std::make_unique<std::istringstream>(*text_);
  return std::make_unique<std::ifstream>(open_input(path_));
}

/// The text has a line for the names, and counts from 1; rows of a table are counted from 0.
std::invalid_argument ReadingSource::of_a_row(const std::runtime_error& error) const {
  const std::string text = error.what(), head = name_ + ":";
  std::size_t end = head.size();
  while (end < text.size() && text[end] >= '0' && text[end] <= '9') ++end;
  if (!text.starts_with(head) || end == head.size() || end >= text.size()) return std::invalid_argument(text);
  const long line = std::stol(text.substr(head.size(), end - head.size()));
  const std::string row = line < 2 ? "" : ", row " + std::to_string(line - 2);
  return std::invalid_argument(name_ + row + text.substr(end));
}

}  // namespace mmbrdf::python
