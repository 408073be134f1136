// SPDX-License-Identifier: BSD-3-Clause
// Readings that a user has: a file, or a table of arrays.
#pragma once

#include <filesystem>
#include <istream>
#include <memory>
#include <optional>
#include <string>

#include "bindings.hpp"
#include "mmbrdf/files/csv.hpp"

namespace mmbrdf::python {

/// Where readings are. Made with the GIL, read without it.
class ReadingSource {
 public:
  /// `given` is a path, or what has columns by name, as dict, pandas.DataFrame and structured arrays have; `columns` other
  /// names of them. `argument` is what it is called in messages, "references" or "raw". Throws as open() for a file that
  /// cannot be read, and a ValueError that names all columns that are missing.
  ReadingSource(const Given& given, const ColumnNames& columns, const char* argument);

  /// The file without its folders, or the argument.
  const std::string& name() const { return name_; }

  /// use(stream, name for messages). Of a table std::runtime_error is std::invalid_argument, with the row in the place of a
  /// line.
  template <class Use>
  auto read(Use use) const {
    const std::unique_ptr<std::istream> in = opened();
    if (!is_table_) return use(*in, path_.string());
    try {
      return use(*in, name_);
    } catch (const std::runtime_error& error) {
      throw of_a_row(error);
    }
  }

 private:
  std::unique_ptr<std::istream> opened() const;
  std::invalid_argument of_a_row(const std::runtime_error& error) const;

  std::filesystem::path path_;
  std::string name_;
  std::optional<std::string> text_;
  bool is_table_;
};

}  // namespace mmbrdf::python
