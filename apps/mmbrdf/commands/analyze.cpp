// SPDX-License-Identifier: BSD-3-Clause
// mmbrdf analyze: every quantity of a model at a geometry, with its uncertainty; or at many.

#include <iostream>
#include <memory>

#include "command.hpp"
#include "mmbrdf/model/description.hpp"
#include "mmbrdf/polarization/analysis.hpp"
#include "options/files.hpp"
#include "options/scan.hpp"
#include "options/terms.hpp"
#include "pages/analyze_report.hpp"
#include "pages/describe.hpp"
#include "pages/output.hpp"
#include "streams/npy.hpp"

namespace mmbrdf::program {

namespace {

struct Options : Question {
  std::vector<std::string> scan_texts;
  Terms terms;
  std::vector<Scan> scans;
  AnswerOptions asked;
  bool strict = false;
  std::optional<Format> format;
};

Stokes stokes_from(const std::string& text) {
  const std::vector<double> values = numbers(text);
  if (values.size() != 4) throw std::invalid_argument("\"" + text + "\": expected S1,S2,S3,S4");
  return {values[0], values[1], values[2], values[3]};
}

int draws_from(const std::string& text) {
  const int count = whole_number(text);
  constexpr int most = 100000;  // 1 GB
  constexpr int least = 100;    // fewer have no 95 % interval
  if (count < least || count > most)
    throw std::invalid_argument("\"" + text + "\": expected " + std::to_string(least) + " to " + std::to_string(most));
  return count;
}

void require_possible(const Stokes& light) {
  try {
    degree_of_polarization(light);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string("--stokes: ") + error.what());
  }
}

/// Draws and covariances may be refused, and are the model's: "name: …". Parts are for one question, not for many rows.
Answers answers_of(const Model& model, const Options& options, bool parts) {
  AnswerOptions asked = options.asked;
  asked.frame = options.frame;
  asked.parts = parts;
  try {
    const Answers answers(model, asked);
    if (!answers.unknown_uncertainty().empty()) warn("uncertainties are not known: " + answers.unknown_uncertainty());
    return answers;
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(base_name(options.model) + ": " + error.what());
  }
}

std::string written(const std::vector<AnalysisReport>& reports, Format format) {
  if (format == Format::json) {
    std::vector<Json> all;
    for (const AnalysisReport& report : reports) all.push_back(json_of(report));
    return printed_all(all);
  }
  Page page;
  for (const AnalysisReport& report : reports) {
    if (&report != &reports.front()) page.add("\n");
    page.add(page_of(report));
  }
  return page.written(format);
}

void analyze_one(Options options) {
  const Model model = model_of(options);
  complete_azimuths(options, model);
  const Answers answers = answers_of(model, options, true);
  const AddedColumns columns = analyzed_columns(answers, options.strict);
  const Geometry geometry = geometry_of(options);
  const bool csv = options.format == Format::csv;
  std::string rows = place_columns + columns.names + "\n";
  std::vector<AnalysisReport> reports;
  for (const std::optional<double>& wavelength_nm : wavelengths_asked(options)) {
    options.wavelength_nm = wavelength_nm;
    const double wavelength = wavelength_from(wavelength_nm, model);
    const Place place = place_of(model, options, wavelength);
    Outside here = inside;
    if (csv) {
      const AddedFields added = columns.fields(wavelength, {&geometry, 1}).front();
      rows += fields(place) + added.text + "\n";
      here = added.outside;
    } else {
      reports.push_back(
          {options, place, answers, answers.at(wavelength).at(geometry), options.terms.budget, options.terms.coverage});
      here = reports.back().answer.outside;
      if (options.strict) require_inside(here, model.validity);
    }
    warn_if_outside(place.model, here, model.validity);
  }
  std::cout << (csv ? rows : written(reports, options.format.value_or(Format::text)));
}

/// Rows of a scan that have one wavelength.
struct ScanRows {
  double wavelength = 0;
  std::vector<Geometry> geometries;
  std::vector<std::string> places;
};

/// From a row on; not all at once, so that they are written while there are more.
ScanRows scan_rows(const Model& model, const Options& options, long row) {
  constexpr std::size_t most = 256;
  ScanRows result;
  for (; row < row_count(options.scans) && result.places.size() < most; ++row) {
    const Question question = at_row(options.scans, options, row);
    const double wavelength = wavelength_from(question.wavelength_nm, model);
    if (!result.places.empty() && wavelength != result.wavelength) break;
    result.wavelength = wavelength;
    result.geometries.push_back(geometry_of(question));
    result.places.push_back(fields(place_of(model, question, wavelength)));
  }
  return result;
}

/// Counts the rows.
RangeCount write_scan(std::ostream& out, const Model& model, const Options& options, const AddedColumns& columns) {
  RangeCount range;
  RowWriter writer(out, place_columns + columns.names + "\n");
  for (long row = 0; out && row < row_count(options.scans);) {
    const ScanRows rows = scan_rows(model, options, row);
    const std::vector<AddedFields> added = columns.fields(rows.wavelength, rows.geometries);
    for (std::size_t i = 0; i < added.size(); ++i) {
      writer.text() += rows.places[i] + added[i].text;
      range.add(added[i].outside);
      writer.end_row();
    }
    row += static_cast<long>(added.size());
  }
  writer.flush();
  return range;
}

void analyze_scan(Options options) {
  if (options.wavelengths_nm && options.wavelengths_nm->size() > 1)
    options.scans.insert(options.scans.begin(), wavelength_scan(*options.wavelengths_nm));
  else if (options.wavelengths_nm)
    options.wavelength_nm = options.wavelengths_nm->front();
  require_complete(options.scans, options);
  require_model_kept(options.model, options.output);
  const Model model = model_of(options);
  complete_azimuths(options, model);
  wavelength_from(at_row(options.scans, options, 0).wavelength_nm, model);
  const Answers answers = answers_of(model, options, false);
  const AddedColumns columns = analyzed_columns(answers, options.strict);
  RangeCount range;
  write_output(options.output, [&](std::ostream& out) { range = write_scan(out, model, options, columns); });
  report_rows(range, unknown_range_line(base_name(options.model), model.validity));
}

void analyze_file(const Options& options) {
  const Model model = model_of_rows(options);
  const Answers answers = answers_of(model, options, false);
  evaluate_file(model, rows_of(options), with_columns(analyzed_columns(answers, options.strict)));
}

void analyze(Options& options) {
  if (is_npy(options.output)) throw WrongUsage("--output", "only evaluate writes .npy");
  const bool rows = !options.geometries.empty() || !options.scan_texts.empty();
  for (const std::string& text : options.scan_texts) options.scans.push_back(parsed("--scan", text, scan_from));
  options.asked.terms = terms_from(options.terms);
  if (rows && options.format && *options.format != Format::csv)
    throw WrongUsage("--format", "only csv goes with --geometries and --scan");
  if (options.terms.budget && (rows || options.format == Format::csv))
    throw WrongUsage("--budget", "goes with one geometry, as text, json or html");
  if (options.asked.light) require_possible(*options.asked.light);
  if (!rows && !options.output.empty()) throw WrongUsage("--output", "needs --geometries or --scan");
  if (!options.geometries.empty()) return analyze_file(options);
  if (!options.scans.empty()) return analyze_scan(options);
  require_directions(options, "--geometries, --scan");
  analyze_one(options);
}

constexpr const char* columns =
    "Columns behind those of the geometry: f11 ... f44 in sr^-1 in the frame asked for, validity and u_f11 ... u_f44 "
    "as\n"
    "for evaluate; then of the matrix in the frame sp, each with its standard uncertainty (k = 1) in u_NAME:\n";

constexpr const char* footer =
    "and realizable, 1 unless f11 or an eigenvalue is negative; estimable, 1 where the data of the fit determine "
    "every\n"
    "element. A field is empty where a quantity has no meaning (f11 is not positive), needs an\n"
    "element that was not measured, or its uncertainty is not known.\n"
    "\n"
    "A scan of theta_r without --reflected runs in the plane of incidence: forward (phi_r = phi_i + 180) for\n"
    "theta_r > 0, back towards the source for theta_r < 0.\n"
    "\n"
    "Uncertainties are those of the model, in first order, and of the terms. With --monte-carlo those of ratios and\n"
    "eigenvalues are from N draws of the coefficients and of the terms, with a 95 % interval, NAME_low to NAME_high.\n"
    "\n";

constexpr const char* examples =
    "\n"
    "Examples:\n"
    "  mmbrdf analyze ptfe -w 532 -i 45,0 -r 30,180 --term plaque:scale=0.3% --term theta_r=0.02deg\n"
    "  mmbrdf analyze ptfe -w 443,555,670 -i 45 -r 0 --term scale=0.3% --budget --coverage 2\n"
    "  mmbrdf analyze ptfe -w 532 -i 45 --scan theta_r=-75:75:1 -o scan.csv\n"
    "  mmbrdf analyze ptfe --geometries directions.csv --monte-carlo 1000 -o values.csv";

std::string quantity_lines() {
  std::string text;
  for (const Quantity& q : quantities())
    text += format("  %-24s", std::string(q.name).c_str()) + std::string(q.meaning) +
            (q.unit.empty() ? "" : ", in " + std::string(q.unit)) + (q.takes_light ? " (with --stokes)\n" : "\n");
  return text;
}

}  // namespace

