// SPDX-License-Identifier: BSD-3-Clause
#include "formats/text_file.hpp"

#include <algorithm>
#include <cctype>

#include "mmbrdf/text/input.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr std::string_view blanks = " \t\r\f\v";

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

}  // namespace

TextFile::TextFile(const std::string& path) : path_(path), in_(open_input(path)) {}

bool TextFile::next() {
  while (std::getline(in_, text_)) {
    ++number_;
    line_ = without_blanks(text_);
    if (number_ == 1 && line_.starts_with(byte_order_mark)) line_.remove_prefix(byte_order_mark.size());
    if (line_.empty()) continue;
    ended_ = !in_.eof();
    return true;
  }
  line_ = {};
  return false;
}

std::string_view TextFile::word(char comment) {
  rest_ = without_blanks(rest_);
  while (rest_.empty() || rest_[0] == comment) {
    if (!next()) return {};
    rest_ = line_;
  }
  const std::string_view found = rest_.substr(0, rest_.find_first_of(blanks));
  rest_.remove_prefix(found.size());
  return found;
}

std::runtime_error TextFile::error(const std::string& what) const {
  return std::runtime_error(path_ + ":" + std::to_string(number_) + ": " + what);
}

double TextFile::number(std::string_view text, const std::string& what) const {
  try {
    return parse_number(text);
  } catch (const std::invalid_argument& refusal) {
    throw error(what + ": " + refusal.what());
  }
}

std::vector<std::string_view> fields(std::string_view line) {
  std::vector<std::string_view> found;
  const bool commas = line.find(',') != std::string_view::npos;
  while (!(line = without_blanks(line)).empty()) {
    const std::size_t end = commas ? line.find(',') : line.find_first_of(blanks);
    found.push_back(without_blanks(line.substr(0, end)));
    line.remove_prefix(end == std::string_view::npos ? line.size() : end + 1);
  }
  return found;
}

bool has_keyword(std::string_view head, std::string_view keyword) {
  if (head.find('\0') != std::string_view::npos) return false;
  while (!head.empty()) {
    const std::size_t end = std::min(head.find('\n'), head.size());
    const std::string_view line = without_blanks(head.substr(0, end));
    if (line.size() >= keyword.size() && same_word(line.substr(0, keyword.size()), keyword) &&
        (line.size() == keyword.size() || line[keyword.size()] == ' ' || line[keyword.size()] == '\t'))
      return true;
    head.remove_prefix(std::min(end + 1, head.size()));
  }
  return false;
}

bool same_word(std::string_view a, std::string_view b) {
  const auto same = [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); };
  return std::ranges::equal(a, b, same);
}

}  // namespace mmbrdf
