// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/files/model_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "files/json_field.hpp"
#include "files/posterior_json.hpp"
#include "mmbrdf/files/coefficients_file.hpp"
#include "mmbrdf/files/csv.hpp"
#include "mmbrdf/files/write_file.hpp"
#include "mmbrdf/text/units.hpp"
#include "text/base64.hpp"
#include "text/json_text.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr const char* model_format_name = "mmbrdf model";

/// What every file says, and must say to be read: there is no other convention that it could be in.
ordered_json model_conventions() {
  return {{"frame", "xy"},
          {"axes", "e1 = y, e2 = x, e1 x e2 = direction of propagation"},
          {"stokes", "germer2017"},
          {"s4", "left - right"},
          {"time_factor", "exp(-i omega t)"},
          {"phi_i", "azimuth of the direction to the source"},
          {"normalised", "f11 in sr^-1; other elements are f_ij/f11"}};
}
ordered_json model_units() {
  return {
      {"wavelength", "um"}, {"f11", "sr^-1"}, {"angles", "deg"}, {"coefficients", "of powers of the wavelength in um"}};
}

// ---- reading --------------------------------------------------------------------------------------------------------

Mode read_mode(const Field& field, Family family) {
  const std::vector<Field> items = field.items();
  if (items.size() != 5) field.refuse("must be [function, n, m, k, l]");
  const Mode mode{.function = checked(items[0], [&] { return function_from(items[0].text()); }),
                  .n = items[1].integer(),
                  .m = items[2].integer(),
                  .k = items[3].integer(),
                  .l = items[4].integer()};
  checked(field, [&] { require_valid(mode, family); });
  return mode;
}

Block read_block(const Field& field, Family family) {
  std::vector<Mode> modes;
  for (const Field& item : field["modes"].items()) modes.push_back(read_mode(item, family));
  std::vector<Block> canonical = checked(field["modes"], [&] { return blocks(family, modes); });
  if (canonical.size() != 1)
    field["modes"].refuse("must be the modes of one block, not of " + std::to_string(canonical.size()));
  for (std::size_t i = 0; i < modes.size(); ++i)
    if (modes[i] != canonical[0].modes[i])
      field["modes"].items()[i].refuse("out of order: mode " + to_string(canonical[0].modes[i]) + " comes here");
  if (field["elements"].text() != canonical[0].name)
    field["elements"].refuse(field["elements"].shown() + ", but the modes feed " + canonical[0].name);
  return std::move(canonical[0]);
}

FittedBlock read_fitted_block(const Field& field, Family family, int powers) {
  field.require_no_other_than(
      {"elements", "modes", "coefficients", "covariance", "rows", "rank", "condition", "null_space"});
  FittedBlock fitted;
  fitted.block = read_block(field, family);
  fitted.coefficients = field["coefficients"].numbers();
  const std::size_t modes = fitted.block.modes.size(), size = modes * static_cast<std::size_t>(powers + 1);
  require_count(field["coefficients"], fitted.coefficients.size(), size,
                std::to_string(powers + 1) + " for each of the " + std::to_string(modes) + " modes");
  if (field.has("covariance")) fitted.covariance = read_covariance(field["covariance"], size);
  if (field.has("rank")) fitted.rank = field["rank"].integer();
  if (field.has("null_space")) fitted.null_space = field["null_space"].numbers();
  if (field.has("condition")) fitted.condition = field["condition"].number();
  if (fitted.rank < 0 || static_cast<std::size_t>(fitted.rank) > size)
    field["rank"].refuse(std::to_string(fitted.rank) + " is not in 0..." + std::to_string(size));
  const std::size_t free = (size - static_cast<std::size_t>(fitted.rank)) * size;
  if (field.has("null_space"))
    require_count(field["null_space"], fitted.null_space.size(), free, "one combination for each that is free");
  if (field.has("rows")) {
    constexpr double most = 9e15;
    const double rows = field["rows"].number();
    if (!(rows >= 0 && rows <= most) || rows != std::floor(rows))
      field["rows"].refuse("must be a number of rows, not " + field["rows"].shown());
    fitted.rows = static_cast<long>(rows);
  }
  if (fitted.condition < 0) field["condition"].refuse(field["condition"].shown() + " is negative");
  return fitted;
}

