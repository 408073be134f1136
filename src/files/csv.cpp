// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/files/csv.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <istream>
#include <system_error>

#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using Names = std::span<const std::string_view>;

// Own names first, then those of the published data and of its README, then others in use.
constexpr std::string_view nanometre_names[] = {"wavelength_nm"};
constexpr std::string_view micrometre_names[] = {"wavelength_um", "lambda", "lambda_um"};
constexpr std::string_view theta_i_names[] = {"theta_i_deg", "thetai", "thetai_deg"};
constexpr std::string_view phi_i_names[] = {"phi_i_deg", "phi", "phii", "phii_deg"};
constexpr std::string_view theta_r_names[] = {"theta_r_deg", "thetar", "thetar_deg"};
constexpr std::string_view phi_r_names[] = {"phi_r_deg", "phir", "phir_deg"};
constexpr std::array<Names, 4> angle_names = {theta_i_names, phi_i_names, theta_r_names, phi_r_names};

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

Direction direction(const CsvReader& reader, int theta_column, int phi_column) {
  const double theta = reader.number(theta_column), phi = reader.number(phi_column);
  if (std::abs(theta) > 90)
    throw reader.error(reader.columns()[static_cast<std::size_t>(theta_column)] + ": " +
                       printable(reader.field(theta_column), 40) + " degrees; a polar angle is at most 90");
  return direction_from_degrees(theta, phi);
}

}  // namespace

std::ifstream open_input(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw std::runtime_error(path + ": is a folder, not a file");
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error(path + ": cannot be opened: " + std::generic_category().message(errno));
  return in;
}

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
  for (const std::string_view field : fields_) {
    if (!field.empty() && std::find(columns_.begin(), columns_.end(), field) != columns_.end())
      throw error("two columns have the name " + in_quotes(field));
    columns_.emplace_back(field);
  }
}

CsvReader::CsvReader(std::istream& in, std::string name, std::vector<std::string> columns)
    : in_(in), name_(std::move(name)), line_(longest_line + 1), columns_(std::move(columns)) {}

CsvReader::CsvReader(std::istream& in, const CsvReader& whole, long lines_before)
    : in_(in), name_(whole.name_), line_(longest_line + 1), line_number_(lines_before), columns_(whole.columns_) {}

std::runtime_error CsvReader::error(const std::string& text) const {
  return std::runtime_error(name_ + ":" + std::to_string(line_number_) + ": " + text);
}

int CsvReader::find(std::span<const std::string_view> names) const {
  int found = -1;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    if (std::find(names.begin(), names.end(), columns_[c]) == names.end()) continue;
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
  if (const auto control = std::find_if(text_.begin(), text_.end(), is_control); control != text_.end())
    throw error("the byte " + in_quotes(std::string_view(&*control, 1)) + ": not a text file, but a binary one");
  return true;
}

bool CsvReader::read_row() {
  while (read_line()) {
    const std::string_view content = trimmed(text_);
    if (content.empty() || content.front() == '#') continue;
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
  if (!read_row()) return false;
  if (fields_.size() != columns_.size())
    throw error(std::to_string(columns_.size()) + " fields (" + shown_name(columns_.front()) + " ... " +
                shown_name(columns_.back()) + ") are needed, there are " + std::to_string(fields_.size()) + ": " +
                in_quotes(text_));
  return true;
}

double CsvReader::number(int column) const {
  try {
    return parse_number(field(column));
  } catch (const std::invalid_argument& e) {
    throw error(columns_[static_cast<std::size_t>(column)] + ": " + e.what());
  }
}

GeometryColumns::GeometryColumns(const CsvReader& reader, double wavelength) : wavelength_(wavelength) {
  const int nanometres = reader.find(nanometre_names), micrometres = reader.find(micrometre_names);
  if (nanometres >= 0 && micrometres >= 0)
    throw reader.error("the wavelength is given twice, in nanometres and in micrometres");
  wavelength_column_ = std::max(nanometres, micrometres);
  units_per_micrometre_ = nanometres >= 0 ? 1000 : 1;
  if (wavelength_column_ < 0 && !(wavelength > 0))
    throw reader.error("no column wavelength_nm (nanometres), nor lambda or wavelength_um (micrometres)");
  for (std::size_t a = 0; a < angles_.size(); ++a) {
    angles_[a] = reader.find(angle_names[a]);
    if (angles_[a] < 0)
      throw reader.error("no column " + std::string(angle_names[a][0]) + " (nor " + std::string(angle_names[a][1]) +
                         ")");
  }
}

Geometry GeometryColumns::geometry(const CsvReader& reader) const {
  return {direction(reader, angles_[0], angles_[1]), direction(reader, angles_[2], angles_[3])};
}

double GeometryColumns::wavelength(const CsvReader& reader) const {
  if (wavelength_column_ < 0) return wavelength_;
  const double value = reader.number(wavelength_column_) / units_per_micrometre_;
  if (!(value > 0))
    throw reader.error(reader.columns()[static_cast<std::size_t>(wavelength_column_)] + ": " +
                       printable(reader.field(wavelength_column_), 40) + ": a wavelength must be positive");
  return value;
}

}  // namespace mmbrdf
