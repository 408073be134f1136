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
#include "pages/output.hpp"

namespace mmbrdf::program {

namespace {

struct Options {
  std::string data;
  std::optional<std::vector<double>> wavelengths_nm;
  SampleTable table;
  Format format = Format::text;
};

std::string element_list(const Elements& elements) {
  std::vector<std::string> names;
  for (std::size_t e = 0; e < 16; ++e)
    if (elements[e]) names.push_back(element_name(e));
  return names.size() == 16 ? "all sixteen" : joined(names);
}

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

std::string sides_text(Sides sides) {
  if (sides == plane_of_incidence) return "in the plane of incidence only";
  if ((sides & negative_side) && (sides & positive_side)) return "on both sides of the plane of incidence";
  return "on one side of the plane of incidence";
}

bool have_uncertainties(const std::vector<Sample>& samples) {
  return std::ranges::all_of(samples, [](const Sample& s) { return has_uncertainty(s); });
}

/// The command that fits the file as it was read here.
std::string next_command(const Options& options, const CommandLine& line) {
  std::string text = line.text({options.data});
  const std::size_t at = text.find("inspect");
  text.replace(at, std::string("inspect").size(), "fit");
  if (const std::size_t format = text.find(" --format"); format != std::string::npos) {
    const std::size_t end = text.find(' ', format + std::string(" --format ").size());
    text.erase(format, end == std::string::npos ? end : end - format);
  }
  return text + " -o model.json";
}

nlohmann::ordered_json facts(const Inspection& seen, const std::vector<Sample>& samples, const std::string& name) {
  const Elements missing = not_measured(samples);
  const Angles incident = angles(samples, &Geometry::incident), reflected = angles(samples, &Geometry::reflected);
  nlohmann::ordered_json json{{"data", name}, {"samples", samples.size()}};
  for (const double wavelength : wavelengths(samples)) json["wavelengths_nm"].push_back(in_nanometres(wavelength));
  for (std::size_t e = 0; e < 16; ++e)
    if (!missing[e]) json["elements"].push_back(element_name(e));
  json["uncertainties"] = have_uncertainties(samples);
  json["theta_i_deg"] = {incident.smallest, incident.largest};
  json["theta_r_deg"] = {reflected.smallest, reflected.largest};
  json["sides"] = sides_text(seen.sides);
  json["unsupported"] = seen.unsupported;
  json["hole"] = seen.hole;
  json["f11_residual"] = seen.f11_residual;
  json["findings"] = nlohmann::ordered_json::array();
  for (const Finding& one : seen.findings)
    json["findings"].push_back({{"fault", one.fault}, {"evidence", one.evidence}, {"remedy", one.remedy}});
  return json;
}

void print_text(const Inspection& seen, const std::vector<Sample>& samples, const Options& options,
                const CommandLine& line) {
  const auto row = [](const char* name, const std::string& text) {
    std::cout << format("%-13s", name) << text << '\n';
  };
  const auto span = [](const Angles& a) { return format("%.4g ... %.4g degrees", a.smallest, a.largest); };
  std::cout << printable(data_name(options.data), longest_text) << ": "
            << counted(static_cast<long>(samples.size()), "sample") << " at " << nanometre_list(wavelengths(samples))
            << "\n\n";
  row("elements", element_list(~not_measured(samples)) +
                      (have_uncertainties(samples) ? ", with their uncertainties" : ", without uncertainties"));
  row("theta_i", span(angles(samples, &Geometry::incident)));
  row("theta_r", span(angles(samples, &Geometry::reflected)) + ", " + sides_text(seen.sides));
  row("covered", format("%.0f %% of the pairs of directions within these angles", 100 * (1 - seen.unsupported)));
  if (!seen.hole.empty()) row("", seen.hole);
  if (seen.f11_residual > 0)
    row("residual", format("%.2g %% of f11: noise, and what a fit of low order misses", 100 * seen.f11_residual));
  std::cout << '\n';
  for (const Finding& one : seen.findings) std::cout << printable(to_string(one), 4 * longest_text) << '\n';
  if (seen.findings.empty()) std::cout << "nothing seems to be wrong\n";
  std::cout << '\n' << next_command(options, line) << '\n';
}

void inspect_data(const Options& options, const CommandLine& line) {
  const std::vector<Sample> samples = samples_at(options.data, options.wavelengths_nm, options.table);
  const Inspection seen = inspect(samples);
  if (options.format == Format::json)
    std::cout << printed(facts(seen, samples, data_name(options.data)));
  else
    print_text(seen, samples, options, line);
}

Format inspect_format_from(const std::string& name) {
  if (name == "text") return Format::text;
  if (name == "json") return Format::json;
  throw std::invalid_argument("\"" + name + "\": expected text or json");
}

constexpr const char* footer =
    "Looks at the samples before they are fitted, and names what they betray, each with its evidence and what mends "
    "it:\n"
    "fill values, elements that are not divided by f11, matrices that cannot exist, columns of zeros, repeated rows,\n"
    "wavelengths beyond 0.1 ... 20 um; by fits of low order to the samples of the first wavelength a reflectance "
    "above\n"
    "1, a cosine too many or too few, folded azimuths, and another frame or other signs. mmbrdf fit warns of the "
    "same.\n"
    "Ends with the command that fits the file.\n"
    "\n"
    "Example:\n"
    "  mmbrdf inspect data.csv";

}  // namespace

Run inspect_command(CLI::App& app, const CommandLine& line) {
  const auto o = std::make_shared<Options>();
  add_file(app, "DATA.csv", o->data, " ", "Samples; - is standard input").required();
  add_option(app, "-w,--wavelength", o->wavelengths_nm, numbers, "NM[,NM...]", "Only these wavelengths, in nm");
  add_table_options(app, o->table);
  add_option(app, "--format", o->format, inspect_format_from, "FORMAT", "text or json [text]");
  set_footer(app, footer);
  return [o, line] { inspect_data(*o, line); };
}

}  // namespace mmbrdf::program
