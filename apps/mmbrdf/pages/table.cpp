// SPDX-License-Identifier: BSD-3-Clause
#include "pages/table.hpp"

#include <cmath>

namespace mmbrdf::program {

namespace {

/// Null for what is unknown, too.
Json cell(const Table::Row& row, std::size_t column) {
  if (column >= row.size() || (row[column].is_number_float() && std::isnan(row[column].get<double>()))) return {};
  return row[column];
}

/// Words where the column has numbers.
std::string padded(const Column& column, const std::string& words) {
  const std::size_t conversion = column.format.find_first_of(".gfs", column.format.find('%'));
  return format((column.format.substr(0, conversion) + "s").c_str(), words.c_str());
}

std::string text_of(const Column& column, const Json& value) {
  if (value.is_number_float()) return format(column.format.c_str(), value.get<double>());
  return padded(column, value.is_null()      ? column.missing
                        : value.is_string()  ? printable(value.get_ref<const std::string&>(), longest_text)
                        : value.is_boolean() ? (value.get<bool>() ? "yes" : "no")
                                             : value.dump());
}

std::string csv_of(const Column& column, const Json& value) {
  if (value.is_number_float()) return column.digits(value.get<double>());
  if (!value.is_string()) return value.is_null() ? "" : value.dump();
  auto words = value.get<std::string>();
  for (std::size_t i = 0; i < words.size(); ++i)
    if (words[i] == ',') words[i] = i + 1 < words.size() && words[i + 1] == ' ' ? ';' : ' ';
  return words;
}

/// What `shown` gives for each column that is there, of the row if there is one.
template <class... Row>
std::string line(const Table& table, Where where, const char* between, auto shown, const Row&... row) {
  std::vector<std::string> words;
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (table.columns[c].where & where) words.push_back(shown(table.columns[c], cell(row, c)...));
  return joined(words, between);
}

/// In Markdown | would end a cell, and a line end would end the row.
std::string markdown_of(const Column& column, const Json& value) {
  std::string words = text_of(column, value);
  for (std::size_t at = 0; (at = words.find_first_of("|\n", at)) != std::string::npos; at += 2)
    words.replace(at, 1, words[at] == '|' ? "\\|" : "  ");
  return words;
}

std::string name_of(const Column& column) { return column.name; }

/// Without the blanks that align it in text.
std::string html_cell(const char* tag, const std::string& words) {
  const std::size_t begin = words.find_first_not_of(' '), end = words.find_last_not_of(' ');
  const std::string bare = begin == std::string::npos ? "" : words.substr(begin, end + 1 - begin);
  return std::string("<") + tag + ">" + html_escaped(bare) + "</" + tag + ">";
}

/// With two digits of each uncertainty, and the value before it to the same place.
Table rounded(Table table) {
  for (std::size_t c = 1; c < table.columns.size(); ++c) {
    if (table.columns[c].name != "u" && !table.columns[c].name.starts_with("u_")) continue;
    for (Table::Row& row : table.rows) {
      if (!cell(row, c).is_number()) continue;
      const double u = row[c];
      row[c - 1] = to_place_of(row[c - 1], u);
      row[c] = to_place_of(u, u);
    }
  }
  return table;
}

}  // namespace

std::string text(const Table& exact) {
  const Table table = rounded(exact);
  std::string text;
  const auto add = [&](const std::string& line) { text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n"; };
  add(line(table, in_text, " ", [](const Column& column) { return padded(column, column.heading); }));
  for (const Table::Row& row : table.rows) add(line(table, in_text, " ", text_of, row));
  return text;
}

std::string csv(const Table& table) {
  std::string text = line(table, in_csv, ",", name_of) + "\n";
  for (const Table::Row& row : table.rows) text += line(table, in_csv, ",", csv_of, row) + "\n";
  return text;
}

std::string markdown(const Table& exact) {
  const Table table = rounded(exact);
  std::string text;
  const auto add = [&](const std::string& line) { text += "| " + line + " |\n"; };
  add(line(table, in_text, " | ", name_of));
  add(line(table, in_text, " | ", [](const Column&) { return std::string("---"); }));
  for (const Table::Row& row : table.rows) add(line(table, in_text, " | ", markdown_of, row));
  return text;
}

std::string html(const Table& exact) {
  const Table table = rounded(exact);
  std::string text = "<table>\n";
  const auto add = [&](const std::string& line) { text += "<tr>" + line + "</tr>\n"; };
  add(line(table, in_text, "", [](const Column& column) { return html_cell("th", column.heading); }));
  for (const Table::Row& row : table.rows)
    add(line(
        table, in_text, "",
        [](const Column& column, const Json& value) { return html_cell("td", text_of(column, value)); }, row));
  return text + "</table>\n";
}

std::string html_escaped(const std::string& words) {
  std::string result;
  for (const char c : words)
    result += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
  return result;
}

Table table_of(const Json& json) {
  const auto column = [](const std::string& name) {
    return Column{.name = name, .format = "%.6g", .missing = "not known"};
  };
  Table table;
  if (json.is_object())
    table.columns = {column(""), column("")};
  else
    for (const auto& [name, value] : json.front().items()) table.columns.push_back(column(name));
  for (const auto& [name, value] : json.items()) {
    Table::Row& row = table.rows.emplace_back();
    if (json.is_object())
      row = {name, value};
    else
      for (const Json& cell : value) row.push_back(cell);
  }
  return table;
}

Json json_of(const Table& table) {
  Json objects = Json::array();
  for (const Table::Row& row : table.rows) {
    Json& object = objects.emplace_back();
    for (std::size_t c = 0; c < table.columns.size(); ++c)
      if (table.columns[c].where & in_json) object[table.columns[c].name] = cell(row, c);
  }
  return objects;
}

}  // namespace mmbrdf::program
