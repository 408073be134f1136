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
  bool normalized = false;
  Terms terms;
  int threads = 0;  // 0: as many as there are
};

/// One evaluated geometry, with what is printed about it.
struct Evaluation {
  const Options& options;
  Place place;
  Mueller mueller;  // element 11 is f11 even if normalized
  Outside outside;
  std::vector<BudgetLine> budgets;
};

/// Of each element that has an uncertainty, as it is shown.
std::vector<BudgetLine> budgets_of(const Options& options, const Model& model, const PreparedModel& prepared,
                                   const Geometry& geometry) {
  if (!options.terms.budget) return {};
  if (!knows_uncertainty(model)) throw std::runtime_error(base_name(options.model) + ": no covariance, no --budget");
  const Budget all = budget(prepared, prepare_uncertainty(model, prepared.wavelength()), terms_from(options.terms),
                            geometry, options.frame);
  const Mueller f = prepared.evaluate(geometry, options.frame);
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

void print_text(const Evaluation& a) {
  std::cout << heading(a.place)
            << (a.options.normalized ? "f11 in sr^-1, the other elements divided by it" : "Mueller BRDF in sr^-1")
            << ", frame " << to_string(a.options.frame) << " (" << convention_note(a.options.frame) << ")"
            << (a.place.rotation == Rotation::as_printed ? ", as printed" : "")
            << "\nvalidity: " << to_string(a.outside) << '\n'
            << matrix_text(a.mueller) << (a.budgets.empty() ? "" : "\n") << budget_text(a.budgets);
}

void print_csv(const Evaluation& a) {
  std::string text = place_columns + element_columns(a.options.normalized) + ",validity\n" + fields(a.place);
  append_elements(text, a.mueller);
  std::cout << text << ',' << to_string(a.outside) << '\n';
}

void print_json(const Evaluation& a) {
  nlohmann::ordered_json json = to_json(a.place);
  add_frame(json, a.options.frame, a.place.rotation);
  json["unit"] = a.options.normalized ? "1" : "sr^-1";
  if (a.options.normalized) {
    json["f11"] = a.mueller(0, 0);
    json["f11_unit"] = "sr^-1";
  }
  Mueller m = a.mueller;
  m(0, 0) = a.options.normalized ? 1 : m(0, 0);
  json["mueller"] = matrix_json(m);
  json["validity"] = to_string(a.outside);
  for (const auto& [name, value, u] : a.budgets) json["budgets"][name] = budget_json(u);
  print(json);
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

void evaluate_one(const Options& options) {
  const Model model = model_of(options);
  const double wavelength = wavelength_from(options.wavelength_nm, model);
  const Geometry geometry = geometry_of(options);
  const PreparedModel prepared = prepare(model, wavelength);
  const Mueller f = prepared.evaluate(geometry, options.frame);
  const Evaluation answer{.options = options,
                          .place = place_of(model, options, wavelength),
                          .mueller = options.normalized ? normalized_beside_f11(f) : f,
                          .outside = prepared.outside(geometry),
                          .budgets = budgets_of(options, model, prepared, geometry)};
  warn_if_outside(answer.place.model, answer.outside, model.validity);
  const Format form = options.format.value_or(Format::text);
  (form == Format::text ? print_text : form == Format::csv ? print_csv : print_json)(answer);
}

void evaluate(const Options& options) {
  if (!options.terms.texts.empty() && !options.terms.budget) throw WrongUsage("--term", "needs --budget");
  if (options.terms.budget && (!options.geometries.empty() || options.format == Format::csv))
    throw WrongUsage("--budget", "goes with one geometry, as text or json");
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
    "  mmbrdf evaluate ptfe --geometries directions.csv -o values.csv\n"
    "  mmbrdf evaluate ptfe --geometries directions.npy -o values.npy";

}  // namespace

Run evaluate_command(CLI::App& app, const CommandLine&) {
  const auto o = std::make_shared<Options>();
  const QuestionOptions declared = add_question(app, *o, "Evaluate");
  declared.output.needs(declared.geometries);
  add_flag(app, "--normalized", o->normalized, "f11 in sr^-1, and all others divided by it (m12 ... m44)");
  add_terms(app, o->terms);
  add_as_printed(app, *o);
  add_option(app, "--threads", o->threads, thread_count, "N", "For the rows of a file [0: as many as there are cores]")
      .needs(declared.geometries);
  add_option(app, "--format", o->format, format_from, "FORMAT", "text, csv or json [text; csv for files]");
  set_footer(app, footer);
  return [o] { evaluate(*o); };
}

}  // namespace mmbrdf::program