std::vector<FittedBlock> read_blocks(const Field& field, Family family, int powers) {
  std::vector<FittedBlock> result;
  std::vector<Mode> modes;
  for (const Field& item : field.items()) {
    result.push_back(read_fitted_block(item, family, powers));
    modes.insert(modes.end(), result.back().block.modes.begin(), result.back().block.modes.end());
  }
  if (result.empty()) field.refuse("there is no block");
  const std::vector<Block> canonical = checked(field, [&] { return blocks(family, modes); });
  for (std::size_t b = 0; b < result.size(); ++b)
    if (b >= canonical.size() || result[b].block.name != canonical[b].name)
      field.items()[b].refuse("block " + result[b].block.name + " is out of order, or there are two of it");
  return result;
}

/// null: unknown.
std::optional<double> read_polar_angle(const Field& field) {
  if (field.is_null()) return {};
  const double value = field.number();
  if (value < 0 || value > 90) field.refuse(field.shown() + " degrees is not in 0...90");
  return radians(value);
}

SupportedPairs read_supported(const Field& field) {
  field.require_no_other_than({"wavelength_um", "pairs"});
  const auto bytes = from_base64(field["pairs"].text());
  if (!bytes) field["pairs"].refuse("is no base 64");
  return {field["wavelength_um"].number(), checked(field["pairs"], [&] { return DirectionPairs(*bytes); })};
}

Validity read_validity(const Field& field) {
  field.require_no_other_than({"wavelengths_um", "theta_i_max_deg", "theta_r_max_deg", "supported"});
  Validity validity{field["wavelengths_um"].numbers(), read_polar_angle(field["theta_i_max_deg"]),
                    read_polar_angle(field["theta_r_max_deg"])};
  if (field.has("supported"))
    for (const Field& one : field["supported"].items()) validity.supported.push_back(read_supported(one));
  double last = 0;
  for (const double wavelength : validity.wavelengths) {
    if (!(wavelength > last)) field["wavelengths_um"].refuse("must be positive and rise");
    last = wavelength;
  }
  return validity;
}

ReflectanceTable read_reflectance(const Field& field, std::size_t f11_coefficients) {
  field.require_no_other_than({"wavelengths_um", "values", "certified_theta_deg", "covariance", "covariance_with_f11"});
  ReflectanceTable table{field["wavelengths_um"].numbers(), field["values"].numbers()};
  if (table.wavelengths.empty()) field["wavelengths_um"].refuse("must not be empty");
  if (field.has("certified_theta_deg"))
    for (const double theta : field["certified_theta_deg"].numbers()) table.certified_theta.push_back(radians(theta));
  if (field.has("covariance")) {
    const std::size_t count = table.values.size();
    table.covariance = read_variances(field["covariance"], count);
    table.covariance_with_f11 = field["covariance_with_f11"].numbers();
    require_count(field["covariance_with_f11"], table.covariance_with_f11.size(), count * f11_coefficients,
                  std::to_string(f11_coefficients) + " for each value");
  } else if (field.has("covariance_with_f11")) {
    field["covariance_with_f11"].refuse("there is no covariance of the values beside it");
  }
  checked(field, [&] { require_valid(table); });
  return table;
}

