// SPDX-License-Identifier: BSD-3-Clause
#include "pages/page.hpp"

#include <stdexcept>

namespace mmbrdf::program {

namespace {

// A budget of a dozen causes fits A4.
constexpr const char* style =
    "body{font-family:sans-serif;margin:2em}"
    "pre{white-space:pre-wrap}"
    "table{border-collapse:collapse;margin:1em 0;font-size:.85em;font-variant-numeric:tabular-nums}"
    "th,td{padding:.15em .4em;text-align:right;border-bottom:1px solid #ddd}"
    "th{border-bottom:1px solid #000;vertical-align:bottom}"
    "th:first-child,td:first-child{text-align:left}"
    "td:first-child{white-space:nowrap}"
    "tr{break-inside:avoid}"
    "@media print{@page{margin:12mm}body{margin:0;font-size:8pt}pre{font-size:7pt}}";

/// Without empty lines around it.
std::string trimmed(const std::string& lines) {
  const std::size_t begin = lines.find_first_not_of('\n'), end = lines.find_last_not_of('\n');
  return begin == std::string::npos ? "" : lines.substr(begin, end + 1 - begin);
}

}  // namespace

void Page::add(const std::string& lines) {
  if (parts_.empty() || !std::holds_alternative<std::string>(parts_.back())) parts_.emplace_back(std::string());
  std::get<std::string>(parts_.back()) += lines;
}

void Page::add(const Page& other) {
  for (const auto& part : other.parts_) std::visit([this](const auto& one) { add(one); }, part);
}

std::string Page::text() const {
  std::string result;
  for (const auto& part : parts_) {
    const auto* const table = std::get_if<Table>(&part);
    result += table ? program::text(*table) : std::get<std::string>(part);
  }
  return result;
}

std::string Page::html() const {
  std::string body, title;
  for (const auto& part : parts_) {
    if (const auto* const table = std::get_if<Table>(&part)) {
      body += program::html(*table);
      continue;
    }
    const std::string lines = trimmed(std::get<std::string>(part));
    if (lines.empty()) continue;
    if (title.empty()) title = html_escaped(lines.substr(0, lines.find('\n')));
    body += "<pre>" + html_escaped(lines) + "</pre>\n";
  }
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" + title +
         "</title>\n<style>" + style + "</style>\n</head>\n<body>\n" + body + "</body>\n</html>\n";
}

std::string Page::written(Format format) const {
  if (format == Format::csv || format == Format::json) throw std::logic_error("Page: a format of programs");
  return format == Format::html ? html() : text();
}

}  // namespace mmbrdf::program
