// SPDX-License-Identifier: BSD-3-Clause
// The document of a report as Markdown. Part of report.hpp.

#include <nlohmann/json.hpp>
#include <string>

#include "mmbrdf/quantities/report.hpp"

namespace mmbrdf {
namespace {

using Piece = nlohmann::ordered_json;

/// In one line, and no markup: what others wrote may hold any of it.
std::string in_line(const std::string& words, bool in_table = false) {
  std::string text;
  for (const char c : words) {
    if (c == '\n' || c == '\r') {
      text += ' ';
      continue;
    }
    if (c == '*' || c == '_' || c == '`' || c == '<' || c == '[' || c == '\\' || (in_table && c == '|')) text += '\\';
    text += c;
  }
  return text;
}

/// Fences of a command that may hold some itself.
std::string as_code(const std::string& words) { return "    " + words + "\n"; }

std::string cells_in_line(const Piece& cells) {
  std::string text = "|";
  for (const Piece& cell : cells) text += " " + in_line(cell.get<std::string>(), true) + " |";
  return text + "\n";
}

std::string markdown_table(const Piece& block) {
  std::string text =
      "**Table " + block["number"].dump() + ".** " + in_line(block["caption"].get<std::string>()) + "\n\n";
  Piece headings = Piece::array();
  std::string rule = "|";
  for (const Piece& column : block["columns"]) {
    headings.push_back(column["heading"]);
    rule += column["align"] == "right" ? " ---: |" : " --- |";
  }
  text += cells_in_line(headings) + rule + "\n";
  for (const Piece& row : block["rows"]) text += cells_in_line(row);
  if (block.contains("remark")) text += "\n" + in_line(block["remark"].get<std::string>()) + "\n";
  return text;
}

std::string bullets(const Piece& lines) {
  std::string text;
  for (const Piece& line : lines) text += "- " + in_line(line.get<std::string>()) + "\n";
  return text.empty() ? "none\n" : text;
}

std::string contents_of(const Piece& blocks) {
  std::string text;
  for (const Piece& block : blocks)
    if (block["kind"] == "heading")
      text += "- [" + in_line(block["text"].get<std::string>()) + "](#" + block["anchor"].get<std::string>() + ")\n";
  return text;
}

std::string markdown_of(const Piece& block, const Piece& blocks) {
  const std::string kind = block["kind"];
  if (kind == "heading") return "## " + in_line(block["text"].get<std::string>()) + "\n";
  if (kind == "summary")
    return "**" + in_line(block["subject"].get<std::string>()) + "**" + in_line(block["text"].get<std::string>()) +
           "\n";
  if (kind == "paragraph") return in_line(block["text"].get<std::string>()) + "\n";
  if (kind == "warnings") return "## Warnings\n\n" + bullets(block["lines"]);
  if (kind == "notes") return block["lines"].empty() ? "" : "## Notes\n\n" + bullets(block["lines"]);
  if (kind == "contents") return "## Contents\n\n" + contents_of(blocks);
  if (kind == "table") return markdown_table(block);
  return "**Figure " + block["number"].dump() + ".** " + in_line(block["caption"].get<std::string>()) + "\n\n" +
         as_code(block["command"].get<std::string>());
}

}  // namespace

std::string report_markdown(const std::string& document) {
  const Piece whole = Piece::parse(document);
  std::string text = "# " + in_line(whole["title"].get<std::string>()) + "\n";
  for (const Piece& block : whole["blocks"])
    if (const std::string part = markdown_of(block, whole["blocks"]); !part.empty()) text += "\n" + part;
  return text;
}

}  // namespace mmbrdf
