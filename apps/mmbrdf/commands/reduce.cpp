// SPDX-License-Identifier: BSD-3-Clause
// mmbrdf reduce

#include <cmath>
#include <iostream>
#include <memory>
#include <numbers>
#include <optional>

#include "command.hpp"
#include "mmbrdf/files/instrument_file.hpp"
#include "mmbrdf/files/readings_file.hpp"
#include "mmbrdf/files/samples_file.hpp"
#include "mmbrdf/model/description.hpp"
#include "mmbrdf/polarimetry/measurement.hpp"
#include "mmbrdf/polarization/analysis.hpp"
#include "options/arguments.hpp"
#include "options/files.hpp"
#include "options/polarimetry.hpp"
#include "pages/output.hpp"

namespace mmbrdf::program {

namespace {

struct Options {
  std::string raw, instrument, output;
  std::optional<double> solid_angle;
  double saturation = never_saturated;
  ReadingNoise noise{.dark = 0, .shot = 0, .relative = 1e-3};
  bool strict = false;
};

double solid_angle_from(const std::string& text) {
  const double value = positive_number(text);
  if (value > 2 * std::numbers::pi) throw std::invalid_argument("\"" + text + "\": expected at most 2 pi sr");
  return value;
}

std::vector<Sample> reduced_file(const Calibration& instrument, const Options& options) {
  const Polarimeter& p = instrument.polarimeter;
  const Reduction reduction(p);
  std::vector<Sample> samples;
  read_input(options.raw, [&](std::istream& in, const std::string& name) {
    RawReader reader(in, name, {p.generator.size(), p.analyzer.size()}, options.saturation);
    for (RawMeasurement raw; reader.next(raw);) {
      if (!same_wavelength(raw.wavelength, instrument.wavelength)) {
        throw reader.error("wavelength_nm: " + brief(nanometres(raw.wavelength)) + ", but the instrument is of " +
                           brief(nanometres(instrument.wavelength)) + " nm");
      }
      try {
        samples.push_back(reduced(reduction, raw, *options.solid_angle, options.noise));
      } catch (const std::invalid_argument& error) {
        throw reader.error(error.what());
      }
    }
  });
  return samples;
}

/// Warns of matrices that nothing can have, or refuses them.
void check_possible(const std::vector<Sample>& samples, const Options& options) {
  Verdict verdict = judged(samples);
  if (options.strict && !verdict.doubts.empty()) verdict = {{}, verdict.doubts[0]};
  heed(verdict, data_name(options.raw));
}

void reduce(const Options& options) {
  require_kept(options.raw, options.output, "readings");
  require_kept(options.instrument, options.output, "instrument");
  const Calibration instrument = load_instrument(options.instrument);
  heed(judged(instrument), base_name(options.instrument));
  const std::vector<Sample> samples = reduced_file(instrument, options);
  check_possible(samples, options);
  write_output(options.output, [&](std::ostream& out) { write_samples(out, samples); });
}

constexpr const char* footer =
    "RAW.csv has the columns wavelength_nm, theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg, number (the rows of one\n"
    "measurement are adjacent), generator_state, analyzer_state (from 1), intensity, and if need be dark, monitor,\n"
    "gain. DATA.csv has samples, with standard uncertainties from the noise of the readings in columns u_f11 ...\n"
    "u_m44. What the instrument is uncertain by is the same error in all samples and not in them: mmbrdf fit\n"
    "--instrument adds it. The solid angle is that of the receiver: f = M / (SR cos(theta_r)).\n"
    "\n"
    "Matrices with a coherency eigenvalue below -0.05 f11 get a warning; --strict refuses them. Exchanged states of a\n"
    "sample that depolarizes nearly all light do not show in that.\n"
    "\n"
    "Example:\n"
    "  mmbrdf reduce raw.csv --instrument instrument.json --solid-angle 1.114e-4 -o data.csv";

}  // namespace

Run reduce_command(CLI::App& app, const CommandLine&) {
  const auto o = std::make_shared<Options>();
  add_file(app, "RAW.csv", o->raw, " ", "Readings of a sample; - is standard input").required();
  add_file(app, "--instrument", o->instrument, "INSTRUMENT.json", "Written by mmbrdf calibrate (required)").required();
  add_option(app, "--solid-angle", o->solid_angle, solid_angle_from, "SR", "Of the receiver, in sr (required)")
      .required();
  add_reading_options(app, o->saturation, o->noise);
  add_flag(app, "--strict", o->strict, "Refuse matrices that cannot be physical");
  add_file(app, "-o,--output", o->output, "DATA.csv", "Where the samples go; - is standard output [-]");
  set_footer(app, footer);
  return [o] { reduce(*o); };
}

}  // namespace mmbrdf::program
