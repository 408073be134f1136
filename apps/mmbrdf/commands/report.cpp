// SPDX-License-Identifier: BSD-3-Clause
// mmbrdf report: what the library reports on a model, as Markdown or JSON, or as a page that Python makes.

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>

#include "command.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/quantities/report.hpp"
#include "mmbrdf/text/date.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"
#include "options/arguments.hpp"
#include "options/files.hpp"
#include "options/terms.hpp"
#include "pages/describe.hpp"
#include "pages/digest.hpp"
#include "pages/table.hpp"
#include "streams/python.hpp"

namespace mmbrdf::program {

namespace {

enum class Kind { markdown, json, html, pdf };

struct Options {
  std::string model, data, output;
  std::optional<std::vector<double>> wavelengths_nm;
  SampleTable table;
  Terms terms;
  std::optional<Kind> kind;
  ReportStyle style;
  bool letter = false;
};

Kind kind_from(const std::string& name) {
  if (name == "markdown") return Kind::markdown;
  if (name == "json") return Kind::json;
  if (name == "html") return Kind::html;
  if (name == "pdf") return Kind::pdf;
  throw std::invalid_argument("\"" + name + "\": expected markdown, html, pdf or json");
}

bool is_letter(const std::string& name) {
  if (name != "a4" && name != "letter") throw std::invalid_argument("\"" + name + "\": expected a4 or letter");
  return name == "letter";
}

/// By --format, or by the ending of the file; Markdown on standard output.
Kind kind_of(const Options& options) {
  if (options.kind) return *options.kind;
  if (is_standard_output(options.output)) return Kind::markdown;
  std::string ending = std::filesystem::path(options.output).extension();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ending == ".md") return Kind::markdown;
  if (ending == ".json") return Kind::json;
  if (ending == ".html" || ending == ".htm") return Kind::html;
  if (ending == ".pdf") return Kind::pdf;
  throw WrongUsage("--output " + options.output,
                   "expected a file that ends with .md, .html, .pdf or .json, or --format");
}

ReportOrigin origin_of(const Options& options, const CommandLine& line, const std::string& bytes_of_model,
                       const std::string& bytes_of_data) {
  ReportOrigin origin{utc_timestamp(), software(), line.text({options.model, options.data, options.output})};
  origin.model = shell_quoted(base_name(options.model));
  if (is_built_in(options.model))
    origin.files.push_back({"model", base_name(options.model) + " (built in)", ""});
  else
    origin.files.push_back({"model", base_name(options.model), sha256(bytes_of_model)});
  if (options.data.empty()) return origin;
  origin.data = shell_quoted(data_name(options.data)) + table_words(options.table);
  origin.files.push_back({"data", data_name(options.data), sha256(bytes_of_data)});
  return origin;
}

/// The facts for programs, and whence they are.
Json with_origin(Json facts, const ReportOrigin& origin) {
  Json files = Json::array();
  for (const auto& [what, name, digest] : origin.files)
    files.push_back({{"what", what}, {"name", name}, {"sha256", digest.empty() ? Json() : Json(digest)}});
  facts["origin"] = {
      {"date", origin.date}, {"software", origin.software}, {"command", origin.command}, {"files", files}};
  return facts;
}

/// With pictures: Python draws them, and says what is wrong with its words.
[[noreturn]] void report_by_python(const Options& options, const CommandLine& line) {
  if (options.data == "-") throw std::invalid_argument("-: a report with pictures takes data from a file");
  if (!is_samples(options.model)) open_model(options.model);  // whose messages are the program's
  if (!options.data.empty()) read_input(options.data, [](std::istream&, const std::string&) {});
  std::vector<std::string> words = line.words;
  words.erase(words.begin());
  words.erase(std::ranges::find(words, "report"));
  words.push_back("--made-by=" + line.text({options.model, options.data, options.output}));
  become_python("report", "mmbrdf._report", words);
}

void report(const Options& options, const CommandLine& line) {
  require_model_kept(options.model, options.output);
  require_kept(options.data, options.output, "data");
  const Kind kind = kind_of(options);
  const std::vector<TypeBTerm> terms = terms_from(options.terms);
  if (kind == Kind::html || kind == Kind::pdf) report_by_python(options, line);
  if (options.data.empty() && !is_built_in(options.model) && is_samples(options.model))
    throw std::invalid_argument(options.model + ": holds samples: mmbrdf inspect says what they are, and a report of " +
                                "them alone is a page, -o REPORT.html or .pdf");
  std::string bytes_of_model, bytes_of_data;
  const Model model = open_model(options.model, &bytes_of_model);
  const std::string name = base_name(options.model);
  if (!options.wavelengths_nm && known_wavelengths(model).empty())
    throw WrongUsage("--wavelength is required", name + " does not say to which wavelengths it was fitted");
  const std::vector<double> wavelengths = micrometres(options.wavelengths_nm.value_or(std::vector<double>{}));
  std::vector<Sample> samples;
  std::optional<ReportedSamples> data;
  if (!options.data.empty()) {
    samples = samples_at(options.data, options.wavelengths_nm, options.table, &bytes_of_data);
    data = {data_name(options.data), samples};
  }
  if (!terms.empty() && !knows_uncertainty(model))
    throw WrongUsage("--term", "needs an uncertainty to be added to, and that of " + name + " is not known");
  const std::string facts = report_json(model, name, wavelengths, data, terms);
  const ReportOrigin origin = origin_of(options, line, bytes_of_model, bytes_of_data);
  if (kind == Kind::json) return write_text(options.output, printed(with_origin(Json::parse(facts), origin)));
  write_text(options.output, report_markdown(report_document(model, facts, origin, options.style)));
}

constexpr const char* footer =
    "Says what the model was fitted from, where its range ends, its reflectances with standard uncertainties and "
    "their\n"
    "budgets (k = 2), and whether it is physical on a grid of directions (steps of 2.5 and 7.5 degrees). With samples "
    "also:\n"
    "residuals by element, chi^2 where the samples have uncertainties, how they would fit in other frames and with "
    "other\n"
    "signs, what they say against reciprocity, mirror symmetry and isotropy, their noise, and outliers. First comes a\n"
    "sentence with DHR(8), 0:45 and chi^2, then warnings, of the fitted range alone, then notes. Numbers have the "
    "digits\n"
    "that their uncertainties leave; .json has all. Date (SOURCE_DATE_EPOCH counts), files, SHA-256 and command are in "
    "it.\n"
    "\n"
    "--term adds an error to all u, with a row of its own in budgets: KIND is scale (relative), theta_i, theta_r or "
    "azimuth\n"
    "(degrees), calibration (of each element divided by f11), each the same at all geometries.\n"
    "\n"
    "The ending of REPORT says what it is: .md, .html, .pdf or .json. Pages with pictures, .html and .pdf, are made by "
    "the\n"
    "Python package with matplotlib (MMBRDF_PYTHON names the interpreter [python3]), and .pdf printed by Chromium\n"
    "(MMBRDF_BROWSER [chromium]). These may be of samples alone: mmbrdf report DATA.csv -o REPORT.pdf\n"
    "\n"
    "Examples:\n"
    "  mmbrdf report ptfe-532\n"
    "  mmbrdf report sample.json data.csv -o report.pdf";

}  // namespace

