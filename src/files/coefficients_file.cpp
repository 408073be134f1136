// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/files/coefficients_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include "mmbrdf/files/csv.hpp"
#include "mmbrdf/formats/projection.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

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

}  // namespace

Model read_coefficients(std::istream& in, const std::string& name) {
  CsvReader reader(in, name, {"i", "j", "n", "m", "k", "l", "p", "a"}, ';');  // as SCATMECH takes a remark
  std::map<decltype(key(Mode{}, 0)), CoefficientRow> rows;
  Model model;
  model.name = std::filesystem::path(name).stem().string();
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

}  // namespace mmbrdf
