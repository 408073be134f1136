// SPDX-License-Identifier: BSD-3-Clause
#include "pages/describe.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>

#include "mmbrdf/model/description.hpp"
#include "mmbrdf/quantities/trust.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"
#include "mmbrdf/radiometry/reflectance_uncertainty.hpp"
#include "mmbrdf/text/rounding.hpp"
#include "pages/output.hpp"

namespace mmbrdf::program {

namespace {

std::string dumped(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

/// In one line, but the members of an object and the rows of a table in one line each.
std::string by_lines(const nlohmann::ordered_json& json) {
  const bool table = json.is_array() && !json.empty() && json.front().is_structured();
  if (!table && !(json.is_object() && !json.empty())) return dumped(json);
  std::string text;
  for (const auto& [name, value] : json.items())
    text += (text.empty() ? "\n    " : ",\n    ") + (table ? "" : dumped(name) + ": ") + dumped(value);
  return (table ? "[" : "{") + text + (table ? "\n  ]" : "\n  }");
}

}  // namespace

nlohmann::ordered_json basis_json(const Model& model) {
  const Orders order = orders(model);
  nlohmann::ordered_json json{{"basis", to_string(model.family)}, {"orders", {order.f11, order.other}},
                              {"powers", model.powers},           {"mapping", to_string(model.mapping)},
                              {"modes", mode_count(model)},       {"coefficients", coefficient_count(model)}};
  if (model.rotation == Rotation::as_printed) json["rotation"] = to_string(model.rotation);
  json["wavelengths_nm"] = nlohmann::ordered_json::array();
  for (const double wavelength : model.validity.wavelengths) json["wavelengths_nm"].push_back(nanometres(wavelength));
  return json;
}

void note_unless_printed(const Model& model, const std::string& name) {
  if (!traits(model.family).at_zero_azimuth)
    note("--as-printed changes nothing: " + name + " is of the basis " + to_string(model.family) + ", not germer2017");
}

void warn_if_outside(const Model& model, std::span<const Sample> samples, const std::string& name) {
  RangeCount range;
  for (const Sample& s : samples) range.add(outside(model.validity, s.wavelength, s.geometry));
  if (range.outside > 0) warn(range.line("sample") + ": fitted are " + fitted_range(model.validity));
  const std::string unknown = unknown_range_line(name, model.validity);
  if (!unknown.empty()) note(unknown);
}

namespace {

/// "0.9843 +- 0.0036", or six decimals of a model without uncertainties.
std::string normal_reflectance(const Model& model, double wavelength) {
  const double value = directional_hemispherical_reflectance(model, wavelength, {});
  if (!knows_uncertainty(model)) return format("%.6f", value);
  const double u = standard_uncertainty(directional_hemispherical_budget(uncertain(model, wavelength), {}));
  return u > 0 ? to_place_of(value, u) + " +- " + to_place_of(u, u) : format("%.6f", value);
}

}  // namespace

std::string normal_reflectance_line(const Model& model) {
  std::string text;
  for (const double wavelength : known_wavelengths(model)) {
    text += (text.empty() ? "" : ", ") + normal_reflectance(model, wavelength);
    text += knows_wavelength(model) ? " at " + brief(nanometres(wavelength)) + " nm" : "";
  }
  return text.empty() ? "not known, for the wavelengths are not" : text;
}

nlohmann::ordered_json normal_reflectance_json(const Model& model) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const double wavelength : known_wavelengths(model)) {
    nlohmann::ordered_json entry;
    entry["wavelength_nm"] = nullptr;
    if (knows_wavelength(model)) entry["wavelength_nm"] = nanometres(wavelength);
    entry["reflectance"] = directional_hemispherical_reflectance(model, wavelength, {});
    json.push_back(entry);
  }
  return json;
}

std::string uncertainty_line(const std::string& uncertain, const std::string& missing,
                             const std::vector<std::string>& terms) {
  const std::string start = "u: standard uncertainty of " + uncertain;
  if (!terms.empty()) return start + " and of " + joined(terms) + "\n";
  return start + (uncertain == "the fit" ? " alone" : "") + (missing.empty() ? "" : "; " + missing) + "\n";
}

double without_rounding(double x) { return std::abs(x) < 5e-11 ? 0 : x; }

std::string matrix_text(const Mueller& m, const std::optional<Mueller>& u) {
  std::string text;
  for (std::size_t e = 0; e < 16; ++e) {
    const double value = without_rounding(m.elements[e]);
    const std::string element = std::isnan(value) ? "-"
                                : u               ? to_place_of(value, without_rounding(u->elements[e]))
                                                  : format("%.10f", value);
    const auto point = static_cast<int>(std::min(element.find('.'), element.size()));
    text += format("%5.*s%-11s", point, element.c_str(), element.c_str() + point);
    if (text.back() != ' ') text += ' ';  // of a large number
    if (e % 4 == 3) text.erase(text.find_last_not_of(' ') + 1) += '\n';
  }
  return text;
}

nlohmann::ordered_json matrix_json(const Mueller& m) {
  nlohmann::ordered_json rows;
  for (std::size_t row = 0; row < 4; ++row)
    rows.push_back(std::vector<double>(&m.elements[4 * row], &m.elements[4 * row] + 4));
  return rows;
}

std::string printed(const nlohmann::ordered_json& json) {
  std::string text;
  for (const auto& [name, value] : json.items())
    text += (text.empty() ? "{\n  " : ",\n  ") + dumped(name) + ": " + by_lines(value);
  return text + "\n}\n";
}

std::string printed_all(const std::vector<nlohmann::ordered_json>& all) {
  return printed(all.size() == 1 ? all.front() : nlohmann::ordered_json{{"rows", all}});
}

void warn_if_above_one(const Model& model, std::span<const double> wavelengths) {
  for (const double wavelength : wavelengths) {
    const std::string where =
        knows_wavelength(model) ? "at " + nanometre_list(std::array{wavelength}) : "at any wavelength";
    const std::string line = energy_line(f11_diagnostics(model, wavelength, 0), where);
    if (!line.empty()) return warn(line);
  }
}

void print(const nlohmann::ordered_json& json) { std::cout << printed(json); }

}  // namespace mmbrdf::program
