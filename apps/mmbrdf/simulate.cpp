// SPDX-License-Identifier: BSD-3-Clause
// mmbrdf simulate

#include <algorithm>
#include <iostream>
#include <memory>

#include "arguments.hpp"
#include "command.hpp"
#include "describe.hpp"
#include "files.hpp"
#include "mmbrdf/dataset.hpp"
#include "mmbrdf/io.hpp"
#include "mmbrdf/simulation.hpp"

namespace mmbrdf::program {

namespace {

struct Grid {
  int random = 0;  ///< number of random pairs of directions; 0: the published grid
};

struct Options {
  std::string model, output;
  std::optional<Grid> grid;
  std::optional<std::vector<double>> wavelengths_nm;
  double speckle = 0;
  unsigned long seed = 0;
};

Grid grid_from(const std::string& text) {
  if (text == "germer2017") {
    return {};
  }
  const std::string prefix = "random:";
  if (!text.starts_with(prefix)) {
    throw std::invalid_argument("\"" + text + "\": expected germer2017 or random:N");
  }
  const int count = whole_number(text.substr(prefix.size()));
  if (count == 0) {
    throw std::invalid_argument("\"" + text + "\": expected at least 1");
  }
  return {count};
}

double speckle_from(const std::string& text) {
  const std::string prefix = "speckle:";
  if (text == "none") {
    return 0;
  }
  if (!text.starts_with(prefix)) {
    throw std::invalid_argument("\"" + text + "\": expected speckle:C or none");
  }
  const double value = number(text.substr(prefix.size()));
  if (value < 0) {
    throw std::invalid_argument("\"" + text + "\": expected 0 or more");
  }
  return value;
}

std::vector<double> wavelengths_of(const Model& model, const Options& options) {
  if (options.wavelengths_nm) {
    return micrometres(*options.wavelengths_nm);
  }
  if (model.validity.wavelengths.empty()) {
    throw CLI::ValidationError("--wavelength is required", options.model + " does not say to which it was fitted");
  }
  return model.validity.wavelengths;
}

void warn_if_outside(const Model& model, const std::vector<Sample>& samples, const std::string& name) {
  const auto leaves = [&](const Sample& s) {
    return leaves_known_range(outside(model.validity, s.wavelength, s.geometry));
  };
  const auto count = std::count_if(samples.begin(), samples.end(), leaves);
  if (count > 0) {
    warn(std::to_string(count) + " of " + counted(static_cast<long>(samples.size()), "sample") +
         (count == 1 ? " lies" : " lie") + " outside the fitted range: fitted are " + fitted_range(model.validity));
  }
  const std::string unknown = unknown_range_line(name, model.validity);
  if (!unknown.empty()) {
    note(unknown);
  }
}

std::vector<Sample> simulated(const Model& model, const std::vector<double>& wavelengths, const Options& options) {
  const std::vector<Geometry> geometries =
      options.grid->random > 0 ? random_geometries(options.grid->random, options.seed) : germer2017_grid();
  try {
    return simulate(model, wavelengths, geometries, options.speckle, options.seed);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(base_name(options.model) + ": " + plain_message(error));
  }
}

void simulate_data(const Options& options) {
  require_model_kept(options.model, options.output);
  const Model model = open_model(options.model);
  const std::vector<Sample> samples = simulated(model, wavelengths_of(model, options), options);
  if (is_standard_output(options.output)) {
    write_samples(std::cout, samples);
  } else {
    write_samples(options.output, samples);
  }
  warn_if_outside(model, samples, base_name(options.model));
}

constexpr const char* footer =
    "The columns are wavelength_nm, theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg, f11 (in sr^-1), m12 ... m44\n"
    "(divided by f11), in the frame xy. The grid germer2017 is that of the published measurement, 1824 geometries;\n"
    "random:N are N pairs of directions, uniform in projected solid angle within 75 degrees. Each wavelength has the\n"
    "same geometries.\n"
    "\n"
    "speckle:C is Gaussian noise of standard deviation C sqrt(cos(theta_i)/cos(theta_r)), relative for f11 and\n"
    "absolute for m_ij. The same seed gives the same file.\n"
    "\n"
    "Example:\n"
    "  mmbrdf simulate ptfe --grid germer2017 --noise speckle:0.006 --seed 1 -o data.csv";

}  // namespace

Run simulate_command(CLI::App& app, const CommandLine&) {
  const auto o = std::make_shared<Options>();
  add_model(app, o->model);
  add_option(app, "--grid", o->grid, grid_from, "GRID", "germer2017 or random:N (required)")->required();
  add_option(app, "-w,--wavelength", o->wavelengths_nm, numbers, "NM[,NM...]",
             "Wavelengths in nm [those the model was fitted to]");
  add_option(app, "--noise", o->speckle, speckle_from, "NOISE", "speckle:C or none [none]");
  add_option(app, "--seed", o->seed, seed, "S", "Whole number that chooses the random ones [0]");
  add_file(app, "-o,--output", o->output, "DATA.csv", "Where the samples go; - is standard output [-]");
  app.footer(footer);
  return [o] { simulate_data(*o); };
}

}  // namespace mmbrdf::program