Model read_model(const Field& root) {
  require_format(root, model_format_name, model_conventions(), model_units(),
                 {"format", "schema_version", "name", "basis", "orders", "powers", "mapping", "rotation", "conventions",
                  "units", "validity", "not_measured", "reflectance", "blocks", "posterior", "provenance"});
  Model model;
  model.name = root["name"].text();
  model.family = checked(root["basis"], [&] { return family_from(root["basis"].text()); });
  model.mapping = checked(root["mapping"], [&] { return disc_mapping_from(root["mapping"].text()); });
  if (root.has("rotation"))
    model.rotation = checked(root["rotation"], [&] {
      const Rotation rotation = rotation_from(root["rotation"].text());
      require_valid(model.family, rotation);
      return rotation;
    });
  model.powers = root["powers"].integer();
  if (model.powers < 0) root["powers"].refuse(root["powers"].shown() + " is negative");
  model.blocks = read_blocks(root["blocks"], model.family, model.powers);
  if (root.has("not_measured")) model.not_measured = read_elements(root["not_measured"]);
  const Orders found = orders(model);
  if (root["orders"].numbers() != std::vector<double>{double(found.f11), double(found.other)})
    root["orders"].refuse("must be [" + std::to_string(found.f11) + ", " + std::to_string(found.other) +
                          "], the highest orders among the modes");
  if (root.has("reflectance"))
    model.reflectance = read_reflectance(root["reflectance"], model.blocks.front().coefficients.size());
  model.validity = read_validity(root["validity"]);
  if (root.has("posterior")) model.posterior = read_posterior(root["posterior"], model.mapping, model.not_measured);
  model.provenance = root["provenance"].texts();
  checked(root, [&] { require_valid(model); });
  return model;
}

// ---- writing --------------------------------------------------------------------------------------------------------

void require_finite(const std::vector<double>& values, const std::string& what) {
  if (!std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }))
    throw std::invalid_argument(what + " must be finite");
}

ordered_json reflectance_json(const ReflectanceTable& table) {
  ordered_json result = {{"wavelengths_um", table.wavelengths}, {"values", table.values}};
  for (const double theta : table.certified_theta) result["certified_theta_deg"].push_back(in_degrees(theta));
  if (!table.covariance.empty()) {
    const std::size_t count = table.values.size();
    result["covariance"] =
        table.covariance.size() == count ? table.covariance : lower_triangle(table.covariance, count);
    result["covariance_with_f11"] = table.covariance_with_f11;
  }
  return result;
}

ordered_json block_json(const FittedBlock& fitted) {
  require_finite({fitted.condition}, "condition of block " + fitted.block.name);
  ordered_json result = {{"elements", fitted.block.name}, {"modes", ordered_json::array()}};
  for (const auto& [function, n, m, k, l] : fitted.block.modes)
    result["modes"].push_back({to_string(function), n, m, k, l});
  result["coefficients"] = fitted.coefficients;
  if (!fitted.covariance.empty()) result["covariance"] = lower_triangle(fitted.covariance, fitted.coefficients.size());
  if (fitted.rows > 0) result["rows"] = fitted.rows;
  if (fitted.rank > 0) result["rank"] = fitted.rank;
  if (fitted.condition > 0) result["condition"] = fitted.condition;
  if (!fitted.null_space.empty()) result["null_space"] = fitted.null_space;
  return result;
}

ordered_json angle_json(const std::optional<double>& angle) {
  return angle ? ordered_json(in_degrees(*angle)) : nullptr;
}

ordered_json model_json(const Model& model) {
  const Orders found = orders(model);
  ordered_json root = {
      {"format", model_format_name},         {"schema_version", schema_version},   {"name", model.name},
      {"basis", to_string(model.family)},    {"orders", {found.f11, found.other}}, {"powers", model.powers},
      {"mapping", to_string(model.mapping)}, {"conventions", model_conventions()}, {"units", model_units()}};
  if (model.rotation != Rotation::covariant) root["rotation"] = to_string(model.rotation);
  require_finite(model.validity.wavelengths, "wavelengths of the validity");
  root["validity"] = {{"wavelengths_um", model.validity.wavelengths},
                      {"theta_i_max_deg", angle_json(model.validity.theta_i_max)},
                      {"theta_r_max_deg", angle_json(model.validity.theta_r_max)}};
  for (const auto& [wavelength, pairs] : model.validity.supported)
    root["validity"]["supported"].push_back({{"wavelength_um", wavelength}, {"pairs", to_base64(pairs.bytes())}});
  if (!model.reflectance.wavelengths.empty()) root["reflectance"] = reflectance_json(model.reflectance);
  root["provenance"] = model.provenance;
  if (model.not_measured.any()) root["not_measured"] = elements_json(model.not_measured);
  root["blocks"] = ordered_json::array();
  for (const FittedBlock& fitted : model.blocks) root["blocks"].push_back(block_json(fitted));
  if (model.posterior) root["posterior"] = posterior_json(*model.posterior);
  return root;
}

