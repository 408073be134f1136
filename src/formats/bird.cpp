// SPDX-License-Identifier: BSD-3-Clause
#include "formats/bird.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "formats/polarized_rows.hpp"
#include "mmbrdf/text/input.hpp"
#include "text/json_text.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

bool is_per_steradian(const std::string& unit) { return unit == "1/sr" || unit == "sr^-1" || unit == "sr-1"; }

using nlohmann::json;

constexpr double off_unit_length = 1e-9;  // of a length of 1, by rounding

/// The variables of `data`, and complaints with their names.
class Data {
 public:
  explicit Data(const Source& source) : path_(source.path) {
    std::ifstream in = open_input(path_);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    all_ = parsed_json(text, path_);
    if (!all_.is_object() || !all_.contains("data") || !all_["data"].is_object())
      throw source.error("no object data: not as BiRD JSON v1.0 has it");
    all_ = json(std::move(all_["data"]));
  }

  bool has(const char* name) const { return all_.contains(name); }

  [[nodiscard]] std::runtime_error error(const std::string& name, const std::string& what) const {
    return std::runtime_error(path_ + ": data." + name + ": " + what);
  }

  const json& variable(const char* name) const {
    if (!has(name) || !all_[name].is_object() || !all_[name].contains("values") || !all_[name]["values"].is_array())
      throw error(name, "missing, or without a list of values");
    return all_[name];
  }

  /// Of `count` numbers, or of any positive number of them: `count` is then that.
  std::vector<double> numbers(const char* name, std::size_t& count) const {
    const json& values = list(name, count);
    std::vector<double> result;
    for (const json& value : values) {
      if (!value.is_number() || !std::isfinite(value.get<double>()))
        throw error(name, "value " + std::to_string(result.size() + 1) + ": " + printable(value.dump(), 40) +
                              " is no finite number");
      result.push_back(value.get<double>());
    }
    return result;
  }

  const json& list(const char* name, std::size_t& count) const {
    const json& values = variable(name)["values"];
    if (count == 0) count = values.size();
    if (count == 0) throw error(name, "no values");
    if (values.size() != count)
      throw error(name, std::to_string(values.size()) + " values, but theta_i has " + std::to_string(count));
    return values;
  }

  /// The text of a field of a variable, such as its unit.
  std::string text(const char* name, const char* field) const {
    const json& one = variable(name);
    return one.contains(field) && one[field].is_string() ? one[field].get<std::string>() : std::string();
  }

 private:
  std::string path_;
  json all_;
};

class BirdReader : public ForeignFile::Reader {
 public:
  explicit BirdReader(const Source& source) : path_(source.path), data_(source) {
    std::array<std::vector<double>, 4> angles{angle("theta_i", 90), angle("phi_i", 360), angle("theta_r", 90),
                                              angle("phi_r", 360)};
    find_wavelengths(source);
    find_values();
    states("polarization_i", &PolarizedValue::incident);
    states("polarization_r", &PolarizedValue::analyzed);
    std::map<std::array<double, 5>, std::vector<std::size_t>> groups;  // rows of one geometry
    std::vector<std::array<double, 5>> order;
    for (std::size_t row = 0; row < rows_; ++row) {
      const std::array<double, 5> key{wavelengths_[row], angles[0][row], angles[1][row], angles[2][row],
                                      angles[3][row]};
      if (polarized_) {
        std::vector<std::size_t>& members = groups[key];
        if (members.empty()) order.push_back(key);
        members.push_back(row);
      } else {
        add(key, {&values_[row], 1});
      }
    }
    for (const auto& key : order) {
      std::vector<PolarizedValue> together;
      for (const std::size_t row : groups[key]) together.push_back(values_[row]);
      add(key, together);
    }
    finish();
  }

  void read(const UseSamples& use) override {
    SampleSink sink(use);
    for (const Sample& sample : samples_) sink.add(sample);
    sink.finish(path_);
    passed_over = sink.passed_over("geometries");
  }

