// SPDX-License-Identifier: BSD-3-Clause
// mmbrdf compare

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

#include "command.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/model/description.hpp"
#include "mmbrdf/quantities/significance.hpp"
#include "mmbrdf/samples/comparison.hpp"
#include "mmbrdf/samples/matching.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"
#include "options/arguments.hpp"
#include "options/files.hpp"
#include "options/terms.hpp"
#include "pages/compare_report.hpp"
#include "pages/describe.hpp"

namespace mmbrdf::program {

namespace {

struct Options {
  std::string first, second, output;
  std::optional<Grid> grid;
  std::optional<std::vector<double>> wavelengths_nm;
  SampleTable table;
  std::optional<double> theta_max_deg, tolerance, match_deg;
  std::optional<Matching> partners;
  Terms terms;
  unsigned long seed = 0;
  Format format = Format::text;
  bool as_printed = false;
};

std::string none_in_common(const Model& first, const Model& second, const Options& options) {
  const std::string of_first = base_name(options.first), of_second = base_name(options.second);
  for (const auto& [model, name] : {std::pair(&first, of_first), std::pair(&second, of_second)})
    if (model->validity.wavelengths.empty()) return name + " does not say to which it was fitted";
  return of_first + " was fitted to " + nanometre_list(first.validity.wavelengths) + ", " + of_second + " to " +
         nanometre_list(second.validity.wavelengths);
}

std::vector<double> wavelengths_of(const Model& first, const Model& second, const Options& options) {
  if (options.wavelengths_nm) return micrometres(*options.wavelengths_nm);
  std::vector<double> common = common_wavelengths(first, second);
  if (common.empty()) throw WrongUsage("--wavelength is required", none_in_common(first, second, options));
  return common;
}

std::optional<double> theta_max(const Options& options) {
  return options.theta_max_deg ? std::optional(radians(*options.theta_max_deg)) : std::nullopt;
}

/// How far random directions go: where both models were fitted, as far as that is known, and not beyond 75 degrees.
double random_theta_max(const Model& first, const Model& second, const Options& options) {
  if (options.theta_max_deg) return *theta_max(options);
  double result = radians(75);
  for (const Validity& validity : {first.validity, second.validity})
    for (const std::optional<double>& theta : {validity.theta_i_max, validity.theta_r_max})
      result = std::min(result, theta.value_or(result));
  return result;
}

/// What the second model gives where the first is to be compared with it.
std::vector<Sample> samples_of(const Model& first, const Model& second, const Options& options) {
  const Grid grid = options.grid.value_or(Grid{});
  const std::vector<Geometry> at =
      grid.random > 0 ? random_geometries(grid.random, options.seed, random_theta_max(first, second, options))
                      : geometries(grid, options.seed);
  const std::vector<double> wavelengths = wavelengths_of(first, second, options);
  try {
    return samples_to_compare(first, second, wavelengths, at, theta_max(options));
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(base_name(options.second) + ": " + error.what());
  }
}

/// Of samples, a fit as `mmbrdf fit` makes it by default.
Model model_of(const std::string& name, const Options& options) {
  if (!is_samples(name)) return open_model(name);
  try {
    return fit_sample(samples_at(name, options.wavelengths_nm, options.table)).model;
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(data_name(name) + ": " + error.what() +
                             "; to set two files sample beside sample: --match");
  }
}

void require_some(const std::vector<Sample>& samples, const Options& options) {
  if (!samples.empty()) return;
  throw std::invalid_argument(options.theta_max_deg
                                  ? "--theta-max " + shortest(*options.theta_max_deg) + ": no geometry is within"
                                  : "no direction is within the fitted ranges of both: give --theta-max");
}

/// What u is of: "the model, the samples and scale, taken as independent"
std::string uncertain_words(std::vector<std::string> parts, const Options& options) {
  for (const TypeBTerm& term : terms_from(options.terms)) parts.push_back(term.name);
  const std::string last = parts.back();
  parts.pop_back();
  return "of " + (parts.empty() ? "" : joined(parts) + " and ") + last + ", taken as independent";
}

/// That of `name` is not known.
std::string unknown_words(const std::string& name, const Options& options) {
  if (!options.terms.texts.empty())
    throw WrongUsage("--term", "needs uncertainties of both, and those of " + name + " are not known");
  return "uncertainties of " + name + " are not known: differences are not set beside them";
}

const char* if_printed(const Model& model) { return model.rotation == Rotation::as_printed ? " as printed" : ""; }

/// Bad geometries are the model's.
void compare_with(const Model& first, const std::vector<Sample>& samples, CompareReport& report,
                  const Options& options) {
  try {
    report.comparison = compare(first, samples);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(base_name(options.first) + ": " + error.what());
  }
  report.wavelengths = wavelengths(samples);
  report.rotation = first.rotation;
}

/// A model and samples.
CompareReport with_samples(const Model& first, const Options& options) {
  const std::string name = data_name(options.second);
  if (options.grid) throw WrongUsage("--grid", "goes with two models; " + name + " has its own geometries");
  std::vector<Sample> samples = samples_at(options.second, options.wavelengths_nm, options.table);
  const std::size_t all = samples.size();
  const std::size_t left_out = leave_out_beyond(first, samples, theta_max(options));
  if (left_out > 0 && !options.theta_max_deg)
    note(std::to_string(left_out) + " of " + counted(static_cast<long>(all), "sample") + " beyond the fitted range, " +
         fitted_range(first.validity) + ", left out: --theta-max 90 takes all");
  require_some(samples, options);
  CompareReport report{.first = data_name(options.first), .second = name};
  compare_with(first, samples, report, options);
  if (!knows_uncertainty(first) || std::ranges::none_of(samples, has_uncertainty)) {
    report.uncertain = unknown_words(knows_uncertainty(first) ? name : report.first, options);
  } else {
    report.significance = significance(first, samples, terms_from(options.terms));
    report.uncertain = uncertain_words({"the model", "the samples"}, options);
  }
  warn_if_outside(first, samples, base_name(options.first));
  return report;
}

CompareReport with_model(const Model& first, const Options& options) {
  const Model second = model_of(options.second, options);
  const std::string name = data_name(options.second);
  const std::vector<Sample> samples = samples_of(first, second, options);
  require_some(samples, options);
  warn_if_outside(second, samples, name);
  CompareReport report{.first = data_name(options.first), .second = name + if_printed(second)};
  compare_with(first, samples, report, options);
  if (!knows_uncertainty(first) || !knows_uncertainty(second)) {
    report.uncertain = unknown_words(knows_uncertainty(first) ? name : report.first, options);
  } else {
    report.significance = significance(first, second, samples, terms_from(options.terms));
    report.uncertain = uncertain_words({"both models"}, options);
  }
  warn_if_outside(first, samples, base_name(options.first));
  return report;
}

std::string matched_words(const MatchedSamples& found, std::size_t all, const Options& options) {
  std::string text = "matched within " + shortest(*options.match_deg) +
                     " degrees: " + std::to_string(found.second.size()) + " of " +
                     counted(static_cast<long>(all), "sample") + " of " + data_name(options.second);
  if (found.images > 0) text += ", " + std::to_string(found.images) + " of them by an image";
  return text + "\n";
}

/// Two files of samples, row by row.
CompareReport matched_samples(const Options& options) {
  const std::string first = data_name(options.first), second = data_name(options.second);
  if (options.grid || options.as_printed || !options.terms.texts.empty())
    throw WrongUsage("--match", "samples beside samples have no --grid, --as-printed or --term");
  const auto read = [&](const std::string& name) {
    std::vector<Sample> samples = samples_at(name, options.wavelengths_nm, options.table);
    if (options.theta_max_deg) leave_out_beyond(*theta_max(options), samples);
    return samples;
  };
  const std::vector<Sample> of_second = read(options.second);
  Matching matching = options.partners.value_or(Matching{});
  matching.tolerance = radians(*options.match_deg);
  const MatchedSamples found = matched(read(options.first), of_second, matching);
  if (found.first.empty())
    throw std::runtime_error("no sample of " + second + " is within " + shortest(*options.match_deg) +
                             " degrees of one of " + first + ": without --match their fits are compared");
  CompareReport report{.first = first,
                       .second = second,
                       .wavelengths = wavelengths(found.second),
                       .comparison = compare(found.first, found.second),
                       .matched = matched_words(found, of_second.size(), options)};
  for (const auto& [samples, name] : {std::pair(&found.first, first), std::pair(&found.second, second)})
    if (std::ranges::none_of(*samples, has_uncertainty)) {
      report.uncertain = unknown_words(name, options);
      return report;
    }
  report.significance = significance(found.first, found.second);
  report.uncertain = uncertain_words({"both samples"}, options);
  return report;
}

CompareReport compared(const Options& options) {
  const bool first_samples = is_samples(options.first), second_samples = is_samples(options.second);
  if (options.match_deg) {
    if (!first_samples || !second_samples) throw WrongUsage("--match", "goes with two files of samples");
    return matched_samples(options);
  }
  if (first_samples && second_samples)
    note("both files are fitted, and the fits compared: --match sets sample beside sample");
  Model first = model_of(options.first, options);
  if (options.as_printed) {
    note_unless_printed(first, base_name(options.first));
    first = as_printed(std::move(first));
  }
  return second_samples && !first_samples ? with_samples(first, options) : with_model(first, options);
}

void require_within(double tolerance, const Comparison& comparison) {
  const Difference most = largest(comparison);
  if (most.largest <= tolerance) return;
  const auto [nm, theta_i, phi_i, theta_r, phi_r] = place(most);
  const std::string where = format(" nm, incident %.6g,%.6g, reflected %.6g,%.6g", theta_i, phi_i, theta_r, phi_r);
  throw std::runtime_error("the largest difference / f11, " + format("%.4g", most.largest) + " at " + brief(nm) +
                           where + ", is more than " + shortest(tolerance));
}

void require_valid(const Options& options) {
  if (options.theta_max_deg && !(*options.theta_max_deg > 0 && *options.theta_max_deg <= 90))
    throw std::invalid_argument("--theta-max " + shortest(*options.theta_max_deg) + ": must be in (0, 90] degrees");
  for (const std::string& name : {options.first, options.second})
    if (is_samples(name))
      require_kept(name, options.output, "data");
    else
      require_model_kept(name, options.output);
  if (is_samples(options.first) && !is_samples(options.second))
    throw std::invalid_argument(data_name(options.first) + ": samples; beside a model they are the second argument");
  if (options.first == "-" && options.second == "-")
    throw std::invalid_argument("standard input can be read once only");
}

void compare_them(const Options& options) {
  require_valid(options);
  const CompareReport report = compared(options);
  write_text(options.output, written(report, options.format));
  if (report.comparison.dark > 0) warn(base_name(options.first) + ": " + dark_line(report.comparison));
  if (options.tolerance) require_within(*options.tolerance, report.comparison);
}

/// mirror, reciprocal or both.
Matching partners_from(const std::string& text) {
  Matching result;
  for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 1) {
    end = text.find(',', begin);
    const std::string name = text.substr(begin, end == std::string::npos ? end : end - begin);
    if (name != "mirror" && name != "reciprocal")
      throw std::invalid_argument("\"" + name + "\": expected mirror, reciprocal or mirror,reciprocal");
    (name == "mirror" ? result.mirrored : result.exchanged) = true;
  }
  return result;
}

double tolerance_from(const std::string& text) {
  const double value = number(text);
  if (value < 0) throw std::invalid_argument("\"" + text + "\": expected 0 or more");
  return value;
}

constexpr const char* footer =
    "B is a model or a file of samples (see mmbrdf fit --help); - is samples from standard input. What is printed is\n"
    "B - A in the frame xy: f11 in sr^-1, f11 divided by that of A, and each of the other elements divided by f11 of\n"
    "its own. largest is without sign, and stands with the wavelength and the angles where it is.\n"
    "\n"
    "Samples are compared where they were taken. Two models are compared at the wavelengths to which both were\n"
    "fitted, on the published grid or at random directions, uniform in projected solid angle within 75 degrees. What\n"
    "lies beyond the fitted angles of a model is left out, unless --theta-max says how far to go. Of two files of\n"
    "samples each is fitted as mmbrdf fit does it by default, and the fits are compared; with --match each sample of "
    "B\n"
    "is set beside the nearest of A instead.\n"
    "\n"
    "Where the uncertainties of both are known each difference d is set beside its own, u, as if both were "
    "independent:\n"
    "the root mean square of d / u, the largest, and how many are beyond 2 u. A model and the samples that it was "
    "fitted\n"
    "to are not independent. --term adds an error that neither knows: KIND is scale (relative), theta_i, theta_r or\n"
    "azimuth (degrees), calibration (of each element divided by f11), each the same at all geometries.\n"
    "\n"
    "Examples:\n"
    "  mmbrdf compare ptfe-532 data.csv --wavelength 532\n"
    "  mmbrdf compare ptfe new.json --grid random:10000 --tolerance 0.01\n"
    "  mmbrdf compare ptfe sample.json --term scale=0.3%\n"
    "  mmbrdf compare monday.csv friday.csv --match 0.1 --partners mirror";

}  // namespace

