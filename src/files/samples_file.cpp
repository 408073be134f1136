// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/files/io.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <tuple>

#include "mmbrdf/fitting/projection.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

// ---- samples --------------------------------------------------------------------------------------------------------

/// A value whose square and sums of squares are finite, as any measured one is.
double measured(const CsvReader& reader, int column) {
  constexpr double beyond_all = 1e100;
  const double value = reader.number(column);
  if (std::abs(value) > beyond_all)
    throw reader.error(reader.columns()[static_cast<std::size_t>(column)] + ": " + std::string(reader.field(column)) +
                       " is beyond " + shortest(beyond_all));
  return value;
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
    if (columns[e] < 0) throw reader.error("no column " + own + " (nor " + published + "), the element divided by f11");
  }
  return columns;
}

/// The columns of their standard uncertainties, all or none.
std::array<int, 16> uncertainty_columns(const CsvReader& reader) {
  std::array<int, 16> columns;
  std::array<std::string, 16> names;
  for (std::size_t e = 0; e < columns.size(); ++e) {
    names[e] = std::string("u_").append(sample_element(e));
    const std::string_view name[] = {names[e]};
    columns[e] = reader.find(name);
  }
  const auto is_there = [](int column) { return column >= 0; };
  const auto there = std::find_if(columns.begin(), columns.end(), is_there);
  const auto missing = std::find_if_not(columns.begin(), columns.end(), is_there);
  if (there != columns.end() && missing != columns.end())
    throw reader.error("column " + names[static_cast<std::size_t>(there - columns.begin())] + ", but no " +
                       names[static_cast<std::size_t>(missing - columns.begin())] +
                       ": uncertainties are needed of all sixteen elements, or of none");
  return columns;
}

