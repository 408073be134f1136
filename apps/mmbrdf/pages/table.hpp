// SPDX-License-Identifier: BSD-3-Clause
// A table: its columns are said once, its rows filled once, and it is printed as text, CSV, JSON,
// Markdown or HTML.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pages/output.hpp"

namespace mmbrdf::program {

using Json = nlohmann::ordered_json;

/// What has a column; a bit each.
enum Where : unsigned { nowhere = 0, in_text = 1, in_csv = 2, in_json = 4, everywhere = 7 };

struct Column {
  std::string name;
  std::string format = "%s";   ///< of printf, in text: "%12.6g"; "%12s" of words, integers, yes and no
  std::string heading = name;  ///< in text
  unsigned where = everywhere;
  std::string missing = "-";              ///< in text, for null
  std::string (*digits)(double) = exact;  ///< in CSV
};

struct Table {
  using Row = std::vector<Json>;  ///< a cell for each column; null is what is not known, or does not exist

  std::vector<Column> columns;
  std::vector<Row> rows = {};  ///< a short one ends in nulls
};

/// The headings, then line by line, with a blank between columns. A column called u, or u_ and more, is the standard
/// uncertainty of the one before it, and both are rounded to what that leaves; in Markdown and HTML too. One that is
/// nowhere rounds that before it.
std::string text(const Table& exact);

/// The names, then line by line. Null is an empty field; commas in words become blanks, or semicolons before a blank.
std::string csv(const Table& table);

/// An array of objects.
Json json_of(const Table& table);

/// What is in text, under the names.
std::string markdown(const Table& exact);

/// The same as text(), as the element <table>; words are escaped.
std::string html(const Table& exact);

/// & < > " as HTML takes them.
std::string html_escaped(const std::string& words);

/// Of such an array, or of the fields of an object: names and values, in columns without a name.
Table table_of(const Json& json);

}  // namespace mmbrdf::program