Run report_command(CLI::App& app, const CommandLine& line) {
  const auto o = std::make_shared<Options>();
  add_model(app, o->model);
  add_file(app, "DATA.csv", o->data, " ", "Samples to set beside it; - is standard input");
  add_option(app, "-w,--wavelength", o->wavelengths_nm, numbers, "NM[,NM...]",
             "Wavelengths in nm to report on [those that were fitted]");
  add_table_options(app, o->table);
  add_file(app, "-o,--output", o->output, "REPORT", "Where the report goes; - is standard output [-]");
  add_option(app, "--format", o->kind, kind_from, "FORMAT",
             "markdown, html, pdf or json, whatever the ending of\nREPORT [markdown]");
  add_term(app, o->terms,
           "Add a standard uncertainty that the fit cannot know, as in\nscale=0.3%, theta_r=0.02deg; repeatable");
  add_option(app, "--notation", o->style.notation, notation_from, "NAME",
             "brackets, as in 0.98412(32), or plus-minus, as in\n0.98412 ± 0.00032 [brackets]");
  add_option(app, "-i,--incident", o->style.theta_i_deg, number, "DEG", "Angle of incidence of the pictures [45]");
  add_option(app, "--paper", o->letter, is_letter, "NAME", "Of a PDF: a4 or letter [a4]");
  set_footer(app, footer);
  return [o, line] { report(*o, line); };
}

}  // namespace mmbrdf::program
