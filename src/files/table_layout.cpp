// SPDX-License-Identifier: BSD-3-Clause
#include "files/table_layout.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using Pair = std::pair<std::string_view, std::string_view>;

constexpr Pair spelt_out[] = {Pair{"°", " deg"}, {"\xb0", " deg"}, {"µ", "u"},      {"μ", "u"},        {"θ", "theta"},
                              {"φ", "phi"},      {"ϕ", "phi"},     {"λ", "lambda"}, {"%", " percent"}, {"⁻¹", "-1"}};

constexpr Pair unit_endings[] = {Pair{"_degrees", "_deg"}, {"_degree", "_deg"},     {"_radians", "_rad"},
                                 {"_radian", "_rad"},      {"_nanometres", "_nm"},  {"_nanometers", "_nm"},
                                 {"_micrometres", "_um"},  {"_micrometers", "_um"}, {"_microns", "_um"},
                                 {"_micron", "_um"},       {"_1_sr", ""},           {"_sr_1", ""}};

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// A capital and two digits, whatever is behind: M12, F12/F11.
bool is_capital_element(std::string_view name) {
  return name.size() >= 3 && (name[0] == 'M' || name[0] == 'F' || name[0] == 'S') && is_digit(name[1]) &&
         is_digit(name[2]);
}

}  // namespace

char separator_of(std::string_view line) {
  bool comma = false, tab = false, quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (c == ';') return c;
    tab = tab || c == '\t';
    comma = comma || c == ',';
  }
  return tab ? '\t' : comma ? ',' : ' ';
}

bool split(std::string_view line, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  bool well_formed = true;
  const auto is_blank = [&](char c) { return c == ' ' || (c == '\t' && separator != '\t'); };
  std::size_t at = 0;
  for (;;) {
    while (at < line.size() && is_blank(line[at])) ++at;
    std::size_t begin = at, end;
    if (at < line.size() && line[at] == '"') {
      begin = at + 1;
      end = line.find('"', begin);
      well_formed = well_formed && end != std::string_view::npos;
      if (end == std::string_view::npos) end = line.size();
      at = end < line.size() ? end + 1 : end;
      for (; at < line.size() && line[at] != separator && !(separator == ' ' && is_blank(line[at])); ++at)
        well_formed = well_formed && is_blank(line[at]);
    } else {
      while (at < line.size() && line[at] != separator && !(separator == ' ' && is_blank(line[at]))) ++at;
      end = at;
    }
    fields.push_back(trimmed(line.substr(begin, end - begin)));
    if (separator == ' ')
      while (at < line.size() && is_blank(line[at])) ++at;
    if (at == line.size()) return well_formed;
    if (separator != ' ') ++at;
  }
}

std::string column_key(std::string_view name, bool upper_case) {
  if ((!upper_case && is_capital_element(name)) || name.ends_with("/f_r11")) return std::string(name);
  std::string spelt(name);
  for (const auto& [mark, word] : spelt_out)
    for (std::size_t at = spelt.find(mark); at != std::string::npos; at = spelt.find(mark, at + word.size()))
      spelt.replace(at, mark.size(), word);
  std::string key;
  for (const char c : spelt)
    if (is_letter(c) || is_digit(c))
      key += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (!key.empty() && key.back() != '_')
      key += '_';
  while (key.ends_with('_')) key.pop_back();
  for (const auto& [unit, own] : unit_endings)
    if (key.ends_with(unit)) return key.replace(key.size() - unit.size(), unit.size(), own);
  return key;
}

std::string other_name_hint(const std::string& own, const std::vector<std::string>& columns) {
  constexpr std::size_t most = 12;
  std::string text = "; if it has another name, give that: columns " + own + "=NAME";
  for (std::size_t c = 0; c < std::min(columns.size(), most); ++c)
    text += (c == 0 ? ", of " : ", ") + shown_name(columns[c]);
  return text + (columns.size() > most ? ", ..." : "");
}

std::optional<std::string> plain_number(std::string_view field) {
  constexpr std::string_view minus = "\u2212";  // as text processors write it
  if (field.starts_with(minus)) {
    const std::string positive(field.substr(minus.size()));
    return "-" + plain_number(positive).value_or(positive);
  }
  const std::size_t first = field.find_first_of(",dD");
  if (first == std::string_view::npos) return std::nullopt;
  std::string plain(field);
  for (char& c : plain) {
    if (c == ',') c = '.';
    if (c == 'd' || c == 'D') c = 'e';
  }
  return plain;
}

}  // namespace mmbrdf
