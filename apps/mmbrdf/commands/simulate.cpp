// SPDX-License-Identifier: BSD-3-Clause
// mmbrdf simulate

#include <cmath>
#include <memory>

#include "command.hpp"
#include "mmbrdf/files/samples_file.hpp"
#include "mmbrdf/polarimetry/goniometer.hpp"
#include "mmbrdf/samples/simulation.hpp"
#include "options/arguments.hpp"
#include "options/files.hpp"
#include "options/polarimetry.hpp"
#include "pages/describe.hpp"

namespace mmbrdf::program {

namespace {

struct Options {
  std::string model, output, raw;
  Grid grid;
  std::optional<std::vector<double>> wavelengths_nm;
  double speckle = 0;
  std::optional<double> reading_noise;
  std::optional<TurningRetarders> retarders;
  std::optional<std::size_t> frames;
  unsigned long seed = 0;
};

double speckle_from(const std::string& text) {
  const std::string prefix = "speckle:";
  if (text == "none") return 0;
  if (!text.starts_with(prefix)) throw std::invalid_argument("\"" + text + "\": expected speckle:C or none");
  const double value = number(text.substr(prefix.size()));
  if (value < 0) throw std::invalid_argument("\"" + text + "\": expected 0 or more");
  return value;
}

std::vector<double> wavelengths_of(const Model& model, const Options& options) {
  if (options.wavelengths_nm) return micrometres(*options.wavelengths_nm);
  if (model.validity.wavelengths.empty())
    throw WrongUsage("--wavelength is required", options.model + " does not say to which it was fitted");
  return model.validity.wavelengths;
}

std::vector<Sample> simulated(const Model& model, const std::vector<double>& wavelengths, const Options& options) {
  try {
    return simulate(model, wavelengths, geometries(options.grid, options.seed), options.speckle, options.seed);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(base_name(options.model) + ": " + error.what());
  }
}

double relative_noise_from(const std::string& text) {
  const ReadingNoise noise = noise_from(text);
  if (noise.dark > 0 || noise.shot > 0) throw std::invalid_argument("\"" + text + "\": expected relative:Z");
  return noise.relative;
}

std::size_t frames_from(const std::string& text) {
  const double value = number(text);
  if (value != std::floor(value) || value < 1 || value > double(most_states))
    throw std::invalid_argument("\"" + text + "\": expected a whole number from 1 to " + std::to_string(most_states));
  return static_cast<std::size_t>(value);
}

/// Of a reading, which is never negative.
void require_possible(double noise, const std::string& option, const std::string& law) {
  if (noise > most_noise) {
    throw WrongUsage(option, law + ":" + shortest(noise) + " is more than a reading can have: at most " + law + ":" +
                                 shortest(most_noise));
  }
}

void simulate_readings(const Options& options) {
  const Model model = open_model(options.model);
  const std::vector<double> wavelengths = wavelengths_of(model, options);
  if (wavelengths.size() != 1)
    throw WrongUsage("--raw", "an instrument is of one wavelength: give one with --wavelength");
  RawSimulation raw{options.raw, RawSimulation{}.reading_noise, options.speckle, options.seed};
  raw.reading_noise = options.reading_noise.value_or(raw.reading_noise);
  raw.retarders = options.retarders;
  raw.frames = options.frames.value_or(raw.frames);
  require_possible(raw.speckle, "--noise", "speckle");
  require_possible(raw.reading_noise, "--reading-noise", "relative");
  require_kept(options.model, raw);
  std::vector<Sample> measured;
  for (const Geometry& geometry : geometries(options.grid, options.seed))
    measured.push_back({wavelengths[0], geometry, 1, identity()});
  try {
    simulate_raw(model, wavelengths[0], geometries(options.grid, options.seed), raw);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(base_name(options.model) + ": " + error.what());
  }
  warn_if_outside(model, measured, base_name(options.model));
}

void simulate_data(const Options& options) {
  require_model_kept(options.model, options.output);
  const Model model = open_model(options.model);
  const std::vector<Sample> samples = simulated(model, wavelengths_of(model, options), options);
  write_output(options.output, [&](std::ostream& out) { write_samples(out, samples); });
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
    "--raw writes what a goniometer with imperfections, four generator and four analyzer states would read:\n"
    "DIR/references.csv and DIR/raw.csv, for mmbrdf calibrate and reduce. speckle:C is then that of each reading, and\n"
    "both noises are factors of mean 1 that are never negative, of at most 1. With --retarders it is an instrument of\n"
    "two turning retarders (deviations of 3 degrees in retardance, 2 degrees in azimuth), read frame by frame.\n"
    "\n"
    "Examples:\n"
    "  mmbrdf simulate ptfe --grid germer2017 --noise speckle:0.006 --seed 1 -o data.csv\n"
    "  mmbrdf simulate ptfe --wavelength 532 --raw measured\n"
    "  mmbrdf simulate ptfe --wavelength 532 --retarders 1:5,6 --raw frames";

}  // namespace

Run simulate_command(CLI::App& app, const CommandLine&) {
  const auto o = std::make_shared<Options>();
  add_model(app, o->model);
  add_option(app, "--grid", o->grid, grid_from, "GRID", "germer2017 or random:N [germer2017]");
  add_option(app, "-w,--wavelength", o->wavelengths_nm, numbers, "NM[,NM...]",
             "Wavelengths in nm [those the model was fitted to]");
  add_option(app, "--noise", o->speckle, speckle_from, "NOISE", "speckle:C or none [none]");
  add_option(app, "--seed", o->seed, seed, "S", "Whole number that chooses the random ones [0]");
  add_file(app, "-o,--output", o->output, "DATA.csv", "Where the samples go; - is standard output [-]");
  const Option raw = add_output_file(app, "--raw", o->raw, "DIR", "Write readings of a polarimeter in this folder");
  raw.excludes("--output");
  add_option(app, "--reading-noise", o->reading_noise, relative_noise_from, "LAW",
             "Of the readings of --raw [relative:0.001]")
      .needs(raw);
  const Option retarders = add_retarders(app, o->retarders,
                                         "--raw of two turning retarders: the analyzer's\nturns RATIO times as far as "
                                         "the generator's, which\ndoes STEP degrees each frame; both have this\n"
                                         "retardance [90]");
  retarders.needs(raw);
  add_option(app, "--frames", o->frames, frames_from, "N", "Of them, at most 100 [61]").needs(retarders);
  set_footer(app, footer);
  return [o] { o->raw.empty() ? simulate_data(*o) : simulate_readings(*o); };
}

}  // namespace mmbrdf::program
