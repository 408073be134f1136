// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/files/csv.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <istream>
#include <optional>
#include <utility>

#include "files/table_layout.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

bool is_number(std::string_view text) {
  try {
    parse_number(text);
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && c != '\t') || byte == 0x7f;
}

/// What spreadsheets write for a value that there is not.
bool is_spreadsheet_error(std::string_view text) {
  constexpr std::array<std::string_view, 7> words = {"#N/A",   "#DIV/0!", "#VALUE!", "#REF!",
                                                     "#NAME?", "#NUM!",   "#NULL!"};
  return std::ranges::any_of(words, [&](std::string_view word) { return text.starts_with(word); });
}

/// What a file that is no text is, by its first bytes, and what to do; or empty.
std::string_view known_binary(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kinds = {
      {{"PK\x03\x04", "a workbook of a spreadsheet, or another archive; save the table as CSV"},
       {"\xd0\xcf\x11\xe0", "a workbook of a spreadsheet; save the table as CSV"},
       {"\x1f\x8b", "a file compressed by gzip; decompress it"},
       {"\x93NUMPY", "an array of numpy; write it as text, with the names of its columns (numpy.savetxt)"}}};
  for (const auto& [bytes, what] : kinds)
    if (text.starts_with(bytes)) return what;
  return "";
}

/// Whether a column whose name has a unit is to be one that has another, or none.
bool contradicts(const std::string& key, const std::string& own) {
  constexpr std::array<std::string_view, 5> units = {"_percent", "_rad", "_deg", "_um", "_nm"};
  return std::ranges::any_of(units, [&](std::string_view unit) { return key.ends_with(unit) && !own.ends_with(unit); });
}

bool is_positive_integer(const std::string& text) {
  return !text.empty() && text.size() < 6 && text.find_first_not_of("0123456789") == std::string::npos && text != "0";
}

std::string without_comment_marks(std::string_view line) {
  line = trimmed(line);
  while (!line.empty() && (line.front() == '#' || line.front() == '%')) line = trimmed(line.substr(1));
  return std::string(line);
}

}  // namespace

bool has_ending(std::string_view path, std::string_view ending) {
  const auto same = [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); };
  return path.size() >= ending.size() && std::ranges::equal(path.substr(path.size() - ending.size()), ending, same);
}

CsvReader::CsvReader(std::istream& in, std::string name) : in_(in), name_(std::move(name)), line_(longest_line + 1) {
  if (!read_row()) throw std::runtime_error(name_ + ": empty file, without a header line");
  if (fields_.size() == 1 && fields_[0].find_first_of(";\t") != std::string_view::npos)
    throw error("no commas in the header line " + in_quotes(fields_[0]) + ": values must be separated by commas");
  if (is_number(fields_[0]))
    throw error("no header line: instead of a column's name there is the number " + printable(fields_[0], 40));
  columns_.assign(fields_.begin(), fields_.end());
  keys_ = columns_;
  require_distinct_columns();
}

CsvReader::CsvReader(std::istream& in, std::string name, const ColumnNames& columns,
                     const std::vector<std::string>& unnamed)
    : in_(in), name_(std::move(name)), line_(longest_line + 1) {
  layout_.foreign = true;
  std::string header, comment;
  while (header.empty() && read_line()) {
    const std::string_view content = trimmed(text_);
    if (content.empty()) continue;
    if (line_number_ == 1 && content.size() == 5 && (content.starts_with("sep=") || content.starts_with("SEP=")))
      continue;  // for a spreadsheet
    const bool is_comment = content.front() == '#' || content.front() == '%';
    (is_comment ? comment : header) = content;
    constexpr std::size_t most_remarks = 100;
    if (is_comment && remarks_.size() < most_remarks) remarks_.push_back(without_comment_marks(comment));
  }
  if (header.empty()) throw std::runtime_error(name_ + ": empty file, without a header line");
  const long header_line = line_number_;
  layout_.separator = separator_of(header);
  if (!split(header, layout_.separator, fields_))
    throw error("a quote that does not end with its field: " + in_quotes(header));
  if (is_number(plain_number(fields_[0]).value_or(std::string(fields_[0])))) {
    const std::size_t count = fields_.size();
    comment = without_comment_marks(comment);
    split(comment, separator_of(comment), fields_);
    layout_.header_comment = fields_.size() == count && !fields_[0].empty();
    if (layout_.header_comment) {
      columns_.assign(fields_.begin(), fields_.end());
    } else {
      split(header, layout_.separator, fields_);
      if (columns.empty() && !unnamed.empty() && count > unnamed.size())
        throw error("no header line, and " + std::to_string(count) + " columns; without one they are at most " +
                    std::to_string(unnamed.size()) + ": " + unnamed.front() + " ... " + unnamed.back());
      if (unnamed.empty() && (columns.empty() || !std::ranges::all_of(columns, [](const auto& c) {
                                return is_positive_integer(c.second);
                              })))
        throw error("no header line: instead of a column's name there is the number " + printable(fields_[0], 40) +
                    "; without one, columns need their numbers: wavelength_nm=1,theta_i_deg=2,...");
      columns_.assign(unnamed.begin(), unnamed.begin() + static_cast<std::ptrdiff_t>(std::min(count, unnamed.size())));
      for (std::size_t c = columns_.size() + 1; c <= count; ++c) columns_.push_back(std::to_string(c));
    }
    split(text_, layout_.separator, fields_);
    pending_ = line_number_;
  } else {
    columns_.assign(fields_.begin(), fields_.end());
    if (read_row()) {
      first_row_ = pending_ = line_number_;
      std::vector<std::string_view> below;  // a title may have no separator
      split(text_, separator_of(text_), below);
      // What writes row names gives them no name in the header, and quotes or counts them. A field too many that is
      // empty is a separator at the end.
      layout_.row_names = fields_.size() == columns_.size() + 1 && !fields_[0].empty() && !fields_.back().empty() &&
                          (trimmed(text_).front() == '"' || fields_[0] == "1" || !is_number(fields_[0]));
      may_be_title_ = below.size() != columns_.size() && !(layout_.row_names && is_number(fields_.back()));
      if (layout_.row_names) columns_.insert(columns_.begin(), "");
    }
    line_number_ = header_line;
  }
  name_columns(columns);
}

