// SPDX-License-Identifier: BSD-3-Clause
// mmbrdf calibrate, mmbrdf instrument

#include "mmbrdf/polarimetry/calibration.hpp"

#include <memory>

#include "command.hpp"
#include "mmbrdf/files/instrument_file.hpp"
#include "mmbrdf/files/readings_file.hpp"
#include "options/arguments.hpp"
#include "options/files.hpp"
#include "options/polarimetry.hpp"
#include "pages/output.hpp"

namespace mmbrdf::program {

namespace {

struct Options {
  std::string references, output;
  CalibrationOptions calibration;
  std::optional<TurningRetarders> retarders;
  std::optional<double> polarizer_near;
  bool linear = false;
  double saturation = never_saturated;
};

int dial_sense(const std::string& text) {
  if (text != "+1" && text != "1" && text != "-1") throw std::invalid_argument("\"" + text + "\": expected +1 or -1");
  return text == "-1" ? -1 : 1;
}

double extinction(const std::string& text) {
  const double value = number(text);
  if (!(value >= 0 && value < 1)) throw std::invalid_argument("\"" + text + "\": expected 0 or more, and less than 1");
  return value;
}

/// Frame by frame, as two turning retarders are read.
void require_frames(const ReadStates& states, const std::string& name) {
  for (std::size_t j = 0; j < states.pairs.size(); ++j)
    if (states.pairs[j] != StatePair{j, j})
      throw std::runtime_error(name + ": " + to_string(StatePair{j, j}) +
                               " is not there: turning retarders read state 1 with 1, 2 with 2, and so on");
  if (states.pairs.empty() && states.generator * states.analyzer > 1)
    throw std::runtime_error(name +
                             ": all states of the generator with all of the analyzer, not frames of turning "
                             "retarders");
}

Calibration calibrated(const ReferenceFile& file, CalibrationOptions options, const std::string& name) {
  if (!options.retarders && !file.states.pairs.empty())
    throw std::runtime_error(name + ": " + std::to_string(file.states.pairs.size()) +
                             " pairs of states, not all: turning retarders are calibrated with --retarders "
                             "1:RATIO,STEP, and any others need all");
  options.generator_states = file.states.generator;
  options.analyzer_states = file.states.analyzer;
  options.wavelength = file.wavelength;
  try {
    return calibrate(file.references, options);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(name + ": " + error.what());
  }
}

void calibrate_instrument(Options options, const CommandLine& line) {
  require_kept(options.references, options.output, "references");
  if (options.retarders && options.linear) throw WrongUsage("--retarders excludes --linear");
  options.calibration.refine = !options.linear;
  if (options.polarizer_near) options.calibration.polarizer_near = radians(*options.polarizer_near);
  const std::string name = data_name(options.references);
  ReferenceFile file;
  read_input(options.references, [&](std::istream& in, const std::string& path) {
    file = read_references(in, path, {options.saturation, options.calibration.noise.dark});
  });
  if (options.retarders) {
    require_frames(file.states, name);
    options.calibration.retarders = options.retarders->options(file.states.generator);
  }
  Calibration result = calibrated(file, options.calibration, name);
  heed(judged(result, options.calibration.film, options.calibration.retarders), name);
  print_instrument(result);
  result.provenance["data"] = name;
  result.provenance["references"] = std::to_string(file.references.size());
  result.provenance["command"] = line.text({options.references, options.output});
  result.provenance["software"] = software();
  if (options.output.empty()) return;
  save_instrument(options.output, result);
  note_written(options.output);
}

constexpr const char* calibrate_footer =
    "REFERENCES.csv has the columns wavelength_nm, reference (empty, polarizer, wafer or retarder), angle_deg (the\n"
    "polarizer's dial, the angle of incidence, or the azimuth of the retarder's fast axis), number (tells measurements "
    "apart), generator_state, analyzer_state (from 1),\n"
    "intensity, and if need be dark, monitor, gain, s_exceeds_p and delta_sign: a reading is\n"
    "(intensity - dark) / (monitor gain).\n"
    "\n"
    "Needed are the arms aligned with nothing between them, a polarizer at several dial angles, and a coated wafer at\n"
    "several angles of incidence. Which of the eight instruments that explain the readings it is follows from the "
    "sense\n"
    "of the dial and from the wafer: from its film, or from the columns s_exceeds_p and delta_sign (1 or -1). The "
    "film\n"
    "is N,THICKNESS_UM,N_SUBSTRATE,K_SUBSTRATE; SiO2 on Si at 532 nm is 1.4607,1.0,4.15,0.044. Its thickness is "
    "fitted\n"
    "within 20 %. With that, one angle of incidence fits several films with other signs, and is refused: measure "
    "three\n"
    "or more, or state the signs.\n"
    "\n"
    "In place of wafers, retarders of known axes will do, with retardances below 180 degrees unless delta_sign is -1.\n"
    "They do not tell two orthogonal azimuths of the polarizer apart: give --polarizer-at.\n"
    "\n"
    "Two turning retarders (--retarders) are read frame by frame, generator state j with analyzer state j. "
    "Retardances,\n"
    "azimuths of the fast axes and of the second polarizer, diattenuations, the extinction of the polarizers and the\n"
    "drift of the source are fitted, to empty references alone or with any others; the first polarizer is at 0 unless "
    "a\n"
    "wafer or retarder shows more. STEP is positive if the retarders turn from s towards p.\n"
    "\n"
    "Condition numbers above 100 and figures of merit above 0.5 are refused, those above 10 and 0.05 get a warning.\n"
    "\n"
    "Examples:\n"
    "  mmbrdf calibrate references.csv --film 1.4607,1.0,4.15,0.044 -o instrument.json\n"
    "  mmbrdf calibrate air.csv --retarders 1:5,6 -o instrument.json";

constexpr const char* instrument_footer =
    "The figure of merit is the root mean square of measured - expected over the matrices of the references, divided "
    "by\n"
    "element 11. s16/s15 is the misfit of the linear solution; the identifiability s15/s1 says how far the references\n"
    "are from leaving a second one. u( ) are standard uncertainties. A reading is analyzer . M . generator.\n"
    "\n"
    "Example:\n"
    "  mmbrdf instrument instrument.json";

}  // namespace

Run calibrate_command(CLI::App& app, const CommandLine& line) {
  const auto o = std::make_shared<Options>();
  add_file(app, "REFERENCES.csv", o->references, " ", "Readings of the references; - is standard input").required();
  add_output_file(app, "-o,--output", o->output, "INSTRUMENT.json", "Where the instrument goes");
  add_option(app, "--film", o->calibration.film, film_from, "N,T,NS,KS", "The wafer: its film and substrate");
  add_option(app, "--dial-sense", o->calibration.dial_sense, dial_sense, "SENSE",
             "+1: the polarizer's azimuth grows with its dial; -1: it falls [+1]");
  add_option(app, "--extinction", o->calibration.extinction, extinction, "E",
             "Of the reference polarizer, to start from [0]");
  add_flag(app, "--polarizer-phase", o->calibration.fit_polarizer_phase, "Fit the polarizer's phase, too");
  const Option near = add_option(app, "--polarizer-at", o->polarizer_near, number, "DEG",
                                 "Roughly its azimuth at dial 0: needed if there is no wafer");
  const Option retarders =
      add_retarders(app, o->retarders,
                    "The instrument is two turning retarders: the\nanalyzer's turns RATIO times as far as the\n"
                    "generator's, which does STEP degrees each state;\nboth have this retardance, nearly [90]");
  retarders.excludes(near);
  add_flag(app, "--linear", o->linear, "Eigenvalue method alone, without refinement and covariance");
  add_reading_options(app, o->saturation, o->calibration.noise);
  set_footer(app, calibrate_footer);
  return [o, &line] { calibrate_instrument(*o, line); };
}

Run instrument_command(CLI::App& app, const CommandLine&) {
  const auto path = std::make_shared<std::string>();
  add_file(app, "INSTRUMENT.json", *path, " ", "Written by mmbrdf calibrate").required();
  set_footer(app, instrument_footer);
  return [path] {
    const Calibration instrument = load_instrument(*path);
    heed(judged(instrument), base_name(*path));
    print_instrument(instrument);
  };
}

}  // namespace mmbrdf::program