 private:
  std::vector<double> angle(const char* name, double most) {
    const std::string unit = data_.text(name, "unit");
    if (unit != "deg" && unit != "°" && unit != "rad")
      throw data_.error(name, "unit " + in_quotes(unit) + " is none of deg, °, rad");
    std::vector<double> values = data_.numbers(name, rows_);
    for (std::size_t row = 0; row < values.size(); ++row) {
      const double in_degrees = unit == "rad" ? degrees(values[row]) : values[row];
      if (!(in_degrees >= 0 && in_degrees <= most + 1e-4))
        throw data_.error(name, "value " + std::to_string(row + 1) + ": " + shortest(in_degrees) +
                                    " degrees, must be in [0, " + shortest(most) + "]");
      values[row] = unit == "rad" ? values[row] : radians(values[row]);
    }
    return values;
  }

  std::vector<double> wavelengths(const char* name) {
    const std::string unit = data_.text(name, "unit");
    const bool micrometres = unit == "μm" || unit == "µm" || unit == "um";
    if (!micrometres && unit != "nm") throw data_.error(name, "unit " + in_quotes(unit) + " is none of nm, μm");
    std::vector<double> result = data_.numbers(name, rows_);
    for (double& value : result) {
      if (!micrometres) value /= 1000;
      require_wavelength(value, path_ + ": data." + name);
    }
    return result;
  }

  void find_wavelengths(const Source& source) {
    if (!data_.has("wavelength_i")) {
      wavelengths_.assign(rows_, source.told_wavelengths(1, "values").front());
      understood = "at " + nanometre_text(source.options.wavelengths) + " as told, ";
      return;
    }
    source.require_none_told();
    wavelengths_ = wavelengths("wavelength_i");
    if (!data_.has("wavelength_r")) return;
    const std::vector<double> reflected = wavelengths("wavelength_r");
    for (std::size_t row = 0; row < rows_; ++row)
      if (!same_wavelength(wavelengths_[row], reflected[row]))
        throw data_.error("wavelength_r",
                          "value " + std::to_string(row + 1) + ": " + nanometre_text({&reflected[row], 1}) +
                              " is not that of the incident light: fluorescence has no place in samples");
  }

  void find_values() {
    const std::string unit = data_.text("BRDF", "unit");
    if (!is_per_steradian(unit)) throw data_.error("BRDF", "unit " + in_quotes(unit) + " is none of 1/sr, sr^-1, sr-1");
    for (const double brdf : data_.numbers("BRDF", rows_)) values_.push_back({.brdf = brdf});
    if (!data_.has("uBRDF")) return;
    const std::string u_unit = data_.text("uBRDF", "unit");
    if (u_unit != "%" && !is_per_steradian(u_unit))
      throw data_.error("uBRDF", "unit " + in_quotes(u_unit) + " is none of 1/sr, sr^-1, sr-1, %");
    const std::vector<double> all = data_.numbers("uBRDF", rows_);
    for (std::size_t row = 0; row < rows_; ++row) {
      if (all[row] < 0) throw data_.error("uBRDF", "value " + std::to_string(row + 1) + " is negative");
      values_[row].uncertainty = u_unit == "%" ? all[row] / 100 * std::abs(values_[row].brdf) : all[row];
    }
    understood += "uBRDF in " + u_unit + " is its standard uncertainty, ";
  }

  void states(const char* name, Stokes PolarizedValue::*which) {
    if (!data_.has(name)) return;
    const bool stokes = data_.text(name, "notation") == "inStokes";
    if (!stokes && data_.text(name, "notation") != "sp") throw data_.error(name, "notation is neither sp nor inStokes");
    std::size_t row = 0;
    for (const json& value : data_.list(name, rows_)) {
      const Stokes state = stokes ? stokes_of(value, name, row) : letter(value, name, row);
      const double length = std::hypot(state[1], state[2], state[3]);
      if (which == &PolarizedValue::analyzed && length > off_unit_length && std::abs(length - 1) > 1e-3)
        throw data_.error(name, "value " + std::to_string(row + 1) + ": a partial polarization of " + shortest(length) +
                                    " is no analyzer; 0 or 1 are");
      polarized_ = polarized_ || length > 0;
      values_[row++].*which = state;
    }
  }

