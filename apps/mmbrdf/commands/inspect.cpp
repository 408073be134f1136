// SPDX-License-Identifier: BSD-3-Clause
// mmbrdf inspect

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "command.hpp"
#include "mmbrdf/model/description.hpp"
#include "mmbrdf/quantities/fit_warnings.hpp"
#include "mmbrdf/text/units.hpp"
#include "options/arguments.hpp"
#include "options/files.hpp"
#include "pages/describe.hpp"
#include "pages/page.hpp"

namespace mmbrdf::program {

namespace {

struct Options {
  std::string data;
  std::optional<std::vector<double>> wavelengths_nm;
  SampleTable table;
  Format format = Format::text;
};

struct Angles {
  double smallest = 90, largest = 0;  // degrees
};

Angles angles(const std::vector<Sample>& samples, Direction Geometry::*direction) {
  Angles result;
  for (const Sample& sample : samples) {
    const double theta = degrees((sample.geometry.*direction).theta);
    result = {std::min(result.smallest, theta), std::max(result.largest, theta)};
  }
  return result;
}

nlohmann::ordered_json hole_json(const Hole& hole) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  const auto add = [&](const char* name, const std::optional<Hole::Degrees>& part) {
    if (part) json[name] = {part->from, part->to};
  };
  add("theta_i", hole.theta_i);
  add("theta_r", hole.theta_r);
  add("phi_r_phi_i", hole.phi);
  return json;
}

/// Without an option and its value.
CommandLine without_option(CommandLine line, const std::string& name) {
  std::vector<std::string>& words = line.words;
  if (const auto option = std::ranges::find(words, name); option != words.end())
    words.erase(option, std::next(option, std::min<std::ptrdiff_t>(2, words.end() - option)));
  std::erase_if(words, [&](const std::string& word) { return word.starts_with(name + "="); });
  return line;
}

/// The command that fits the file as it was read here, with options that mend it.
std::string next_command(const Inspection& seen, const CommandLine& line) {
  CommandLine next = without_option(line, "--format");
  *std::ranges::find(next.words, "inspect") = "fit";
  std::string options;
  for (const Finding& one : seen.findings)
    if (const std::string name = one.option.substr(0, one.option.find(' ')); !name.empty()) {
      next = without_option(next, name);
      options += " " + one.option;
    }
  return next.text({}) + options + " -o model.json";
}

std::vector<std::string> names_of(const Elements& elements) {
  std::vector<std::string> names;
  for (std::size_t e = 0; e < 16; ++e)
    if (elements[e]) names.push_back(element_name(e));
  return names;
}

nlohmann::ordered_json facts(const Inspection& seen, const std::vector<Sample>& samples, const std::string& name) {
  const Angles incident = angles(samples, &Geometry::incident), reflected = angles(samples, &Geometry::reflected);
  nlohmann::ordered_json json{{"data", name}, {"samples", samples.size()}};
  for (const double wavelength : wavelengths(samples)) json["wavelengths_nm"].push_back(in_nanometres(wavelength));
  json["elements"] = names_of(measured_elements(samples));
  for (const SamplesInFrame& here : by_own_frame(samples))
    json["frames"].push_back(
        {{"frame", to_string(here.frame)}, {"samples", here.samples}, {"elements", names_of(here.measured)}});
  json["uncertainties"] = std::ranges::all_of(samples, has_uncertainty, in_own_frame);
  json["theta_i_deg"] = {incident.smallest, incident.largest};
  json["theta_r_deg"] = {reflected.smallest, reflected.largest};
  json["sides"] = sides_line(seen.sides);
  json["unsupported"] = seen.unsupported;
  json["hole"] = seen.hole;
  json["hole_deg"] = hole_json(seen.hole_at);
  json["f11_residual"] = seen.f11_residual;
  json["findings"] = nlohmann::ordered_json::array();
  for (const Finding& one : seen.findings)
    json["findings"].push_back({{"fault", one.fault}, {"evidence", one.evidence}, {"remedy", one.remedy}});
  json["untested"] = nlohmann::ordered_json::array();
  for (const Untested& one : seen.untested) json["untested"].push_back({{"fault", one.fault}, {"reason", one.reason}});
  return json;
}

Page page_of(const Inspection& seen, const std::vector<Sample>& samples, const Options& options,
             const CommandLine& line) {
  std::string text = printable(data_name(options.data), longest_text) + ": " +
                     counted(static_cast<long>(samples.size()), "sample") + " at " +
                     nanometre_list(wavelengths(samples)) + "\n\n";
  for (const auto& [name, said] : inspection_rows(seen, samples)) text += format("%-13s", name.c_str()) + said + "\n";
  text += "\n";
  for (const Finding& one : seen.findings) text += printable(to_string(one), 4 * longest_text) + "\n";
  for (const Untested& one : seen.untested) text += printable(to_string(one), 4 * longest_text) + "\n";
  if (const std::string verdict = verdict_line(seen); !verdict.empty()) text += verdict + "\n";
  Page page;
  page.add(text + "\n" + next_command(seen, line) + "\n");
  return page;
}

void inspect_data(const Options& options, const CommandLine& line) {
  const std::vector<Sample> samples = samples_at(options.data, options.wavelengths_nm, options.table);
  const Inspection seen = inspect(samples);
  if (options.format == Format::json)
    std::cout << printed(facts(seen, samples, data_name(options.data)));
  else
    std::cout << page_of(seen, samples, options, line).written(options.format);
}

constexpr const char* footer =
    "Looks at the samples before they are fitted, and names what they betray, each with its evidence and what mends "
    "it:\n"
    "fill values, f11 below 0, elements that are not divided by f11, matrices that cannot exist, columns of zeros,\n"
    "repeated rows, wavelengths beyond 0.1 ... 20 um; by fits of low order to the samples of the first wavelength\n"
    "radians that are called degrees, a reflectance above 1, a cosine too many or too few, folded azimuths, and "
    "another\n"
    "frame or other signs. Of these it says which could not be seen in such data, and why. mmbrdf fit warns of most.\n"
    "Ends with the command that fits the file. The same with pictures: mmbrdf report DATA.csv -o PAGE.html or .pdf\n"
    "\n"
    "Example:\n"
    "  mmbrdf inspect data.csv";

}  // namespace

Run inspect_command(CLI::App& app, const CommandLine& line) {
  const auto o = std::make_shared<Options>();
  add_file(app, "DATA.csv", o->data, " ", "Samples; - is standard input").required();
  add_option(app, "-w,--wavelength", o->wavelengths_nm, numbers, "NM[,NM...]", "Only these wavelengths, in nm");
  add_table_options(app, o->table);
  add_option(app, "--format", o->format, format_without_csv, "FORMAT", "text, json or html [text]");
  set_footer(app, footer);
  return [o, line] { inspect_data(*o, line); };
}

}  // namespace mmbrdf::program
