// SPDX-License-Identifier: BSD-3-Clause
#include "text/json_text.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

bool fits_in_a_line(const ordered_json& value) {
  return value.is_primitive() ||
         (value.is_array() && value.size() <= 5 &&
          std::all_of(value.begin(), value.end(), [](const auto& v) { return v.is_primitive(); }));
}

void print(std::string& out, const ordered_json& value, std::size_t indent);

/// Array elements one after the other, in lines of at most 120 characters.
void print_filled(std::string& out, const ordered_json& array, std::size_t indent) {
  constexpr std::size_t width = 120;
  std::size_t column = out.size() - (out.rfind('\n') + 1) + 1;
  out += '[';
  for (std::size_t i = 0; i < array.size(); ++i) {
    const std::string text = array[i].dump() + (i + 1 < array.size() ? "," : "]");
    if (column + 1 + text.size() > width) {
      out += '\n' + std::string(indent + 2, ' ');
      column = indent + 2;
    } else if (i > 0) {
      out += ' ';
      ++column;
    }
    out += text;
    column += text.size();
  }
  if (array.empty()) out += ']';
}

void print(std::string& out, const ordered_json& value, std::size_t indent) {
  if (value.is_primitive()) {
    out += value.dump();
  } else if (value.is_array() && std::all_of(value.begin(), value.end(), fits_in_a_line)) {
    print_filled(out, value, indent);
  } else {
    out += value.is_array() ? '[' : '{';
    const char* separator = "\n";
    for (const auto& [name, child] : value.items()) {
      out += separator + std::string(indent + 2, ' ') + (value.is_array() ? "" : ordered_json(name).dump() + ": ");
      print(out, child, indent + 2);
      separator = ",\n";
    }
    if (!value.empty()) out += '\n' + std::string(indent, ' ');
    out += value.is_array() ? ']' : '}';
  }
}

/// The line of a position, counted from 1; the end of the file belongs to its last line.
std::string line_of(std::string_view text, std::size_t position) {
  while (text.ends_with('\n') || text.ends_with('\r')) text.remove_suffix(1);
  return std::to_string(1 + std::ranges::count(text.substr(0, position), '\n'));
}

}  // namespace

json parsed_json(std::string_view text, const std::string& name) {
  std::vector<std::set<std::string>> open;  // names of the fields of each object that has begun
  const auto refuse_repetition = [&](int, json::parse_event_t event, json& value) {
    if (event == json::parse_event_t::object_start) open.emplace_back();
    if (event == json::parse_event_t::object_end) open.pop_back();
    if (event == json::parse_event_t::key && !open.back().insert(value.get<std::string>()).second)
      throw std::runtime_error(name + ": the field " + in_quotes(value.get<std::string>()) + " is there twice");
    return true;
  };
  try {
    return json::parse(text, refuse_repetition);
  } catch (const json::parse_error& e) {  // "[…] parse error at line 1, column 5: what is wrong"
    const std::string what = e.what();
    const std::size_t begin = what.find(": ");
    throw std::runtime_error(name + ":" + line_of(text, e.byte) +
                             ": not JSON: " + printable(what.substr(begin + 2), 200));
  } catch (const json::out_of_range& e) {  // "[…] number overflow parsing '1e999'"
    const std::string what = e.what();
    const std::size_t begin = what.find('\'') + 1;
    const std::string token = what.substr(begin, what.rfind('\'') - begin);
    throw std::runtime_error(name + ":" + line_of(text, text.find(token)) + ": " + in_quotes(token) +
                             " is beyond the range of double precision");
  }
}

std::string json_text(const ordered_json& value) {
  std::string text;
  print(text, value, 0);
  return text + "\n";
}

}  // namespace mmbrdf