void require_text(std::string_view piece, const std::string& path) {
  if (piece.find('\0') != std::string_view::npos) throw std::runtime_error(path + ": binary file, not a model");
}

// ---- formats --------------------------------------------------------------------------------------------------------

Model coefficients_from(std::string_view text, const std::string& name) {
  std::istringstream lines{std::string(text)};
  return read_coefficients(lines, name);
}

std::vector<std::string> beside_coefficients(const Model& model) {
  const Validity& validity = model.validity;
  std::vector<std::string> known;
  const auto add = [&known](bool there, const char* what) {
    if (there) known.emplace_back(what);
  };
  add(!validity.wavelengths.empty(), "the fitted wavelengths");
  add(validity.theta_i_max || validity.theta_r_max, "the fitted angles");
  add(traits(model.family).at_zero_azimuth && !turns(model), "how azimuths enter");
  add(has_covariance(model), "the covariance");
  add(model.provenance.contains("attribution"), "the attribution");
  add(!model.provenance.empty(), "the provenance");
  add(model.not_measured.any(), "which elements were not measured");
  add(!model.reflectance.values.empty(), "the reflectance that f11 is multiplied by");
  return known;
}

constexpr ModelFormat formats[] = {{".csv", '\0', coefficients_from, to_coefficients_csv, beside_coefficients},
                                   {"", '{', model_from_json, to_json, nullptr}};

}  // namespace

const ModelFormat& model_format(const std::string& path) {
  return *std::ranges::find_if(formats, [&](const ModelFormat& f) { return has_ending(path, f.ending); });
}

Model model_from_json(std::string_view text, const std::string& name) {
  const json root = parsed_json(text, name);
  return read_model(Field(root, name));
}

std::string to_json(const Model& model) {
  require_valid(model);
  try {
    return json_text(model_json(model));
  } catch (const json::exception& e) {  // text that is not UTF-8
    throw std::invalid_argument("name or provenance of the model: " + std::string(e.what()));
  }
}

std::string model_text(const std::string& path) {
  std::ifstream in = open_input(path);
  std::string text;
  std::vector<char> piece(1 << 16);
  while (in.read(piece.data(), static_cast<std::streamsize>(piece.size())) || in.gcount() > 0) {
    text.append(piece.data(), static_cast<std::size_t>(in.gcount()));
    require_text({piece.data(), static_cast<std::size_t>(in.gcount())}, path);
  }
  if (in.bad()) throw std::runtime_error(path + ": read error");
  return text;
}

Model load_model(const std::string& path) { return model_from_text(model_text(path), path); }

Model model_from_text(std::string_view text, const std::string& path) {
  require_text(text, path);
  const std::size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  if (first == std::string::npos) throw std::runtime_error(path + ": empty file, without a model");
  const ModelFormat* format = std::ranges::find(formats, text[first], &ModelFormat::first);
  if (format == std::end(formats)) format = std::ranges::find(formats, '\0', &ModelFormat::first);
  Model model = format->read(text, path);
  if (model.name.empty()) model.name = std::filesystem::path(path).stem().string();
  return model;
}

void save_model(const std::string& path, const Model& model) {
  const ModelFormat& format = model_format(path);
  const std::string text = format.write(model);
  require_readable([&] { format.read(text, path); });
  write_file(path, [&](std::ostream& out) { out << text; });
}

}  // namespace mmbrdf
