// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/files/samples_file.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <limits>
#include <stdexcept>

#include "mmbrdf/files/write_file.hpp"
#include "mmbrdf/text/units.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

/// A value whose square and sums of squares are finite, as any measured one is.
double measured(const CsvReader& reader, int column) {
  constexpr double beyond_all = 1e100;
  const double value = reader.number(column);
  if (std::abs(value) > beyond_all)
    throw reader.error(reader.columns()[static_cast<std::size_t>(column)] + ": " + printable(reader.field(column), 40) +
                       " is beyond " + shortest(beyond_all));
  return value;
}

/// NaN where there is no column, or the field is empty.
double measured_or_unknown(const CsvReader& reader, int column) {
  if (column < 0 || reader.field(column).empty()) return std::numeric_limits<double>::quiet_NaN();
  return measured(reader, column);
}

/// The digits of a name that is like one of an element: M12, f_12, "m12 [-]", S12, mueller12, F12/F11 … Else nothing.
std::string like_an_element(const std::string& column) {
  std::string name;
  for (const char c : column)
    if (std::isalnum(static_cast<unsigned char>(c)))
      name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const std::size_t digits = name.find_first_of("0123456789");
  if (digits == std::string::npos || digits + 2 > name.size()) return "";
  const std::string letters = name.substr(0, digits), rest = name.substr(digits + 2);
  const auto is_one_of = [](const std::string& word, std::initializer_list<const char*> words) {
    return std::ranges::find(words, word) != words.end();
  };
  return is_one_of(letters, {"m", "f", "s", "fr", "mm", "mueller"}) &&
                 is_one_of(rest, {"", "1", "f11", "fr11", "m11", "s11", "percent"})
             ? name.substr(digits, 2)
             : "";
}

/// Refuses such a column of an element which else is not measured, or of none.
void require_no_likeness(const CsvReader& reader, const std::array<int, 16>& columns) {
  for (std::size_t c = 0; c < reader.columns().size(); ++c) {
    const std::string digits = like_an_element(reader.columns()[c]);
    if (digits.empty() || std::ranges::find(columns, static_cast<int>(c)) != columns.end()) continue;
    std::size_t e = 0;
    while (e < 16 && digits != element_name(e)) ++e;
    if (e == 0 || (e < 16 && columns[e] >= 0)) continue;
    throw reader.error("column " + shown_name(reader.columns()[c]) + ": " +
                       (e < 16 ? "is it " + sample_element(e) + ", the element divided by f11? "
                               : "elements are called m12 ... m44. ") +
                       "Columns of other names are not read");
  }
}

/// The columns of f11 and of the normalised elements, in row-major order. That of m11, if there is one, must be 1.
std::array<int, 16> element_columns(const CsvReader& reader, int& m11) {
  using namespace std::string_view_literals;
  const std::string_view f11_names[] = {"f11"sv, "f_r11"sv, "fr11"sv}, m11_names[] = {"m11"sv, "f_r11/f_r11"sv};
  std::array<int, 16> columns;
  columns[0] = reader.find(f11_names);
  m11 = reader.find(m11_names);
  if (columns[0] < 0 && m11 >= 0)
    throw reader.error(
        "column m11, but no f11: samples need the unpolarized BRDF f11 in 1/sr, and m12 ... m44 divided "
        "by it; a table of elements that are not divided cannot be read as samples");
  if (columns[0] < 0) throw reader.error("no column f11 (nor f_r11), the unpolarized BRDF in 1/sr");
  for (std::size_t e = 1; e < columns.size(); ++e) {
    const std::string own = sample_element(e);
    const std::string published = std::string("f_r").append(own, 1).append("/f_r11");
    const std::string_view names[] = {own, published};
    columns[e] = reader.find(names);
  }
  require_no_likeness(reader, columns);
  return columns;
}

/// The columns of their standard uncertainties, of all that are measured or of none.
std::array<int, 16> uncertainty_columns(const CsvReader& reader, const std::array<int, 16>& elements) {
  std::array<int, 16> columns;
  std::array<std::string, 16> names;
  for (std::size_t e = 0; e < columns.size(); ++e) {
    names[e] = std::string("u_").append(sample_element(e));
    const std::string_view name[] = {names[e]};
    columns[e] = reader.find(name);
  }
  int some = -1;  // of which the uncertainty is there
  for (std::size_t e = 0; e < columns.size(); ++e) {
    if (columns[e] >= 0 && elements[e] < 0) throw reader.error("column " + names[e] + ", but no " + sample_element(e));
    if (columns[e] >= 0 && some < 0) some = static_cast<int>(e);
  }
  for (std::size_t e = 0; e < columns.size(); ++e)
    if (some >= 0 && elements[e] >= 0 && columns[e] < 0)
      throw reader.error("column " + names[static_cast<std::size_t>(some)] + ", but no " + names[e] +
                         ": uncertainties are needed of all elements that are there, or of none");
  return columns;
}

