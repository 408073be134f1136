// SPDX-License-Identifier: BSD-3-Clause
#include "formats/alta.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numbers>
#include <optional>

#include "formats/half_difference.hpp"
#include "formats/text_file.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using Numbers = std::span<const double>;
using Geometries = std::optional<Geometry> (*)(Numbers);  // nothing: below the horizon

std::optional<Geometry> of_vectors(const Vector3& light, const Vector3& view, double turn) {
  if (light[2] <= horizon || view[2] <= horizon) return {};
  Geometry geometry{direction(light), direction(view)};
  geometry.incident.phi += turn;
  geometry.reflected.phi += turn;
  return geometry;
}

Geometry of_angles(double theta_l, double phi_l, double theta_v, double phi_v) {
  return {unfolded({theta_l, phi_l}), unfolded({theta_v, phi_v})};
}

/// The difference angles are those of the view, not of the light.
std::optional<Geometry> of_half(double theta_h, double phi_h, double theta_d, double phi_d) {
  const HalfDifference both = half_difference(theta_h, theta_d, phi_d);
  return of_vectors(both.reflected, both.incident, phi_h);
}

struct Parametrization {
  const char* name;
  std::size_t coordinates;
  std::array<bool, 6> polar;  // which are angles from an axis, of at most 90 degrees
  bool angles;
  Geometries geometry;
};

constexpr std::array parametrizations{
    Parametrization{"SPHERICAL_TL_PL_TV_PV",
                    4,
                    {true, false, true, false},
                    true,
                    [](Numbers x) -> std::optional<Geometry> { return of_angles(x[0], x[1], x[2], x[3]); }},
    Parametrization{"ISOTROPIC_TV_TL_DPHI",
                    3,
                    {true, true, false},
                    true,
                    [](Numbers x) -> std::optional<Geometry> { return of_angles(x[1], 0, x[0], -x[2]); }},
    Parametrization{"ISOTROPIC_TL_TV_PROJ_DPHI",
                    3,
                    {true, false, false},
                    true,
                    [](Numbers x) -> std::optional<Geometry> {
                      return of_angles(x[0], 0, std::hypot(x[1], x[2]), std::atan2(x[2], x[1]));
                    }},
    Parametrization{"RUSIN_TH_TD_PD",
                    3,
                    {true, true, false},
                    true,
                    [](Numbers x) -> std::optional<Geometry> {
                      std::optional<Geometry> g = of_half(x[0], 0, x[1], x[2]);
                      if (g) g->reflected.phi -= g->incident.phi, g->incident.phi = 0;
                      return g;
                    }},
    Parametrization{"RUSIN_TH_PH_TD_PD",
                    4,
                    {true, false, true, false},
                    true,
                    [](Numbers x) { return of_half(x[0], x[1], x[2], x[3]); }},
    Parametrization{"CARTESIAN",
                    6,
                    {},
                    false,
                    [](Numbers x) {
                      return of_vectors({x[3], x[4], x[5]}, {x[0], x[1], x[2]}, 0);
                    }},
};

bool is_count(std::string_view word) {
  return std::ranges::all_of(word, [](unsigned char c) { return std::isdigit(c) != 0; });
}

class AltaReader : public ForeignFile::Reader {
 public:
  explicit AltaReader(const Source& source) : file_(source.path), path_(source.path) {
    there_ = read_header();
    if (dimensions_.size() != 2) throw file_.error("the header has no line #DIM with two numbers: cut off?");
    if (input_ == nullptr) throw file_.error("the header has no line #PARAM_IN: cut off?");
    if (dimensions_[0] != static_cast<double>(input_->coordinates))
      throw file_.error("#DIM says " + shortest(dimensions_[0]) + " coordinates, but " + input_->name + " has " +
                        std::to_string(input_->coordinates));
    if (!(dimensions_[1] >= 1 && dimensions_[1] <= 1000) || dimensions_[1] != std::floor(dimensions_[1]))
      throw file_.error("#DIM says " + shortest(dimensions_[1]) + " values a row, must be 1 to 1000");
    const auto values = static_cast<std::size_t>(dimensions_[1]);
    for (const double segment : segments_) columns_ += static_cast<std::size_t>(segment);
    if (segments_.size() == 1 && values > 1) columns_ *= values;
    columns_ += input_->coordinates + values;
    wavelengths_ =
        source.told_wavelengths(values, std::to_string(values) + (values == 1 ? " value" : " values") + " a row");
    understood = std::string(input_->name) + (input_->angles ? " in radians" : ", view before light") +
                 ", f11 in sr^-1 = " + (output_.empty() ? "the values, since no #PARAM_OUT says another" : output_) +
                 (cosine_ ? " / cos(theta_r)" : "") + " at " + nanometre_text(wavelengths_) + " as told";
    if (input_->coordinates == 3) understood += "; phi_i = 0";
    if (columns_ > input_->coordinates + values) understood += ", vertical segments not read";
  }

  void read(const UseSamples& use) override {
    SampleSink sink(use);
    for (; there_; there_ = file_.next())
      if (file_.line()[0] != '#') add_row(sink);
    sink.finish(path_);
    passed_over = sink.passed_over(wavelengths_.size() > 1 ? "values" : "rows") + file_.end_note();
  }