void CsvReader::require_distinct_columns() const {
  for (std::size_t c = 0; c < columns_.size(); ++c)
    if (!columns_[c].empty() && std::find(columns_.begin(), columns_.begin() + static_cast<std::ptrdiff_t>(c),
                                          columns_[c]) != columns_.begin() + static_cast<std::ptrdiff_t>(c))
      throw error("two columns have the name " + in_quotes(columns_[c]));
}

void CsvReader::name_columns(const ColumnNames& columns) {
  require_distinct_columns();
  const auto has_lower_case = [](const std::string& name) {
    return std::ranges::any_of(name, [](unsigned char c) { return std::islower(c) != 0; });
  };
  const bool upper_case = std::ranges::none_of(columns_, has_lower_case);
  for (const std::string& column : columns_) keys_.push_back(column_key(column, upper_case));
  std::vector<std::string> given = keys_;
  for (const auto& [own, theirs] : columns) {
    auto at = static_cast<std::size_t>(std::ranges::find(columns_, theirs) - columns_.begin());
    if (at == columns_.size() && is_positive_integer(theirs)) at = std::stoul(theirs) - 1;
    if (at >= columns_.size())
      throw error("no column " + shown_name(theirs) + ", which is to be " + own + "; there are " +
                  shown_name(columns_.front()) + " ... " + shown_name(columns_.back()));
    if (contradicts(keys_[at], own))
      throw error("column " + shown_name(theirs) + ", which is to be " + own + ": its name has another unit, " +
                  keys_[at].substr(keys_[at].rfind('_') + 1));
    if (given[at] != keys_[at] && columns.contains(given[at]))
      throw error("column " + shown_name(theirs) + " is to be both " + given[at] + " and " + own);
    std::ranges::replace(given, own, "");
    given[at] = own;
  }
  keys_ = std::move(given);
}

CsvReader::CsvReader(std::istream& in, std::string name, std::vector<std::string> columns, char remark)
    : in_(in),
      name_(std::move(name)),
      line_(longest_line + 1),
      remark_(remark),
      columns_(std::move(columns)),
      keys_(columns_) {}

CsvReader::CsvReader(std::istream& in, const CsvReader& whole, long lines_before)
    : in_(in),
      name_(whole.name_),
      line_(longest_line + 1),
      line_number_(lines_before),
      columns_(whole.columns_),
      keys_(whole.keys_) {}

std::string CsvReader::remark(std::string_view name) const {
  for (const std::string& remark : remarks_)
    if (remark.size() > name.size() && remark.starts_with(name) && remark[name.size()] == ':')
      return std::string(trimmed(std::string_view(remark).substr(name.size() + 1)));
  return "";
}

std::runtime_error CsvReader::error(const std::string& text) const {
  return std::runtime_error(name_ + ":" + std::to_string(line_number_) + ": " + text);
}

int CsvReader::find(std::span<const std::string_view> names) const {
  int found = -1;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    if (std::find(names.begin(), names.end(), keys_[c]) == names.end()) continue;
    if (found >= 0)
      throw error("columns " + columns_[static_cast<std::size_t>(found)] + " and " + columns_[c] + " mean the same");
    found = static_cast<int>(c);
  }
  return found;
}