double uncertainty(const CsvReader& reader, int column) {
  const double value = measured(reader, column);
  if (value < 0)
    throw reader.error(reader.columns()[static_cast<std::size_t>(column)] + ": " + std::string(reader.field(column)) +
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

// ---- coefficients ---------------------------------------------------------------------------------------------------

struct CoefficientRow {
  Mode mode;
  int p;
  double value;
};

bool is_valid(const Mode& mode) {
  try {
    require_valid(mode, Family::germer2017);
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

int index_in(const CsvReader& reader, int column, int lowest, int highest) {
  const std::string& name = reader.columns()[static_cast<std::size_t>(column)];
  int value = 0;
  try {
    value = parse_index(reader.field(column));
  } catch (const std::invalid_argument& e) {
    throw reader.error(name + ": " + e.what());
  }
  if (value < lowest || value > highest)
    throw reader.error(name + " = " + std::to_string(value) + " is not in " + std::to_string(lowest) + "..." +
                       std::to_string(highest));
  return value;
}

CoefficientRow coefficient_row(const CsvReader& reader) {
  const int i = index_in(reader, 0, 1, 4), j = index_in(reader, 1, 1, 4);
  const std::string element = std::to_string(i) + std::to_string(j);
  if (i > j)
    throw reader.error("element " + element + " is below the diagonal: by reciprocity it has the coefficients of " +
                       std::to_string(j) + std::to_string(i) + ", which alone are in such files");
  const Mode mode{.function = function_from(element),
                  .n = index_in(reader, 2, 0, max_order),
                  .m = index_in(reader, 3, 0, max_order),
                  .k = index_in(reader, 4, -max_order, max_order),
                  .l = index_in(reader, 5, -max_order, max_order)};
  try {
    require_valid(mode, Family::germer2017);
  } catch (const std::invalid_argument& e) {
    const bool swapped = is_valid({mode.function, mode.m, mode.n, mode.k, mode.l});
    throw reader.error(e.what() + std::string(swapped
                                                  ? "; columns 3 and 4 look exchanged: column 3 is n and goes with k, "
                                                    "column 4 is m and goes with l"
                                                  : ""));
  }
  return {mode, index_in(reader, 6, 0, max_power), reader.number(7)};
}

auto key(const Mode& mode, int p) { return std::tuple(mode.function, mode.n, mode.m, mode.k, mode.l, p); }

/// A number as the published files write it: the fewest digits, without an exponent unless it is below 1e-6.
std::string published_number(double value) {
  if (std::abs(value) < 1e-6 || std::abs(value) >= 1e15) return shortest(value);
  std::array<char, 64> text;
  return {text.begin(), std::to_chars(text.begin(), text.end(), value, std::chars_format::fixed).ptr};
}

std::string file_stem(const std::string& path) { return std::filesystem::path(path).stem().string(); }

/// All that a text file holds.
std::string contents(const std::string& path) {
  std::ifstream in = open_input(path);
  std::string text;
  std::vector<char> piece(1 << 16);
  while (in.read(piece.data(), static_cast<std::streamsize>(piece.size())) || in.gcount() > 0) {
    text.append(piece.data(), static_cast<std::size_t>(in.gcount()));
    if (text.find('\0', text.size() - static_cast<std::size_t>(in.gcount())) != std::string::npos)
      throw std::runtime_error(path + ": binary file, not a model");
  }
  if (in.bad()) throw std::runtime_error(path + ": read error");
  return text;
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

SampleReader::SampleReader(std::istream& in, const std::string& name)
    : name_(name),
      reader_(in, name),
      geometry_(reader_),
      elements_(element_columns(reader_, m11_)),
      uncertainties_(uncertainty_columns(reader_)) {}

bool SampleReader::next(Sample& sample) {
  if (!reader_.next()) {
    if (rows_ == 0) throw std::runtime_error(name_ + ": no samples after the header line");
    return false;
  }
  ++rows_;
  sample.wavelength = geometry_.wavelength(reader_);
  sample.geometry = geometry_.geometry(reader_);
  sample.f11 = measured(reader_, elements_[0]);
  sample.normalized.elements[0] = 1;
  for (std::size_t e = 1; e < elements_.size(); ++e) sample.normalized.elements[e] = measured(reader_, elements_[e]);
  for (std::size_t e = 0; e < uncertainties_.size(); ++e)
    sample.uncertainty.elements[e] = uncertainties_[e] < 0 ? 0 : uncertainty(reader_, uncertainties_[e]);
  if (m11_ >= 0 && reader_.number(m11_) != 1)
    throw reader_.error("m11: " + std::string(reader_.field(m11_)) +
                        ": must be 1 next to f11, as elements are divided by it");
  return true;
}

std::vector<Sample> read_samples(std::istream& in, const std::string& name) {
  SampleReader reader(in, name);
  std::vector<Sample> samples;
  for (Sample sample; reader.next(sample);) samples.push_back(sample);
  return samples;
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
  out << "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,f11";
  for (std::size_t e = 1; e < 16; ++e) out << ',' << sample_element(e);
  for (std::size_t e = 0; e < 16 && with_uncertainties; ++e) out << ",u_" << sample_element(e);
  out << '\n';
  for (const Sample& sample : samples) {
    out << shortest(in_nanometres(sample.wavelength));
    for (const Direction& direction : {sample.geometry.incident, sample.geometry.reflected})
      out << ',' << shortest(in_degrees(direction.theta)) << ',' << shortest(in_degrees(direction.phi));
    out << ',' << shortest(sample.f11);
    for (std::size_t e = 1; e < 16; ++e) out << ',' << shortest(sample.normalized.elements[e]);
    for (std::size_t e = 0; e < 16 && with_uncertainties; ++e) out << ',' << shortest(sample.uncertainty.elements[e]);
    out << '\n';
  }
}

Model read_coefficients(std::istream& in, const std::string& name) {
  CsvReader reader(in, name, {"i", "j", "n", "m", "k", "l", "p", "a"});
  std::map<decltype(key(Mode{}, 0)), CoefficientRow> rows;
  Model model;
  model.name = file_stem(name);
  model.family = Family::germer2017;
  while (reader.next()) {
    const CoefficientRow row = coefficient_row(reader);
    if (!rows.emplace(key(row.mode, row.p), row).second)
      throw reader.error("mode " + to_string(row.mode) + " with p = " + std::to_string(row.p) +
                         " is given a second time");
    model.powers = std::max(model.powers, row.p);
  }
  if (rows.empty()) throw std::runtime_error(name + ": empty file, without coefficients");
  std::vector<Mode> modes;
  for (const auto& [index, row] : rows)
    if (modes.empty() || modes.back() != row.mode) modes.push_back(row.mode);
  for (Block& block : blocks(Family::germer2017, modes)) {
    FittedBlock fitted;
    for (int p = 0; p <= model.powers; ++p)
      for (const Mode& mode : block.modes) {
        const auto found = rows.find(key(mode, p));
        fitted.coefficients.push_back(found == rows.end() ? 0 : found->second.value);
      }
    fitted.block = std::move(block);
    model.blocks.push_back(std::move(fitted));
  }
  try {
    require_valid(model);
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(name + ": " + e.what());
  }
  return model;
}

Model read_coefficients(const std::string& path) {
  std::ifstream in = open_input(path);
  return read_coefficients(in, path);
}

std::string to_coefficients_csv(const Model& model) {
  require_valid(model);
  if (model.mapping != DiscMapping::lambert)
    throw std::invalid_argument("the published layout is for the mapping lambert, not " + to_string(model.mapping));
  const Model published = in_published_form(model);
  std::string text;
  for (const FittedBlock& fitted : published.blocks) {
    auto value = fitted.coefficients.begin();
    for (int p = 0; p <= published.powers; ++p)
      for (const Mode& mode : fitted.block.modes) {
        const std::string element = to_string(mode.function);
        text += {element[0], ',', ' ', element[1]};
        for (const int index : {mode.n, mode.m, mode.k, mode.l, p}) text += ", " + std::to_string(index);
        text += ", " + published_number(*value++) + "\n";
      }
  }
  return text;
}

Model load_model(const std::string& path) {
  const std::string text = contents(path);
  const std::size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  if (first == std::string::npos) throw std::runtime_error(path + ": empty file, without a model");
  if (text[first] == '{') {
    Model model = model_from_json(text, path);
    if (model.name.empty()) model.name = file_stem(path);
    return model;
  }
  std::istringstream lines(text);
  return read_coefficients(lines, path);
}

namespace {

bool is_csv(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending == ".csv";
}

}  // namespace

void save_model(const std::string& path, const Model& model) {
  const std::string text = is_csv(path) ? to_coefficients_csv(model) : to_json(model);
  write_file(path, [&](std::ostream& out) { out << text; });
}

}  // namespace mmbrdf
