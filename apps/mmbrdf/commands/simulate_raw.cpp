// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <iostream>

#include "command.hpp"
#include "mmbrdf/files/readings_file.hpp"
#include "mmbrdf/files/write_file.hpp"
#include "mmbrdf/model/description.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/polarimetry/goniometer.hpp"
#include "mmbrdf/polarimetry/measurement.hpp"
#include "options/arguments.hpp"
#include "options/files.hpp"
#include "options/polarimetry.hpp"
#include "pages/output.hpp"

namespace mmbrdf::program {

namespace {

constexpr int references_of_each_kind = 18;
constexpr const char* references_file = "references.csv";
constexpr const char* raw_file = "raw.csv";

GoniometerOptions goniometer_options(const RawSimulation& options) {
  GoniometerOptions result;
  result.noise = {.dark = 0, .shot = 0, .relative = options.reading_noise};
  result.speckle = options.speckle;
  if (!options.retarders) return result;
  const RetarderOptions retarders = options.retarders->options(options.frames);
  result.dials = retarders.dials;
  result.retardance = retarders.nominal.generator.retardance;
  result.imperfections.azimuth = radians(2);
  return result;
}

std::string to_text(const TurningRetarders& retarders) {
  return "1:" + shortest(retarders.ratio) + "," + shortest(in_degrees(retarders.step)) + "," +
         shortest(in_degrees(retarders.retardance));
}

std::vector<RawMeasurement> measurements(const Goniometer& goniometer, const Model& model, double wavelength,
                                         std::span<const Geometry> geometries, unsigned long seed) {
  const auto readings = goniometer.readings(prepare(model, wavelength), geometries, seed);
  std::vector<RawMeasurement> result;
  for (std::size_t i = 0; i < geometries.size(); ++i) result.push_back({wavelength, geometries[i], readings[i]});
  return result;
}

}  // namespace

void require_kept(const std::string& model, const RawSimulation& options) {
  for (const char* const file : {references_file, raw_file})
    require_model_kept(model, (std::filesystem::path(options.folder) / file).string());
}

void simulate_raw(const Model& model, double wavelength, std::span<const Geometry> geometries,
                  const RawSimulation& options) {
  const Goniometer goniometer(goniometer_options(options), options.seed);
  const ReadStates states = read_states(goniometer.polarimeter());
  const ReferenceFile references{wavelength, states,
                                 goniometer.references(wavelength, references_of_each_kind, options.seed)};
  const std::vector<RawMeasurement> raw = measurements(goniometer, model, wavelength, geometries, options.seed);
  const std::filesystem::path folder = options.folder;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw std::runtime_error(options.folder + ": cannot be made: " + error.message());
  write_files({{(folder / references_file).string(), [&](std::ostream& out) { write_references(out, references); }},
               {(folder / raw_file).string(), [&](std::ostream& out) { write_raw(out, states, raw); }}});
  note_written(options.folder);
  const Film& film = goniometer.options().film;
  const std::string text = shortest(film.film_index.real()) + "," + shortest(film.thickness) + "," +
                           shortest(film.substrate_index.real()) + "," + shortest(film.substrate_index.imag());
  const std::string name = options.folder.starts_with('-') ? "./" + options.folder : options.folder;
  std::cout << "references.csv   " << references.references.size() << " references\n"
            << "raw.csv          " << raw.size() << " geometries at " << brief(nanometres(wavelength)) << " nm\n"
            << "\nNext:\n  cd " << shell_quoted(name) << "\n  mmbrdf calibrate references.csv --film " << text
            << (options.retarders ? " --retarders " + to_text(*options.retarders) : "")
            << " -o instrument.json\n  mmbrdf reduce raw.csv --instrument instrument.json --solid-angle "
            << shortest(goniometer.options().solid_angle)
            << " -o data.csv\n  mmbrdf fit data.csv --weights data --instrument instrument.json -o model.json\n";
}

}  // namespace mmbrdf::program
