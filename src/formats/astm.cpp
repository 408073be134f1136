// SPDX-License-Identifier: BSD-3-Clause
#include "formats/astm.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "formats/text_file.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr std::array angle_names{"theta_i", "phi_i", "theta_s", "phi_s"};

/// The wavelength that the name of a column says, "532nm", in micrometres.
std::optional<double> named_wavelength(std::string_view name) {
  if (name.size() < 3 || !same_word(name.substr(name.size() - 2), "nm")) return {};
  try {
    return parse_number(name.substr(0, name.size() - 2)) / 1000;
  } catch (const std::invalid_argument&) {
    return {};
  }
}

class AstmReader : public ForeignFile::Reader {
 public:
  explicit AstmReader(const Source& source) : file_(source.path), path_(source.path) {
    read_header();
    angles_.fill(-1);
    std::string names;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      bool angle = false;
      for (std::size_t a = 0; a < 4; ++a)
        if (same_word(columns_[c], angle_names[a])) angle = true, angles_[a] = static_cast<int>(c);
      if (angle) continue;
      values_.push_back(c);
      names += (names.empty() ? "" : ", ") + shown_name(columns_[c]);
    }
    for (const std::size_t a : {0U, 2U, 3U})
      if (angles_[a] < 0) throw file_.error("VARS has no column " + std::string(angle_names[a]));
    if (values_.empty()) throw file_.error("VARS has no column of values behind the angles");
    find_wavelengths(source, names);
    understood = "angles in radians, f11 in sr^-1 = " + names + " at " + nanometre_text(wavelengths_) +
                 (named_ ? "" : " as told") +
                 (angles_[1] < 0 ? ", phi_i = 0" : ", phi_i of the source, phi_s of the detector");
  }

  void read(const UseSamples& use) override {
    SampleSink sink(use);
    std::uint64_t rows = 0;
    while (file_.next()) {
      if (file_.line()[0] == '#') continue;
      ++rows;
      const std::vector<std::string_view> row = fields(file_.line());
      if (row.size() != columns_.size())
        throw file_.error(std::to_string(row.size()) + " values, but VARS has " + std::to_string(columns_.size()) +
                          " columns: cut off?");
      const Geometry geometry{direction_of(row, 0), direction_of(row, 2)};
      for (std::size_t v = 0; v < values_.size(); ++v)
        sink.add(scalar_sample(wavelengths_[v], geometry, file_.number(row[values_[v]], columns_[values_[v]])));
    }
    if (points_ && static_cast<double>(rows) != *points_)
      throw file_.error("NUM_POINTS is " + shortest(*points_) + ", but there are " + std::to_string(rows) +
                        " rows: cut off? Correct NUM_POINTS if all are there");
    sink.finish(path_);
    passed_over = sink.passed_over(values_.size() > 1 ? "values" : "rows") + file_.end_note();
  }

 private:
  void read_header() {
    while (file_.next()) {
      const std::string_view line = file_.line();
      const std::string_view word = line.substr(0, line.find_first_of(" \t,"));
      const std::string_view rest = line.substr(word.size());
      if (word == "NUM_POINTS") points_ = file_.number(rest, "NUM_POINTS");
      if (word != "VARS") continue;
      for (const std::string_view name : fields(rest)) columns_.emplace_back(name);
      return;
    }
    throw file_.error("the header ends without VARS: cut off?");
  }

  void find_wavelengths(const Source& source, const std::string& names) {
    std::size_t named = 0;
    for (const std::size_t c : values_)
      if (const std::optional<double> wavelength = named_wavelength(columns_[c])) {
        require_wavelength(*wavelength, source.path + ": column " + shown_name(columns_[c]));
        wavelengths_.push_back(*wavelength);
        ++named;
      }
    named_ = named == values_.size();
    if (named_) return source.require_none_told();
    if (named > 0) throw file_.error("only some of the columns " + names + " have a wavelength, as in 532nm");
    const std::string what = values_.size() == 1 ? "column " + names : "columns " + names;
    wavelengths_ = source.told_wavelengths(values_.size(), what);
  }

  Direction direction_of(const std::vector<std::string_view>& row, std::size_t first) const {
    const auto angle = [&](std::size_t a, double most) {
      if (angles_[a] < 0) return 0.0;
      const double value = file_.number(row[static_cast<std::size_t>(angles_[a])], angle_names[a]);
      if (std::abs(value) > most + few_digits)
        throw file_.error(std::string(angle_names[a]) + ": " + shortest(value) +
                          " is no angle in radians; of degrees make radians");
      return value;
    };
    const double theta = angle(first, std::numbers::pi / 2), phi = angle(first + 1, 2 * std::numbers::pi);
    return unfolded({theta, phi});
  }

  TextFile file_;
  std::string path_;
  std::optional<double> points_;
  std::vector<std::string> columns_;
  std::array<int, 4> angles_{};  // their columns
  std::vector<std::size_t> values_;
  std::vector<double> wavelengths_;
  bool named_ = false;
};

}  // namespace

bool is_astm(std::string_view head, std::uint64_t) {
  return has_keyword(head, "VARS") || has_keyword(head, "NUM_POINTS");
}

std::unique_ptr<ForeignFile::Reader> open_astm(const Source& source) { return std::make_unique<AstmReader>(source); }

}  // namespace mmbrdf