/// Of the angle by which the sample was turned, −1 if it was not.
int rotation_column(const CsvReader& reader) {
  constexpr std::string_view names[] = {"sample_rotation_deg"};
  return reader.find(names);
}

double uncertainty(const CsvReader& reader, int column) {
  const double value = measured(reader, column);
  if (value < 0)
    throw reader.error(reader.columns()[static_cast<std::size_t>(column)] + ": " + printable(reader.field(column), 40) +
                       ": an uncertainty must not be negative");
  return value;
}

/// Whether all samples have uncertainties.
bool have_uncertainties(std::span<const Sample> samples) {
  if (std::none_of(samples.begin(), samples.end(), has_uncertainty)) return false;
  const auto without = std::find_if_not(samples.begin(), samples.end(), has_uncertainty);
  if (without != samples.end())
    throw std::invalid_argument("sample " + std::to_string(without - samples.begin() + 1) +
                                " has no uncertainties, but others have");
  return true;
}

}  // namespace

SampleReader::SampleReader(std::istream& in, const std::string& name)
    : name_(name),
      reader_(in, name),
      geometry_(reader_),
      rotation_(rotation_column(reader_)),
      elements_(element_columns(reader_, m11_)),
      uncertainties_(uncertainty_columns(reader_, elements_)) {}

bool SampleReader::next(Sample& sample) {
  if (!reader_.next()) {
    if (rows_ == 0) throw std::runtime_error(name_ + ": no samples after the header line");
    return false;
  }
  ++rows_;
  sample.wavelength = geometry_.wavelength(reader_);
  sample.geometry = geometry_.geometry(reader_);
  sample.f11 = measured_or_unknown(reader_, elements_[0]);
  sample.normalized.elements[0] = 1;
  for (std::size_t e = 1; e < elements_.size(); ++e)
    sample.normalized.elements[e] = measured_or_unknown(reader_, elements_[e]);
  const Elements unknown = not_measured(sample);
  if (unknown.all()) throw reader_.error("no element is measured: all of these fields are empty");
  for (std::size_t e = 0; e < uncertainties_.size(); ++e)
    sample.uncertainty.elements[e] = uncertainties_[e] < 0 || unknown[e] ? 0 : uncertainty(reader_, uncertainties_[e]);
  if (rotation_ >= 0) sample = turned(sample, -radians(measured(reader_, rotation_)));
  if (m11_ >= 0 && reader_.number(m11_) != 1)
    throw reader_.error("m11: " + printable(reader_.field(m11_), 40) +
                        ": must be 1 next to f11, as elements are divided by it");
  return true;
}

std::vector<Sample> read_samples(std::istream& in, const std::string& name) {
  SampleReader reader(in, name);
  std::vector<Sample> samples;
  for (Sample sample; reader.next(sample);) samples.push_back(sample);
  return samples;
}

bool holds_samples(const std::string& path) {
  std::ifstream in = open_input(path);
  for (std::string line; std::getline(in, line);) {
    const std::size_t first = line.find_first_not_of(" \t\r\xef\xbb\xbf");
    if (first != std::string::npos && line[first] != '#')
      return std::isalpha(static_cast<unsigned char>(line[first])) != 0;
  }
  return false;
}

std::vector<Sample> read_samples(const std::string& path) {
  std::ifstream in = open_input(path);
  return read_samples(in, path);
}

void write_samples(const std::string& path, std::span<const Sample> samples) {
  require_valid(samples);
  write_file(path, [&](std::ostream& out) { write_samples(out, samples); });
}

void write_samples(std::ostream& out, std::span<const Sample> samples) {
  require_valid(samples);
  const bool with_uncertainties = have_uncertainties(samples);
  Elements never = samples.empty() ? Elements{} : not_measured(samples);
  never.reset(0);  // a file needs the column of f11
  out << "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg";
  for (const char* prefix : {"", "u_"})
    for (std::size_t e = 0; e < 16 && (*prefix == 0 || with_uncertainties); ++e)
      if (!never[e]) out << ',' << prefix << sample_element(e);
  out << '\n';
  for (const Sample& sample : samples) {
    const Elements unknown = not_measured(sample);
    out << shortest(in_nanometres(sample.wavelength));
    for (const Direction& direction : {sample.geometry.incident, sample.geometry.reflected})
      out << ',' << shortest(in_degrees(direction.theta)) << ',' << shortest(in_degrees(direction.phi));
    Mueller values = sample.normalized;
    values(0, 0) = sample.f11;
    for (const Mueller* numbers : std::array<const Mueller*, 2>{&values, &sample.uncertainty})
      for (std::size_t e = 0; e < 16 && (numbers == &values || with_uncertainties); ++e)
        if (!never[e]) out << ',' << (unknown[e] ? "" : shortest(numbers->elements[e]));
    out << '\n';
  }
}

}  // namespace mmbrdf
