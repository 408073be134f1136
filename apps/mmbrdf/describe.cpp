// SPDX-License-Identifier: BSD-3-Clause
#include "describe.hpp"

#include <iostream>
#include <stdexcept>

#include "arguments.hpp"
#include "mmbrdf/radiometry.hpp"
#include "output.hpp"

namespace mmbrdf::program {

namespace {

int mode_count(const Model& model) {
  std::size_t modes = 0;
  for (const FittedBlock& block : model.blocks) {
    modes += block.block.modes.size();
  }
  return static_cast<int>(modes);
}

std::string dumped(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

/// In one line, but the members of an object and the rows of a table in one line each.
std::string by_lines(const nlohmann::ordered_json& json) {
  const bool table = json.is_array() && !json.empty() && json.front().is_structured();
  if (!table && !(json.is_object() && !json.empty())) {
    return dumped(json);
  }
  std::string text;
  for (const auto& [name, value] : json.items()) {
    text += (text.empty() ? "\n    " : ",\n    ") + (table ? "" : dumped(name) + ": ") + dumped(value);
  }
  return (table ? "[" : "{") + text + (table ? "\n  ]" : "\n  }");
}

std::string counted(int count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

bool wavelength_unknown(const Model& model) {
  return model.validity.wavelengths.empty() && model.reflectance.wavelengths.empty();
}

}  // namespace

std::string basis_line(const Model& model) {
  const Orders order = orders(model);
  std::string text = to_string(model.family) + ", orders " + std::to_string(order.f11) + "," +
                     std::to_string(order.other) + ", wavelength power";
  text += model.powers == 0 ? " 0" : "s 0 to " + std::to_string(model.powers);
  return text + ", " + to_string(model.mapping) + " mapping: " + counted(mode_count(model), "mode") + ", " +
         counted(coefficient_count(model), "coefficient");
}

nlohmann::ordered_json basis_json(const Model& model) {
  const Orders order = orders(model);
  nlohmann::ordered_json json{{"basis", to_string(model.family)}, {"orders", {order.f11, order.other}},
                              {"powers", model.powers},           {"mapping", to_string(model.mapping)},
                              {"modes", mode_count(model)},       {"coefficients", coefficient_count(model)}};
  json["wavelengths_nm"] = nlohmann::ordered_json::array();
  for (const double wavelength : model.validity.wavelengths) {
    json["wavelengths_nm"].push_back(nanometres(wavelength));
  }
  return json;
}

std::vector<double> known_wavelengths(const Model& model) {
  if (!model.validity.wavelengths.empty()) {
    return model.validity.wavelengths;
  }
  if (!model.reflectance.wavelengths.empty()) {
    return model.reflectance.wavelengths;
  }
  return model.powers == 0 ? std::vector<double>{1} : std::vector<double>{};
}

std::string normal_reflectance_line(const Model& model) {
  std::string text;
  for (const double wavelength : known_wavelengths(model)) {
    text += (text.empty() ? "" : ", ") + format("%.6f", directional_hemispherical_reflectance(model, wavelength, {}));
    text += wavelength_unknown(model) ? "" : " at " + brief(nanometres(wavelength)) + " nm";
  }
  return text.empty() ? "not known, for the wavelengths are not" : text;
}

nlohmann::ordered_json normal_reflectance_json(const Model& model) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const double wavelength : known_wavelengths(model)) {
    nlohmann::ordered_json entry;
    entry["wavelength_nm"] = nullptr;
    if (!wavelength_unknown(model)) {
      entry["wavelength_nm"] = nanometres(wavelength);
    }
    entry["reflectance"] = directional_hemispherical_reflectance(model, wavelength, {});
    json.push_back(entry);
  }
  return json;
}

void print(const nlohmann::ordered_json& json) {
  const char* separator = "{\n";
  for (const auto& [name, value] : json.items()) {
    std::cout << separator << "  " << dumped(name) << ": " << by_lines(value);
    separator = ",\n";
  }
  std::cout << "\n}\n";
}

}  // namespace mmbrdf::program
