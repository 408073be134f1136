// SPDX-License-Identifier: BSD-3-Clause
// mmbrdf info, mmbrdf materials

#include <algorithm>
#include <iostream>
#include <map>
#include <memory>

#include "command.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/model/description.hpp"
#include "options/arguments.hpp"
#include "options/files.hpp"
#include "pages/describe.hpp"
#include "pages/page.hpp"

namespace mmbrdf::program {

namespace {

struct Options {
  std::string model;
  Format format = Format::text;
};

constexpr const char* frame_line = "xy; element ij is f_ij / f11, but for 11";
constexpr const char* convention_line =
    "germer2017: S2 = y - x (s - p), S4 = left - right; phi_i is that of the direction to the source";
constexpr const char* unit_line = "f11 in sr^-1; inside, angles in radians and wavelengths in micrometres";

/// "u 8, v 22"
std::string functions_line(const Block& block) {
  std::map<Function, int> counts;
  for (const Mode& mode : block.modes) ++counts[mode.function];
  std::string text;
  for (const auto& [function, count] : counts)
    text += (text.empty() ? "" : ", ") + to_string(function) + " " + std::to_string(count);
  return text;
}

/// Rank and condition are 0 in JSON where they are not known.
Table blocks(const Model& model) {
  Table table{{{"block", "%-20s"},
               {"modes", "%-20s"},
               {"coefficients", "%12s"},
               {"rank", "%6s", "rank", in_text},
               {"condition", "%11.4g", "condition", in_text},
               {"rank", "", "", in_json},
               {"condition", "", "", in_json},
               {"covariance", " %s"}}};
  for (const FittedBlock& fitted : model.blocks)
    table.rows.push_back({fitted.block.name, functions_line(fitted.block), fitted.coefficients.size(),
                          fitted.rank > 0 ? Json(fitted.rank) : Json(),
                          fitted.condition > 0 ? Json(fitted.condition) : Json(), fitted.rank, fitted.condition,
                          model.posterior || !fitted.covariance.empty()});
  return table;
}

std::string line(const std::string& name, const std::string& value) {
  return format("%-12s ", printable(name, 100).c_str()) + printable(value, longest_text) + "\n";
}

Page page_of(const Model& model) {
  const Validity& validity = model.validity;
  Page page;
  page.add(line("name", model.name) + line("basis", basis_line(model)) +
           line("wavelengths", validity.wavelengths.empty() ? "not known" : nanometre_list(validity.wavelengths)) +
           line("angles", angles_line(validity)) +
           line("reflectance", model.reflectance.values.empty()
                                   ? "none: f11 is that of the coefficients"
                                   : "f11 is multiplied by " + reflectance_line(model.reflectance)) +
           line("DHR(0)", normal_reflectance_line(model)) + line("frame", frame_line) +
           line("convention", convention_line) + line("units", unit_line) + "\n");
  page.add(blocks(model));
  page.add(model.provenance.empty() ? "" : "\n");
  for (const auto& [key, value] : model.provenance) page.add(line(key, value));
  return page;
}

Json degrees_json(const std::optional<double>& angle) { return angle ? Json(degrees(*angle)) : Json(); }

void print_json(const Model& model) {
  Json json{{"name", model.name}};
  json.update(basis_json(model));
  json["theta_i_max_deg"] = degrees_json(model.validity.theta_i_max);
  json["theta_r_max_deg"] = degrees_json(model.validity.theta_r_max);
  json["reflectance"] = Json::array();
  for (std::size_t i = 0; i < model.reflectance.values.size(); ++i) {
    json["reflectance"].push_back(
        {{"wavelength_nm", nanometres(model.reflectance.wavelengths[i])}, {"value", model.reflectance.values[i]}});
  }
  json["reflectance_at_normal_incidence"] = normal_reflectance_json(model);
  json["frame"] = "xy";
  json["convention"] = "germer2017";
  json["unit_f11"] = "sr^-1";
  json["blocks"] = json_of(blocks(model));
  json["provenance"] = model.provenance;
  print(json);
}

void info(const Options& options) {
  const Model model = open_model(options.model);
  if (options.format == Format::json) return print_json(model);
  std::cout << page_of(model).written(options.format);
}

void list_materials() {
  Table table{{{"name", "%-11s"}, {"wavelengths", "%-24s"}, {"model"}}};
  for (const std::string& name : materials()) {
    const Model model = material(name);
    table.rows.push_back({name, nanometre_list(model.validity.wavelengths), basis_line(model)});
  }
  std::cout << text(table);
}

}  // namespace

Run info_command(CLI::App& app, const CommandLine&) {
  const auto o = std::make_shared<Options>();
  add_model(app, o->model);
  add_option(app, "--format", o->format, format_without_csv, "FORMAT", "text, json or html [text]");
  set_footer(
      app,
      "Angles are in degrees, wavelengths in nm, reflectances without unit. The last lines say where the model is "
      "from.\n"
      "\n"
      "Example:\n"
      "  mmbrdf info ptfe");
  return [o] { info(*o); };
}

Run materials_command(CLI::App& app, const CommandLine&) {
  set_footer(app,
             "Wavelengths are in nm. mmbrdf info NAME tells the rest.\n"
             "\n"
             "Example:\n"
             "  mmbrdf materials");
  return list_materials;
}

}  // namespace mmbrdf::program