  Stokes letter(const json& value, const char* name, std::size_t row) const {
    if (value == "u") return {1, 0, 0, 0};
    if (value == "s") return {1, 1, 0, 0};
    if (value == "p") return {1, -1, 0, 0};
    throw data_.error(name,
                      "value " + std::to_string(row + 1) + ": " + printable(value.dump(), 40) + " is none of s, p, u");
  }

  Stokes stokes_of(const json& value, const char* name, std::size_t row) const {
    const auto is_number = [](const json& one) { return one.is_number(); };
    Stokes state{};
    if (value.is_array() && value.size() == 4 && std::ranges::all_of(value, is_number)) {
      for (std::size_t k = 0; k < 4; ++k) state[k] = value[k].get<double>();
      if (state[0] == 1 && std::hypot(state[1], state[2], state[3]) <= 1 + 1e-3) return state;
    }
    throw data_.error(name, "value " + std::to_string(row + 1) + ": " + printable(value.dump(), 40) +
                                " is no Stokes vector [1, s1, s2, s3]");
  }

  void add(const std::array<double, 5>& key, std::span<const PolarizedValue> values) {
    Sample sample{.wavelength = key[0], .geometry = {{key[1], key[2]}, {key[3], key[4]}}, .normalized = {}};
    solver_.solve(values, sample);
    if (polarized_) {
      sample.normalized = convert(sample.normalized, StokesConvention::s_first_right, StokesConvention::germer2017);
      if (above_horizon(sample.geometry)) sample = from_frame(sample, Frame::sp);
    }
    samples_.push_back(sample);
  }

  void finish() {
    measured = measured_elements(samples_);
    frames = std::ranges::any_of(samples_, [](const Sample& s) { return s.as_measured != nullptr; });
    if (!measured[0])
      throw data_.error("polarization_i", "the states determine f11 nowhere: it takes u, or s and p, on each side");
    uncertainties = std::ranges::any_of(samples_, has_uncertainty, in_own_frame);
    understood += "f11 in sr^-1";
    if (frames) understood += ", samples that would lose elements in xy left in the frame sp";
    if (polarized_)
      understood += ", elements by least squares of " + std::to_string(rows_) +
                    " values between polarization states, from the frame sp with right-handed S4 > 0";
    values_ = {};
    wavelengths_ = {};
  }

  std::string path_;
  Data data_;
  std::size_t rows_ = 0;
  std::vector<double> wavelengths_;
  std::vector<PolarizedValue> values_;
  bool polarized_ = false;
  PolarizedRows solver_;
  std::vector<Sample> samples_;
};

constexpr std::string_view json_blanks = " \t\r\n";
constexpr std::array<std::string_view, 7> variables{"\"BRDF\"",    "\"uBRDF\"", "\"theta_i\"",     "\"phi_i\"",
                                                    "\"theta_r\"", "\"phi_r\"", "\"wavelength_i\""};

/// Whether a text goes on with this behind blanks; it is then taken from its beginning.
bool takes(std::string_view& text, std::string_view what) {
  const std::string_view rest = text.substr(std::min(text.find_first_not_of(json_blanks), text.size()));
  if (!rest.starts_with(what)) return false;
  text = rest.substr(what.size());
  return true;
}

/// A model or instrument of this project, which may name a file in this format.
bool is_own(std::string_view head) {
  constexpr std::string_view key = "\"format\"";
  for (std::size_t at = head.find(key); at != std::string_view::npos; at = head.find(key, at + 1)) {
    std::string_view rest = head.substr(at + key.size());
    if (takes(rest, ":") && takes(rest, "\"mmbrdf ")) return true;
  }
  return false;
}

}  // namespace

bool is_bird(std::string_view head, std::uint64_t) {
  const auto has = [&](std::string_view text) { return head.find(text) != std::string_view::npos; };
  if (!takes(head, "{") || is_own(head)) return false;
  const std::string_view first = head.substr(std::min(head.find_first_not_of(json_blanks), head.size()));
  const bool begins = first.starts_with("\"data\"") || first.starts_with("\"metadata\"");
  return has("brdf_json_schema") || (has("\"theta_i\"") && has("\"values\"")) ||
         (begins && std::ranges::any_of(variables, has));
}

std::unique_ptr<ForeignFile::Reader> open_bird(const Source& source) { return std::make_unique<BirdReader>(source); }

}  // namespace mmbrdf
