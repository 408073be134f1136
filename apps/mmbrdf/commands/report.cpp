// SPDX-License-Identifier: BSD-3-Clause
// mmbrdf report: what the library reports on a model, as Markdown or JSON.

#include <algorithm>
#include <cctype>
#include <memory>

#include "command.hpp"
#include "mmbrdf/fitting/leverage.hpp"
#include "mmbrdf/quantities/report.hpp"
#include "mmbrdf/samples/mirror_pairs.hpp"
#include "options/arguments.hpp"
#include "options/files.hpp"
#include "pages/describe.hpp"
#include "pages/table.hpp"

namespace mmbrdf::program {

namespace {

struct Options {
  std::string model, data, output;
  std::optional<std::vector<double>> wavelengths_nm;
  SampleTable table;
  Format format = Format::text;
};

Format report_format_from(const std::string& name) {
  if (name == "markdown") return Format::text;
  if (name == "json") return Format::json;
  throw std::invalid_argument("\"" + name + "\": expected markdown or json");
}

/// A field of the report: prose, a list of lines, a table of names and values, or a table.
std::string section(const Json& value) {
  if (value.is_string()) return value.get<std::string>() + "\n";
  if (value.empty()) return "none\n";
  if (value.is_object() || value.front().is_object()) return markdown(table_of(value));
  std::string text;
  for (const Json& line : value) text += "- " + line.get<std::string>() + "\n";
  return text;
}

/// "mirror_pairs" is headed "Mirror pairs".
std::string heading(std::string name) {
  name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::string markdown(const Json& report) {
  std::string text = "# " + report["title"].get<std::string>() + "\n";
  for (const auto& [name, value] : report.items())
    if (name != "title") text += "\n## " + heading(name) + "\n\n" + section(value);
  return text;
}

void report(const Options& options) {
  require_model_kept(options.model, options.output);
  require_kept(options.data, options.output, "data");
  const Model model = open_model(options.model);
  const std::string name = base_name(options.model);
  if (!options.wavelengths_nm && known_wavelengths(model).empty())
    throw WrongUsage("--wavelength is required", name + " does not say to which wavelengths it was fitted");
  const std::vector<double> wavelengths = micrometres(options.wavelengths_nm.value_or(std::vector<double>{}));
  std::vector<Sample> samples;
  std::optional<ReportedSamples> data;
  if (!options.data.empty()) {
    samples = samples_at(options.data, options.wavelengths_nm, options.table);
    data = {data_name(options.data), samples};
  }
  const Json facts = Json::parse(report_json(model, name, wavelengths, data));
  if (options.format == Format::text) return write_text(options.output, markdown(facts));
  write_text(options.output, printed(facts));
}

constexpr const char* footer =
    "Says what the model was fitted from, where its range ends, whether it is physical on a grid of directions (steps "
    "of\n"
    "2.5 and 7.5 degrees), and its reflectances with standard uncertainties of the fit. With samples also: residuals "
    "by\n"
    "element, chi^2 where the samples have uncertainties, how they would fit in other frames and with other signs,\n"
    "what the data say against reciprocity, mirror symmetry and isotropy, their noise, and outliers.\n"
    "Warnings come first.\n"
    "\n"
    "Examples:\n"
    "  mmbrdf report ptfe-532\n"
    "  mmbrdf report sample.json data.csv -o report.md";

}  // namespace

Run report_command(CLI::App& app, const CommandLine&) {
  const auto o = std::make_shared<Options>();
  add_model(app, o->model);
  add_file(app, "DATA.csv", o->data, " ", "Samples to set beside it; - is standard input");
  add_option(app, "-w,--wavelength", o->wavelengths_nm, numbers, "NM[,NM...]",
             "Wavelengths in nm to report on [those that were fitted]");
  add_table_options(app, o->table);
  add_file(app, "-o,--output", o->output, "REPORT", "Where the report goes; - is standard output [-]");
  add_option(app, "--format", o->format, report_format_from, "FORMAT", "markdown or json [markdown]");
  set_footer(app, footer);
  return [o] { report(*o); };
}

}  // namespace mmbrdf::program