bool CsvReader::read_line() {
  in_.getline(line_.data(), static_cast<std::streamsize>(line_.size()));
  auto length = static_cast<std::size_t>(in_.gcount());
  if (in_.bad()) throw std::runtime_error(name_ + ": read error after line " + std::to_string(line_number_));
  if (length == 0) return false;
  ++line_number_;
  if (in_.fail() && !in_.eof())
    throw error("more than " + std::to_string(longest_line) + " characters: not a text file of comma-separated values");
  if (!in_.eof()) --length;  // the line end, which is counted but not stored
  text_ = {line_.data(), length};
  if (line_number_ == 1 && text_.starts_with(byte_order_mark)) text_.remove_prefix(byte_order_mark.size());
  if (text_.ends_with('\r')) text_.remove_suffix(1);
  if (line_number_ == 1 && (text_.starts_with("\xff\xfe") || text_.starts_with("\xfe\xff")))
    throw error("text in UTF-16; save it as UTF-8");
  if (const std::string_view kind = known_binary(text_); line_number_ == 1 && !kind.empty())
    throw error(std::string(kind));
  if (const auto control = std::find_if(text_.begin(), text_.end(), is_control); control != text_.end())
    throw error(*control == '\r'
                    ? std::string("lines that end in CR alone; save it with LF or CR LF")
                    : "the byte " + in_quotes(std::string_view(&*control, 1)) + ": not a text file, but a binary one");
  return true;
}

bool CsvReader::read_row() {
  while (read_line()) {
    if (remark_ != 0) text_ = text_.substr(0, text_.find(remark_));
    const std::string_view content = trimmed(text_);
    if (content.empty() || (content.front() == '#' && !(layout_.foreign && is_spreadsheet_error(content)))) continue;
    if (layout_.foreign) {
      if (content.front() == '%') continue;
      if (!split(text_, layout_.separator, fields_))
        throw error("a quote that does not end with its field: " + in_quotes(text_));
      return true;
    }
    fields_.clear();  // and filled again, in the same memory
    for (std::size_t begin = 0, end = 0; end != std::string_view::npos; begin = end + 1) {
      end = text_.find(',', begin);
      fields_.push_back(trimmed(text_.substr(begin, end - begin)));
    }
    return true;
  }
  return false;
}

bool CsvReader::next() {
  if (pending_ > 0)
    line_number_ = std::exchange(pending_, 0);
  else if (!read_row())
    return false;
  if (fields_.size() != columns_.size())
    throw error((layout_.foreign && layout_.separator == ',' && fields_.size() == 2 * columns_.size()
                     ? "decimal commas, and commas between the numbers? Separate them by semicolons; "
                     : "") +
                std::to_string(columns_.size()) + " fields (" + shown_name(columns_.front()) + " ... " +
                shown_name(columns_.back()) + ") are needed, there are " + std::to_string(fields_.size()) + ": " +
                in_quotes(text_));
  return true;
}

bool CsvReader::is_missing(int column) const {
  constexpr std::array<std::string_view, 15> words = {"",     "NA",       "N/A",     "<NA>",    "NAN",
                                                      "-NAN", "NAN(IND)", "-",       "--",      "NULL",
                                                      "NONE", "1.#IND",   "-1.#IND", "1.#QNAN", "-NAN(IND)"};
  const std::string_view text = field(column);
  const auto same = [](unsigned char a, unsigned char b) { return std::toupper(a) == b; };
  return is_spreadsheet_error(text) ||
         std::ranges::any_of(words, [&](std::string_view word) { return std::ranges::equal(text, word, same); });
}

double CsvReader::foreign_number(std::string_view field) const {
  const char decimal = field.find('.') != std::string_view::npos   ? '.'
                       : field.find(',') != std::string_view::npos ? ','
                                                                   : '\0';
  if (decimal != '\0') {
    if (layout_.decimal == '\0') layout_.decimal = decimal;
    if (decimal != layout_.decimal || (decimal == '.' && field.find(',') != std::string_view::npos))
      throw std::invalid_argument(in_quotes(field) + ": a decimal " + (layout_.decimal == '.' ? "point" : "comma") +
                                  " in one number, and another mark in this one");
  }
  const std::optional<std::string> plain = plain_number(field);
  try {
    return parse_number(plain ? *plain : field);
  } catch (const std::invalid_argument&) {
    return parse_number(field);  // says what stands in the file
  }
}

/// What a row may be whose field is no number.
std::string CsvReader::row_hint(int column) const {
  if (!layout_.foreign) return "";
  if (field(column) == columns_[static_cast<std::size_t>(column)]) return "; is this line a header again? Leave it out";
  const bool digits = field(column).find_first_of("0123456789") != std::string_view::npos;
  return line_number_ == first_row_ && !digits ? "; is this a line of units? Leave it out" : "";
}

double CsvReader::number(int column) const {
  try {
    return layout_.foreign ? foreign_number(field(column)) : parse_number(field(column));
  } catch (const std::invalid_argument& e) {
    const std::string& name = columns_[static_cast<std::size_t>(column)];
    if (layout_.foreign && is_missing(column))
      throw error(name + ": " + in_quotes(field(column)) +
                  ": no value; complete it, or skip incomplete rows; of an element that was not measured the field "
                  "is empty");
    throw error(name + ": " + e.what() + row_hint(column));
  }
}

}  // namespace mmbrdf