Run compare_command(CLI::App& app, const CommandLine&) {
  const auto o = std::make_shared<Options>();
  add_model(app, o->first, "A").description("Built-in name, JSON model, coefficient CSV or samples (CSV)");
  add_model(app, o->second, "B").description("The same, or samples (CSV); - is standard input");
  add_option(app, "-w,--wavelength", o->wavelengths_nm, numbers, "NM[,NM...]",
             "Wavelengths in nm [those of the samples, or of both models]");
  add_table_options(app, o->table);
  add_option(app, "--grid", o->grid, grid_from, "GRID", "For two models: germer2017 or random:N [germer2017]");
  add_option(app, "--seed", o->seed, seed, "S", "Whole number that chooses the random directions [0]");
  add_option(app, "--theta-max", o->theta_max_deg, number, "DEG", "Only where both polar angles are at most this");
  add_flag(app, "--as-printed", o->as_printed,
           "Published coefficients of A: the sum at the azimuths\ngiven, not at phi_i = 0 and turned");
  const Option match = add_option(app, "--match", o->match_deg, positive_number, "DEG",
                                  "For two files of samples: compare those whose directions\nare within DEG degrees of "
                                  "each other");
  add_option(app, "--partners", o->partners, partners_from, "NAME[,NAME]",
             "Match also with the mirror image in the plane of\nincidence, the reciprocal geometry, or both: mirror,\n"
             "reciprocal")
      .needs(match);
  add_term(app, o->terms,
           "Add a standard uncertainty of the difference, as in\nscale=0.3%, theta_r=0.02deg; repeatable");
  add_option(app, "--tolerance", o->tolerance, tolerance_from, "T",
             "Exit with status 1 if a difference / f11 is larger");
  add_file(app, "-o,--output", o->output, "OUT", "Where the table goes; - is standard output [-]");
  add_option(app, "--format", o->format, format_from, "FORMAT", "text, csv, json or html [text]");
  set_footer(app, footer);
  return [o] { compare_them(*o); };
}

}  // namespace mmbrdf::program
