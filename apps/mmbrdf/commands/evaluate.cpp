// SPDX-License-Identifier: BSD-3-Clause
// mmbrdf evaluate: one geometry from the command line; a file of geometries is evaluate_file.cpp.

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "command.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "options/files.hpp"
#include "options/question.hpp"
#include "options/terms.hpp"
#include "pages/budget.hpp"
#include "pages/describe.hpp"
#include "pages/output.hpp"
#include "streams/evaluate_file.hpp"
#include "streams/npy.hpp"

namespace mmbrdf::program {

namespace {

struct Options : Question {
  std::optional<Format> format;
  bool normalized = false, uncertainty = false;
  Terms terms;
  int threads = 0;  // 0: as many as there are
};

/// One evaluated geometry, with what is printed about it.
struct Evaluation {
  const Options& options;
  Place place;
  Mueller mueller;  // element 11 is f11 even if normalized
  Outside outside;
  std::optional<Mueller> uncertainty;  // of what is in mueller
  std::string uncertain;               // what that is of, a line
  std::vector<BudgetLine> budgets;
};

/// Whether uncertainties are asked for, by whatever option.
bool wants_uncertainty(const Options& options) {
  return options.uncertainty || options.terms.budget || !options.terms.texts.empty();
}

/// Of each element that has an uncertainty, as it is shown.
std::vector<BudgetLine> budget_lines(const Options& options, const Budget& all, const Mueller& f) {
  std::vector<BudgetLine> lines;
  for (std::size_t e = 0; e < 16; ++e) {
    if (std::isnan(f.elements[e])) continue;  // not measured
    const bool divided = options.normalized && e > 0;
    Mueller slope;
    slope.elements[e] = divided ? 1 / f(0, 0) : 1;
    if (divided) slope(0, 0) = -f.elements[e] / (f(0, 0) * f(0, 0));
    BudgetLine line{(divided ? "m" : "f") + element_name(e), divided ? f.elements[e] / f(0, 0) : f.elements[e],
                    expanded(contributions(all, slope))};
    if (without_rounding(line.uncertainty.uncertainty) > 0) lines.push_back(std::move(line));
  }
  return lines;
}

void add_uncertainty(Evaluation& answer, const Model& model, const PreparedModel& prepared, const Geometry& geometry) {
  const Options& options = answer.options;
  if (!knows_uncertainty(model))
    throw std::runtime_error(base_name(options.model) + ": no covariance, no --uncertainty, --term or --budget");
  const std::vector<TypeBTerm> terms = terms_from(options.terms);
  const Budget all =
      budget(prepared, prepare_uncertainty(model, prepared.wavelength()), terms, geometry, options.frame);
  const Mueller f = prepared.evaluate(geometry, options.frame);
  answer.uncertainty = standard_uncertainty(options.normalized ? normalized(all.total, f) : all.total);
  std::vector<std::string> names;
  for (const TypeBTerm& term : terms) names.push_back(term.name);
  answer.uncertain = uncertainty_line(uncertain_of(model), missing_from_uncertainty(model), names);
  if (options.terms.budget) answer.budgets = budget_lines(options, all, f);
}

Page page_of(const Evaluation& a) {
  Page page;
  page.add(heading(a.place) +
           (a.options.normalized ? "f11 in sr^-1, the other elements divided by it" : "Mueller BRDF in sr^-1") +
           ", frame " + to_string(a.options.frame) + " (" + convention_note(a.options.frame) + ")" +
           (a.place.rotation == Rotation::as_printed ? ", as printed" : "") + "\nvalidity: " + to_string(a.outside) +
           "\n" + matrix_text(a.mueller, a.uncertainty));
  if (a.uncertainty)
    page.add("its standard uncertainties\n" + matrix_text(*a.uncertainty, a.uncertainty) + a.uncertain);
  page.add(a.budgets.empty() ? "" : "\n");
  page.add(budget_page(a.budgets, a.options.terms.coverage));
  return page;
}

std::string csv_names(const Options& options) {
  std::string text = place_columns + element_columns(options.normalized) + ",validity";
  for (std::size_t e = 0; e < 16 && wants_uncertainty(options); ++e)
    text += (options.normalized && e > 0 ? ",u_m" : ",u_f") + element_name(e);
  return text + "\n";
}

std::string csv_line(const Evaluation& a) {
  std::string text = fields(a.place);
  append_elements(text, a.mueller);
  text += ',' + to_string(a.outside);
  if (a.uncertainty) append_elements(text, *a.uncertainty);
  return text + "\n";
}

Json json_of(const Evaluation& a) {
  Json json = to_json(a.place);
  add_frame(json, a.options.frame, a.place.rotation);
  json["unit"] = a.options.normalized ? "1" : "sr^-1";
  const bool normalized = a.options.normalized;
  if (normalized) {
    json["f11"] = a.mueller(0, 0);
    json["f11_unit"] = "sr^-1";
    if (a.uncertainty) json["u_f11"] = (*a.uncertainty)(0, 0);
  }
  Mueller m = a.mueller, u = a.uncertainty.value_or(Mueller{});
  m(0, 0) = normalized ? 1 : m(0, 0);
  u(0, 0) = normalized ? 0 : u(0, 0);
  json["mueller"] = matrix_json(m);
  if (a.uncertainty) json["u_mueller"] = matrix_json(u);
  json["validity"] = to_string(a.outside);
  for (const auto& [name, value, budget] : a.budgets)
    json["budgets"][name] = budget_json(budget, a.options.terms.coverage);
  return json;
}

/// Of one wavelength, or of several.
std::string written(const std::vector<Evaluation>& answers, const Options& options) {
  const Format format = options.format.value_or(Format::text);
  if (format == Format::csv) {
    std::string text = csv_names(options);
    for (const Evaluation& answer : answers) text += csv_line(answer);
    return text;
  }
  if (format == Format::json) {
    std::vector<Json> all;
    for (const Evaluation& answer : answers) all.push_back(json_of(answer));
    return printed_all(all);
  }
  Page page;
  for (const Evaluation& answer : answers) {
    if (&answer != &answers.front()) page.add("\n");
    page.add(page_of(answer));
  }
  return page.written(format);
}

/// At least two: one may wait for a disk while the other works.
int available_threads() { return std::max(2, static_cast<int>(std::thread::hardware_concurrency())); }

/// A limit of the address space (ulimit -v) must hold the stacks of all threads, and what they work with.
int most_threads() {
  rlimit space{}, stack{};
  if (::getrlimit(RLIMIT_AS, &space) != 0 || space.rlim_cur == RLIM_INFINITY) return std::numeric_limits<int>::max();
  constexpr rlim_t usual = 8 << 20;
  if (::getrlimit(RLIMIT_STACK, &stack) != 0 || stack.rlim_cur == RLIM_INFINITY) stack.rlim_cur = usual;
  return static_cast<int>(std::clamp<rlim_t>(space.rlim_cur / 2 / (stack.rlim_cur + usual), 1, 1 << 20));
}

void evaluate_one(Options options) {
  const Model model = model_of(options);
  complete_azimuths(options, model);
  const Geometry geometry = geometry_of(options);
  std::vector<Evaluation> answers;
  for (const std::optional<double>& wavelength_nm : wavelengths_asked(options)) {
    options.wavelength_nm = wavelength_nm;
    const PreparedModel prepared = prepare(model, wavelength_from(wavelength_nm, model));
    const Mueller f = prepared.evaluate(geometry, options.frame);
    Evaluation& answer = answers.emplace_back(Evaluation{.options = options,
                                                         .place = place_of(model, options, prepared.wavelength()),
                                                         .mueller = options.normalized ? normalized_beside_f11(f) : f,
                                                         .outside = prepared.outside(geometry),
                                                         .uncertainty = {},
                                                         .uncertain = {},
                                                         .budgets = {}});
    if (wants_uncertainty(options)) add_uncertainty(answer, model, prepared, geometry);
    warn_if_outside(answer.place.model, answer.outside, model.validity);
  }
  std::cout << written(answers, options);
}

void evaluate(const Options& options) {
  if (wants_uncertainty(options) && !options.geometries.empty())
    throw WrongUsage("--uncertainty, --term, --budget", "go with one geometry; analyze --geometries has u of each row");
  if (options.terms.budget && options.format == Format::csv)
    throw WrongUsage("--budget", "goes with text, json or html");
  if (options.geometries.empty()) {
    require_directions(options, "--geometries");
    return evaluate_one(options);
  }
  if (options.format && *options.format != Format::csv) throw WrongUsage("--format", "only csv goes with --geometries");
  const bool binary = is_npy(options.output);
  if (options.format && binary) throw WrongUsage("--format", "csv does not go with an output in .npy");
  const Model model = model_of_rows(options);
  Evaluated evaluated = evaluated_rows(model, options.frame, options.normalized, binary);
  evaluated.threads = std::min(options.threads > 0 ? options.threads : available_threads(), most_threads());
  evaluate_file(model, rows_of(options), evaluated);
}

const std::string footer =
    std::string(
        "The frame names the axes of the Stokes components: xy (those at the surface normal, carried along the "
        "meridian),\n"
        "sp (s and p of each beam), scattering_plane (perpendicular and parallel to the plane of both beams). S2 is\n"
        "y - x, s - p or perpendicular - parallel, S4 is left - right. A negative polar angle means the opposite "
        "azimuth:\n"
        "-45,0 is 45,180. The validity is ok; interpolated between fitted wavelengths; what lies outside the fitted\n"
        "range: theta_i, theta_r, wavelength, or directions that no samples support together; or unknown.\n"
        "\n"
        "Ten decimals are for what computes with them: they are those of the model, whatever is known of the sample. "
        "With\n"
        "--uncertainty, --term or --budget elements end at two digits of their standard uncertainty; csv and json are "
        "full.\n"
        "\n"
        "FILE.csv has a header line with wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg or the names of "
        "the\n"
        "published data; other columns are kept, those named as one of the output as input_NAME, lines that begin "
        "with\n"
        "# are not. An array of these five numbers for each row, .npy of numpy, is read too. Any number of rows takes "
        "the\n"
        "same memory. OUT.npy is an array (rows, 4, 4) without the validity, several times faster than text.\n"
        "\n") +
    terms_help +
    "\n"
    "Examples:\n"
    "  mmbrdf evaluate ptfe --wavelength 532 --incident 45,0 --reflected 30,180 --frame sp\n"
    "  mmbrdf evaluate ptfe -w 443,555,670 -i 45 -r 0 --uncertainty\n"
    "  mmbrdf evaluate ptfe --geometries directions.csv -o values.csv\n"
    "  mmbrdf evaluate ptfe --geometries directions.npy -o values.npy";

}  // namespace

Run evaluate_command(CLI::App& app, const CommandLine&) {
  const auto o = std::make_shared<Options>();
  const QuestionOptions declared = add_question(app, *o, "Evaluate");
  declared.output.needs(declared.geometries);
  add_flag(app, "--normalized", o->normalized, "f11 in sr^-1, and all others divided by it (m12 ... m44)");
  add_flag(app, "--uncertainty", o->uncertainty, "Print standard uncertainties, and elements to their place");
  add_terms(app, o->terms);
  add_as_printed(app, *o);
  add_option(app, "--threads", o->threads, thread_count, "N", "For the rows of a file [0: as many as there are cores]")
      .needs(declared.geometries);
  add_option(app, "--format", o->format, format_from, "FORMAT", "text, csv, json or html [text; csv for files]");
  set_footer(app, footer);
  return [o] { evaluate(*o); };
}

}  // namespace mmbrdf::program
