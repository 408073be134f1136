// SPDX-License-Identifier: BSD-3-Clause
// Part of report.hpp.
#include "quantities/report_blocks.hpp"

#include <algorithm>
#include <cctype>

#include "mmbrdf/text/rounding.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr const char* unknown_cell = "not known";

std::string with_minus(std::string number) { return number.starts_with('-') ? "\u2212" + number.substr(1) : number; }

bool is_of_numbers(Cell cell) {
  return cell != Cell::words && cell != Cell::prose && cell != Cell::yes_no && cell != Cell::place;
}

/// The numbers of place_line().
std::string angles_alone(const std::string& place) {
  std::string text = symbols_in_print(place);
  for (const std::string name : {"θᵢ = ", "θᵣ = ", "φᵣ − φᵢ = "})
    if (const std::size_t at = text.find(name); at != std::string::npos) text.erase(at, name.size());
  return text;
}

std::optional<double> number_in(const Json& row, const std::string& key) {
  const auto found = row.find(key);
  return found != row.end() && found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
}

/// "Dependence on φᵢ" is linked as "dependence-on-φᵢ".
std::string anchor(const std::string& heading) {
  std::string text;
  for (const char c : heading)
    if (static_cast<unsigned char>(c) >= 0x80 || std::isalnum(static_cast<unsigned char>(c)))
      text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (c == ' ' || c == '-')
      text += '-';
  return text;
}

}  // namespace

void Document::heading(const std::string& text) {
  add({{"kind", "heading"}, {"text", text}, {"anchor", anchor(text)}});
}

void Document::lines(const std::string& kind, const Json& sentences) {
  Json all = Json::array();
  for (const Json& one : sentences) all.push_back(in_symbols(one.get<std::string>()));
  add({{"kind", kind}, {"lines", all}});
}

std::string Document::in_symbols(const std::string& sentence) const {
  std::size_t first = std::string::npos, size = 0;
  for (const std::string& name : names_) {
    const std::size_t at = name.empty() ? std::string::npos : sentence.find(name);
    if (at < first) first = at, size = name.size();
  }
  if (first == std::string::npos) return symbols_in_print(sentence);
  return symbols_in_print(sentence.substr(0, first)) + sentence.substr(first, size) +
         in_symbols(sentence.substr(first + size));
}

void Document::table(const std::string& caption, const std::vector<std::string>& headings,
                     const std::vector<bool>& numbers, const Json& rows, const std::string& remark) {
  Json columns = Json::array();
  for (std::size_t c = 0; c < headings.size(); ++c)
    columns.push_back({{"heading", headings[c]}, {"align", numbers[c] ? "right" : "left"}});
  Json block{{"kind", "table"}, {"number", ++tables_}, {"caption", in_symbols(caption)}, {"columns", columns}};
  block["rows"] = rows;
  if (!remark.empty()) block["remark"] = in_symbols(remark);
  add(block);
}

void Document::table(const std::string& caption, const std::vector<DocumentColumn>& columns, const Json& rows) {
  std::vector<std::string> headings;
  std::vector<bool> numbers;
  for (const DocumentColumn& column : columns) {
    headings.push_back(column.heading);
    numbers.push_back(is_of_numbers(column.cell));
  }
  Json cells = Json::array();
  for (const Json& row : rows) {
    Json line = Json::array();
    for (const DocumentColumn& column : columns) line.push_back(cell(column, row));
    cells.push_back(line);
  }
  table(caption, headings, numbers, cells);
}

std::string Document::cell(const DocumentColumn& column, const Json& row) const {
  const Json& value = row.at(column.key);
  if (value.is_null()) return unknown_cell;
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (column.cell == Cell::words || column.cell == Cell::element) return value.get<std::string>();
  if (column.cell == Cell::place) return angles_alone(value.get<std::string>());
  if (column.cell == Cell::prose) return in_symbols(value.get<std::string>());
  if (value.is_number_integer()) return value.dump();
  const double number = value.get<double>();
  switch (column.cell) {
    case Cell::two:
      return significant(number, 2);
    case Cell::three:
      return significant(number, 3);
    case Cell::angle:
      return rounded(number, number < 10 ? 3 : 4);
    case Cell::with_u:
      return in_print(number, number_in(row, column.other), notation_);
    case Cell::like:
      return with_minus(to_place_of(number, number_in(row, column.other)));
    default:
      return shortest(number);
  }
}

void Document::figure(const std::string& caption, const std::string& kind, const Json& arguments,
                      const std::string& command, bool of_data, double width_cm) {
  const std::string number = std::to_string(++figures_);
  Json block{{"kind", "figure"}, {"number", figures_}, {"caption", in_symbols(caption)}, {"plot", kind}};
  block["of_data"] = of_data;
  block["arguments"] = arguments;
  block["width_cm"] = width_cm;
  block["command"] = command + " --width " + shortest(width_cm) + " -o figure" + number + ".pdf";
  add(block);
}

}  // namespace mmbrdf
