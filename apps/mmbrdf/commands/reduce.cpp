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
  std::optional<Polarimeter> states;
  std::optional<TurningRetarders> retarders;
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

/// GENERATOR[/ANALYZER], each names of states with commas between.
Polarimeter states_from(const std::string& text) {
  const auto names = [](const std::string& list) {
    std::vector<std::string> result;
    for (std::size_t begin = 0; begin <= list.size();) {
      const std::size_t end = std::min(list.find(',', begin), list.size());
      result.push_back(list.substr(begin, end - begin));
      begin = end + 1;
    }
    return result;
  };
  const std::size_t slash = text.find('/');
  const std::string analyzer = slash == std::string::npos ? text : text.substr(slash + 1);
  return ideal_polarimeter(names(text.substr(0, slash)), names(analyzer));
}

/// What reads, and at which wavelength if that is known.
struct Reading {
  Polarimeter polarimeter;
  std::optional<double> wavelength;
};

Reading reading_of(const Options& options) {
  if (options.states) return {*options.states, {}};
  if (options.retarders) {
    const RetarderOptions retarders = options.retarders->options(most_states);
    return {polarimeter(retarders.nominal, retarders.dials), {}};
  }
  const Calibration instrument = load_instrument(options.instrument);
  heed(judged(instrument), base_name(options.instrument));
  return {instrument.polarimeter, instrument.wavelength};
}

std::string pairs(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " pair" : " pairs") + " of states";
}

/// What the readings do not determine, and that they are not the same everywhere.
void note_pairs(const Reducer& reducer, const Reduction& last, std::size_t readings, const std::string& name) {
  if (last.undetermined().any())
    note(name + ": " + pairs(readings) + ", rank " + std::to_string(last.rank()) + ": not determined, and unknown, " +
         element_names(last.undetermined()));
  constexpr double doubtful = doubtful_condition * doubtful_condition;
  if (last.undetermined().none() && last.condition() > doubtful)
    warn(name + ": the condition number of its " + pairs(readings) + " is " + shortest(std::round(last.condition())) +
         ", more than " + shortest(doubtful) + ": noise of the readings grows by it");
  if (reducer.sets() > 1)
    note(name + ": its measurements have read " + std::to_string(reducer.sets()) +
         " different sets of pairs of states");
}

std::vector<Sample> reduced_file(const Reading& reading, const Options& options) {
  Reducer reducer(reading.polarimeter);
  std::vector<Sample> samples;
  read_input(options.raw, [&](std::istream& in, const std::string& name) {
    RawReader reader(in, name, read_states(reading.polarimeter), {options.saturation, options.noise.dark});
    RawMeasurement raw;
    const Reduction* reduction = nullptr;
    while (reader.next(raw)) {
      if (reading.wavelength && !same_wavelength(raw.wavelength, *reading.wavelength)) {
        throw reader.error("wavelength_nm: " + brief(nanometres(raw.wavelength)) + ", but the instrument is of " +
                           brief(nanometres(*reading.wavelength)) + " nm");
      }
      try {
        reduction = &reducer(raw.pairs);
        samples.push_back(reduced(*reduction, raw, *options.solid_angle, options.noise));
      } catch (const std::invalid_argument& error) {
        throw reader.error(error.what());
      }
    }
    note_pairs(reducer, *reduction, raw.readings.size(), data_name(options.raw));
  });
  return samples;
}

/// Warns of matrices that nothing can have, or refuses them.
void check_possible(const std::vector<Sample>& samples, const Options& options) {
  Verdict verdict = judged(samples);
  if (options.strict && !verdict.doubts.empty()) verdict = {{}, verdict.doubts[0]};
  heed(verdict, data_name(options.raw));
}

/// For the file of the samples: from what, by what and how.
std::string reduction_text(const Options& options) {
  const std::string by = options.instrument.empty() ? "an ideal instrument" : base_name(options.instrument);
  return mmbrdf::reduction_text(data_name(options.raw), by, *options.solid_angle, options.noise, options.saturation);
}

void reduce(const Options& options) {
  require_kept(options.raw, options.output, "readings");
  if (options.instrument.empty() && !options.states && !options.retarders)
    throw WrongUsage("--instrument is required, or --states or --retarders of an ideal one");
  if (!options.instrument.empty()) require_kept(options.instrument, options.output, "instrument");
  const std::vector<Sample> samples = reduced_file(reading_of(options), options);
  check_possible(samples, options);
  write_output(options.output, [&](std::ostream& out) { write_samples(out, samples, reduction_text(options)); });
}

constexpr const char* footer =
    "RAW.csv has the columns wavelength_nm, theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg, number (the rows of one\n"
    "measurement are adjacent), generator_state, analyzer_state (from 1), intensity, and if need be dark, monitor,\n"
    "gain. DATA.csv has samples, with standard uncertainties from the noise of the readings in columns u_f11 ...\n"
    "u_m44. What the instrument is uncertain by is the same error in all samples and not in them: mmbrdf fit\n"
    "--instrument adds it. The solid angle is that of the receiver: f = M / (SR cos(theta_r)).\n"
    "\n"
    "A measurement need not have all pairs of states: those that it has decide which elements are determined, the\n"
    "others are unknown, empty fields in DATA.csv. Readings below zero pass down to -5 X with --noise dark:X.\n"
    "\n"
    "In place of a calibrated instrument an ideal one, whose readings are relative to the incident light: --states of\n"
    "s, p, +45, -45, L, R or u (not polarized), those of the generator and, behind a slash, of the analyzer, if they\n"
    "are others; or --retarders. Both have no uncertainty of the instrument.\n"
    "\n"
    "Matrices with a coherency eigenvalue below -0.05 f11 get a warning; --strict refuses them. Exchanged states of a\n"
    "sample that depolarizes nearly all light do not show in that.\n"
    "\n"
    "Examples:\n"
    "  mmbrdf reduce raw.csv --instrument instrument.json --solid-angle 1.114e-4 -o data.csv\n"
    "  mmbrdf reduce raw.csv --states s,p,+45,-45,L,R --solid-angle 1.114e-4 -o data.csv\n"
    "  mmbrdf reduce frames.csv --retarders 1:5,6 --solid-angle 1.114e-4 -o data.csv";

}  // namespace

Run reduce_command(CLI::App& app, const CommandLine&) {
  const auto o = std::make_shared<Options>();
  add_file(app, "RAW.csv", o->raw, " ", "Readings of a sample; - is standard input").required();
  const Option instrument =
      add_file(app, "--instrument", o->instrument, "INSTRUMENT.json", "Written by mmbrdf calibrate");
  const Option states = add_option(app, "--states", o->states, states_from, "NAME[,NAME...][/...]",
                                   "In its place ideal states of both arms, in the\norder of their numbers");
  add_retarders(app, o->retarders,
                "In its place two ideal turning retarders: the\nanalyzer's turns RATIO times as far as the\n"
                "generator's, which does STEP degrees each state;\nboth have this retardance [90]")
      .excludes(states)
      .excludes(instrument);
  states.excludes(instrument);
  add_option(app, "--solid-angle", o->solid_angle, solid_angle_from, "SR", "Of the receiver, in sr (required)")
      .required();
  add_reading_options(app, o->saturation, o->noise);
  add_flag(app, "--strict", o->strict, "Refuse matrices that cannot be physical");
  add_file(app, "-o,--output", o->output, "DATA.csv", "Where the samples go; - is standard output [-]");
  set_footer(app, footer);
  return [o] { reduce(*o); };
}

}  // namespace mmbrdf::program