 private:
  /// Whether there is a row behind it, which is then the line.
  bool read_header() {
    while (file_.next()) {
      const std::string_view line = file_.line();
      if (line[0] != '#') {
        if (!dimensions_.empty()) return true;  // what is before the header is no row
        continue;
      }
      if (line.size() < 2 || std::isalpha(static_cast<unsigned char>(line[1])) == 0) continue;
      const std::vector<std::string_view> words = fields(line.substr(1));
      if (words[0] == "DIM") dimensions_ = numbers(words);
      if (words[0] == "VS") segments_ = numbers(words);
      if (words[0] == "FORMAT" && words.size() > 1 && words[1] == "binary")
        throw file_.error("#FORMAT binary: only text can be read; let ALTA write it as text");
      if (words[0] == "PARAM_IN") set_input(words);
      if (words[0] == "PARAM_OUT") set_output(words);
    }
    return false;
  }

  std::vector<double> numbers(const std::vector<std::string_view>& words) const {
    std::vector<double> result;
    for (std::size_t i = 1; i < words.size(); ++i) {
      result.push_back(file_.number(words[i], "#" + std::string(words[0])));
      if (words[0] == "VS" && result.back() != 0 && result.back() != 1 && result.back() != 2)
        throw file_.error("#VS: " + shortest(result.back()) + " is none of 0, 1, 2");
    }
    return result;
  }

  void set_input(const std::vector<std::string_view>& words) {
    std::string known;
    for (const Parametrization& one : parametrizations) {
      if (words.size() > 1 && words[1] == one.name) input_ = &one;
      known += (known.empty() ? "" : ", ") + std::string(one.name);
    }
    if (input_ == nullptr)
      throw file_.error("#PARAM_IN " + (words.size() > 1 ? shown_name(words[1]) : std::string()) +
                        ": which directions these are cannot be read; let ALTA write one of " + known);
  }

  void set_output(const std::vector<std::string_view>& words) {
    output_ = words.size() > 1 ? words[1] : std::string_view();
    cosine_ = output_ == "INV_STERADIAN_COSINE_FACTOR";
    if (output_ == "UNKNOWN" || output_ == "UNKNOWN_OUTPUT") output_.clear();
    if (!output_.empty() && !cosine_ && output_ != "INV_STERADIAN" && output_ != "RGB_COLOR")
      throw file_.error("#PARAM_OUT " + shown_name(output_) +
                        ": is no BRDF; INV_STERADIAN, INV_STERADIAN_COSINE_FACTOR and RGB_COLOR are");
  }

  void add_row(SampleSink& sink) const {
    const std::vector<std::string_view> words = fields(file_.line());
    if (words.size() != columns_)
      throw file_.error(std::to_string(words.size()) + " numbers in place of " + std::to_string(columns_) +
                        ": cut off?");
    std::array<double, 6> x{};
    for (std::size_t c = 0; c < input_->coordinates; ++c) {
      const std::string what = "coordinate " + std::to_string(c + 1);
      x[c] = file_.number(words[c], what);
      const double most = !input_->angles ? 1 : input_->polar[c] ? half_pi : 4 * half_pi;
      if (std::abs(x[c]) > most + few_digits)
        throw file_.error(what + ": " + shortest(x[c]) +
                          (input_->angles ? " is no such angle in radians" : " of a unit vector"));
    }
    std::optional<Geometry> geometry = input_->geometry(std::span(x).first(input_->coordinates));
    if (geometry && !above_horizon(*geometry)) geometry.reset();
    if (!geometry) sink.below_horizon(wavelengths_.size());
    for (std::size_t v = 0; v < wavelengths_.size(); ++v) {
      const double value = file_.number(words[input_->coordinates + v], "value");
      if (geometry)
        sink.add(
            scalar_sample(wavelengths_[v], *geometry, cosine_ ? value / std::cos(geometry->reflected.theta) : value));
    }
  }

  TextFile file_;
  std::string path_, output_;
  const Parametrization* input_ = nullptr;
  bool there_ = false, cosine_ = false;
  std::vector<double> dimensions_, segments_, wavelengths_;
  std::size_t columns_ = 0;
};

}  // namespace

bool is_alta(std::string_view head, std::uint64_t) {
  head = head.substr(0, head.find('\0'));  // the binary form, which is refused, has a header, too
  bool dimensions = false, input = false;
  for (; !head.empty() && !(dimensions && input); head.remove_prefix(std::min(head.find('\n'), head.size() - 1) + 1)) {
    const std::vector<std::string_view> words = fields(head.substr(0, head.find('\n')));
    if (words.empty()) continue;
    if (!words[0].starts_with('#')) return false;
    if (words.size() > 2 && words[0] == "#DIM") dimensions = is_count(words[1]) && is_count(words[2]);
    if (words.size() > 1 && words[0] == "#PARAM_IN") input = true;
  }
  return dimensions && input;
}

std::unique_ptr<ForeignFile::Reader> open_alta(const Source& source) { return std::make_unique<AltaReader>(source); }

}  // namespace mmbrdf
