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
#include "mmbrdf/samples/simulation.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"
#include "options/arguments.hpp"
#include "options/files.hpp"
#include "pages/describe.hpp"
#include "pages/table.hpp"

namespace mmbrdf::program {

namespace {

struct Options {
  std::string first, second, output;
  std::optional<Grid> grid;
  std::optional<std::vector<double>> wavelengths_nm;
  SampleTable table;
  std::optional<double> theta_max_deg, tolerance;
  unsigned long seed = 0;
  Format format = Format::text;
  bool as_printed = false;
};

std::vector<double> wavelengths_of(const Model& first, const Model& second, const Options& options) {
  if (options.wavelengths_nm) return micrometres(*options.wavelengths_nm);
  std::vector<double> common = common_wavelengths(first, second);
  if (common.empty())
    throw WrongUsage("--wavelength is required", "there is none of which both models say that they were fitted to it");
  return common;
}

double theta_max(const Options& options) { return radians(options.theta_max_deg.value_or(90)); }

bool within(const Geometry& geometry, double theta) {
  constexpr double rounding = 1e-9;  // files give degrees
  return std::max(geometry.incident.theta, geometry.reflected.theta) <= theta + rounding;
}

/// How far random directions go: where both models were fitted, as far as that is known, and not beyond 75 degrees.
double random_theta_max(const Model& first, const Model& second, const Options& options) {
  if (options.theta_max_deg) return theta_max(options);
  double result = radians(75);
  for (const Validity& validity : {first.validity, second.validity})
    for (const std::optional<double>& theta : {validity.theta_i_max, validity.theta_r_max})
      result = std::min(result, theta.value_or(result));
  return result;
}

/// What the second model gives where the first is to be compared with it.
std::vector<Sample> samples_of(const Model& first, const Model& second, const Options& options) {
  const Grid grid = options.grid.value_or(Grid{});
  std::vector<Geometry> at =
      grid.random > 0 ? random_geometries(grid.random, options.seed, random_theta_max(first, second, options))
                      : geometries(grid, options.seed);
  std::erase_if(at, [&](const Geometry& g) { return !within(g, theta_max(options)); });
  if (!options.theta_max_deg) at = common_geometries(first, second, std::move(at));
  const std::vector<double> wavelengths = wavelengths_of(first, second, options);
  try {
    return simulate(second, wavelengths, at);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(base_name(options.second) + ": " + error.what());
  }
}

/// What the first model is compared with, and what to call it.
struct Second {
  std::vector<Sample> samples;
  std::string name;
  std::optional<std::array<Significance, 16>> significance = {};  ///< of two models whose uncertainties are known
};

/// Of samples, a fit as `mmbrdf fit` makes it by default.
Model model_of(const std::string& name, const Options& options) {
  if (!is_samples(name)) return open_model(name);
  try {
    return fit_sample(samples_at(name, options.wavelengths_nm, options.table)).model;
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(data_name(name) + ": " + error.what());
  }
}

std::optional<std::array<Significance, 16>> significance_of(const Model& first, const Model& second,
                                                            const std::vector<Sample>& samples) {
  if (!knows_uncertainty(first) || !knows_uncertainty(second)) return {};
  return significance(first, second, samples);
}

const char* if_printed(const Model& model) { return model.rotation == Rotation::as_printed ? " as printed" : ""; }

Second second_of(const Model& first, const Options& options) {
  if (is_samples(options.second) && !is_samples(options.first)) {
    if (options.grid)
      throw WrongUsage("--grid", "goes with two models; " + data_name(options.second) + " has its own geometries");
    std::vector<Sample> samples = samples_at(options.second, options.wavelengths_nm, options.table);
    std::erase_if(samples, [&](const Sample& s) { return !within(s.geometry, theta_max(options)); });
    return {std::move(samples), data_name(options.second)};
  }
  const Model second = model_of(options.second, options);
  std::vector<Sample> samples = samples_of(first, second, options);
  if (samples.empty() && !options.theta_max_deg)
    throw std::runtime_error("no direction is within the fitted ranges of both: give --theta-max");
  warn_if_outside(second, samples, data_name(options.second));
  auto found = significance_of(first, second, samples);
  return {std::move(samples), data_name(options.second) + if_printed(second), std::move(found)};
}

/// Wavelength in nm, and the four angles in degrees, of the largest difference.
std::array<double, 5> place(const Difference& d) {
  return {nanometres(d.wavelength), degrees(d.geometry.incident.theta), degrees(d.geometry.incident.phi),
          degrees(d.geometry.reflected.theta), degrees(d.geometry.reflected.phi)};
}

struct Report {
  std::string first, second;
  std::vector<double> wavelengths;
  const Comparison& comparison;
  const std::optional<std::array<Significance, 16>>& significance;
  Rotation rotation;
};

/// |difference| / u of each element, in a table of its own, or in columns behind the others.
std::vector<Column> significance_columns(unsigned where) {
  return {{.name = "mean_over_u", .format = "%12.2f", .heading = "mean |d|/u", .where = where},
          {.name = "largest_over_u", .format = "%14.2f", .heading = "largest |d|/u", .where = where},
          {.name = "within_95", .format = "%12.1f", .heading = "within 95 %", .where = where}};
}

void append(Table::Row& row, const std::optional<std::array<Significance, 16>>& all, std::size_t e, double unit) {
  if (all) row.insert(row.end(), {(*all)[e].mean, (*all)[e].largest, unit * (*all)[e].within});
}

std::string significance_text(const std::array<Significance, 16>& all) {
  Table table{{{"element", "%-8s"}, {"unit", "%-6s"}}};
  for (const Column& column : significance_columns(in_text)) table.columns.push_back(column);
  for (std::size_t e = 0; e < 16; ++e) {
    if (all[e].samples == 0) continue;
    Table::Row& row = table.rows.emplace_back(Table::Row{element_name(e), e == 0 ? "sr^-1" : "f11"});
    append(row, all, e, 100);
  }
  return "\nd / u, the fits being independent: 0.8 in the mean and 95 % within 1.96 if they differ by chance\n" +
         text(table);
}

Table table(const Comparison& comparison, const std::optional<std::array<Significance, 16>>& significance) {
  Table table{{{"element", "%-8s"},
               {"unit", "%-6s"},
               {"rms", "%11.6g"},
               {"mean", "%12.6g"},
               {"largest", "%12.6g"},
               {.name = "wavelength_nm", .format = "%7.6g", .heading = "at nm", .digits = shortest}}};
  for (const std::string angle : {"theta_i", "phi_i", "theta_r", "phi_r"})
    table.columns.push_back({.name = angle + "_deg", .format = "%8.2f", .heading = angle, .digits = shortest});
  if (significance)
    for (const Column& column : significance_columns(in_csv | in_json)) table.columns.push_back(column);
  const auto add = [&](std::size_t e, const std::string& unit, const Difference& d) {
    Table::Row& row = table.rows.emplace_back(Table::Row{element_name(e), unit});
    if (d.samples == 0) return;  // not measured
    row.insert(row.end(), {d.rms, d.mean, d.largest});
    std::ranges::copy(place(d), std::back_inserter(row));
    append(row, significance, e, 1);
  };
  add(0, "sr^-1", comparison.f11);
  add(0, "f11", comparison.f11_relative);
  for (std::size_t e = 1; e < 16; ++e) add(e, "f11", comparison.normalized[e]);
  return table;
}

std::string text(const Report& report) {
  const auto others = std::ranges::count_if(std::span(report.comparison.normalized).subspan(1),
                                            [](const Difference& d) { return d.samples > 0; });
  return report.second + " - " + report.first + (report.rotation == Rotation::as_printed ? " as printed" : "") + ": " +
         counted(report.comparison.samples, "sample") + " at " + nanometre_list(report.wavelengths) + ", frame xy\n\n" +
         text(table(report.comparison, report.significance)) +
         (report.significance ? significance_text(*report.significance) : "") +
         (others == 0 ? "\n"
                      : format("\n%-35s%.6g\n", ("rms of the " + std::to_string(others) + " others / f11").c_str(),
                               polarization_rms(report.comparison))) +
         format("largest difference / f11           %.6g\n", largest(report.comparison).largest);
}

std::string csv(const Report& report) {
  Table all = table(report.comparison, report.significance);
  all.rows.push_back({"polarization", "f11", polarization_rms(report.comparison)});
  return csv(all);
}

std::string json(const Report& report) {
  Json json{{"model", report.first}, {"compared_with", report.second},       {"rotation", to_string(report.rotation)},
            {"frame", "xy"},         {"samples", report.comparison.samples}, {"dark_samples", report.comparison.dark}};
  for (const double wavelength : report.wavelengths) json["wavelengths_nm"].push_back(nanometres(wavelength));
  json["elements"] = json_of(table(report.comparison, report.significance));
  json["rms_polarization"] = polarization_rms(report.comparison);
  json["largest"] = largest(report.comparison).largest;
  return printed(json);
}

void require_within(double tolerance, const Comparison& comparison) {
  const Difference most = largest(comparison);
  if (most.largest <= tolerance) return;
  const auto [nm, theta_i, phi_i, theta_r, phi_r] = place(most);
  throw std::runtime_error("the largest difference / f11, " + brief(most.largest) + " at " + brief(nm) +
                           " nm, incident " + brief(theta_i) + "," + brief(phi_i) + ", reflected " + brief(theta_r) +
                           "," + brief(phi_r) + ", is more than " + shortest(tolerance));
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

Comparison compared(const Model& first, const std::vector<Sample>& samples, const Options& options) {
  try {
    return compare(first, samples);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(base_name(options.first) + ": " + error.what());
  }
}

void compare_them(const Options& options) {
  require_valid(options);
  Model first = model_of(options.first, options);
  if (options.as_printed) {
    note_unless_printed(first, base_name(options.first));
    first = as_printed(std::move(first));
  }
  const auto [samples, second, significance] = second_of(first, options);
  if (samples.empty())
    throw std::invalid_argument("--theta-max " + shortest(*options.theta_max_deg) + ": no geometry is within");
  const Comparison comparison = compared(first, samples, options);
  const Report report{data_name(options.first), second, wavelengths(samples), comparison, significance, first.rotation};
  write_text(options.output, (options.format == Format::text  ? text
                              : options.format == Format::csv ? csv
                                                              : json)(report));
  if (comparison.dark > 0) warn(base_name(options.first) + ": " + dark_line(comparison));
  warn_if_outside(first, samples, base_name(options.first));
  if (options.tolerance) require_within(*options.tolerance, comparison);
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
    "fitted, on the published grid or at random directions, uniform in projected solid angle within 75 degrees, as "
    "far\n"
    "as both were fitted to these angles, unless --theta-max says otherwise. Of two files of samples each is fitted "
    "as\n"
    "mmbrdf fit does it by default, and the fits are compared. Where the uncertainties of both are known each\n"
    "difference is set beside its own, that of independent fits: mean and largest |d| / u, and how many are within\n"
    "1.96 u.\n"
    "\n"
    "Examples:\n"
    "  mmbrdf compare ptfe-532 data.csv --wavelength 532\n"
    "  mmbrdf compare ptfe new.json --grid random:10000 --tolerance 0.01";

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
  add_option(app, "--tolerance", o->tolerance, tolerance_from, "T",
             "Exit with status 1 if a difference / f11 is larger");
  add_file(app, "-o,--output", o->output, "OUT", "Where the table goes; - is standard output [-]");
  add_option(app, "--format", o->format, format_from, "FORMAT", "text, csv or json [text]");
  set_footer(app, footer);
  return [o] { compare_them(*o); };
}

}  // namespace mmbrdf::program