Run analyze_command(CLI::App& app, const CommandLine&) {
  const auto o = std::make_shared<Options>();
  const QuestionOptions declared = add_question(app, *o, "Analyze");
  add_texts(app, "--scan", o->scan_texts, "VAR=FROM:TO:STEP",
            "Run through a range: theta_i, phi_i, theta_r, phi_r\nor wavelength; again: through all pairs")
      .excludes(declared.geometries);
  add_terms(app, o->terms);
  add_option(app, "--stokes", o->asked.light, stokes_from, "S1,S2,S3,S4",
             "Incident light, in the frame: adds what becomes of it");
  const Option draws = add_option(app, "--monte-carlo", o->asked.draws, draws_from, "N",
                                  "Uncertainties of ratios from N draws [first order]");
  add_option(app, "--seed", o->asked.seed, seed, "S", "Whole number that chooses the draws [0]").needs(draws);
  add_flag(app, "--strict", o->strict, "Refuse what is not known to be inside the fitted range");
  add_as_printed(app, *o);
  add_option(app, "--format", o->format, format_from, "FORMAT",
             "text, csv, json or html for one geometry [text]; csv for\nfiles and scans");
  set_footer(app, columns + quantity_lines() + footer + terms_help + examples);
  return [o] { analyze(*o); };
}

}  // namespace mmbrdf::program
