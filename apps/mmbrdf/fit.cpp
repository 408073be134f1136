// SPDX-License-Identifier: BSD-3-Clause
// mmbrdf fit

#include "mmbrdf/fit.hpp"

#include <filesystem>
#include <iostream>
#include <memory>

#include "arguments.hpp"
#include "command.hpp"
#include "fit_report.hpp"
#include "mmbrdf/io.hpp"
#include "output.hpp"

namespace mmbrdf::program {

namespace {

struct Options {
  std::string data, output, name, attribution;
  Basis basis;
  FitOptions fit;
  std::optional<std::vector<double>> wavelengths_nm;
  Weights weights = Weights::none;
  Format format = Format::text;
};

Weights weights_from(const std::string& name) {
  if (name != "none" && name != "speckle") {
    throw std::invalid_argument("\"" + name + "\": expected none or speckle");
  }
  return name == "none" ? Weights::none : Weights::speckle;
}

std::string to_string(Weights weights) { return weights == Weights::none ? "none" : "speckle"; }

std::vector<Sample> only_at(const std::vector<double>& wavelengths_nm, const std::vector<Sample>& samples,
                            const std::string& name) {
  const std::vector<double> wanted = micrometres(wavelengths_nm);
  try {
    return at_wavelengths(samples, wanted);
  } catch (const std::invalid_argument&) {
    throw std::runtime_error(name + ": has samples at " + nanometre_list(wavelengths(samples)) + ", not at all of " +
                             nanometre_list(wanted));
  }
}

std::string data_name(const Options& options) {
  return options.data == "-" ? "standard input" : base_name(options.data);
}

std::vector<Sample> samples_of(const Options& options) {
  const bool from_file = options.data != "-";
  std::vector<Sample> samples = from_file ? read_samples(options.data) : read_samples(std::cin, data_name(options));
  return options.wavelengths_nm ? only_at(*options.wavelengths_nm, samples, data_name(options)) : samples;
}

/// Throws std::invalid_argument for options that make no sense whatever the data are.
void require_valid(const Options& options) {
  blocks(options.basis.family, options.basis.orders);
  if (options.fit.reflectance) {
    mmbrdf::require_valid(*options.fit.reflectance);
  }
  std::error_code ignored;
  if (std::filesystem::equivalent(options.data, options.output, ignored)) {
    throw std::invalid_argument(options.output + ": would overwrite the data");
  }
}

/// Says who made the model, from what and how.
void sign(Model& model, const Options& options, std::size_t rows, const CommandLine& line) {
  const std::filesystem::path origin = options.output.empty() ? options.data : options.output;
  model.name = options.name.empty() ? origin.stem().string() : options.name;
  model.provenance["data"] = data_name(options);
  model.provenance["rows"] = std::to_string(rows);
  model.provenance["command"] = line.text({options.data, options.output});
  model.provenance["software"] = software();
  model.provenance["weights"] = to_string(options.weights);
  if (!options.attribution.empty()) {
    model.provenance["attribution"] = options.attribution;
  }
}

void save(const Model& model, const std::string& path) {
  save_model(path, model);
  if (path.ends_with(".csv") && !model.reflectance.values.empty()) {
    warn(base_name(path) + " has no place for the reflectance by which f11 was divided. Keep it: --reflectance " +
         reflectance_argument(model.reflectance));
  }
}

void note_free_combinations(const FitResult& result) {
  long free = 0;
  std::string blocks;
  for (std::size_t b = 0; b < result.solutions.size(); ++b) {
    const long here = static_cast<long>(result.solutions[b].x.size()) - result.solutions[b].rank;
    if (here > 0) {
      free += here;
      blocks += (blocks.empty() ? "" : ", ") + std::to_string(here) + " of block " + result.model.blocks[b].block.name;
    }
  }
  if (free > 0) {
    note("the data leave " + std::to_string(free) + " of " + std::to_string(coefficient_count(result.model)) +
         " combinations of coefficients free (" + blocks + "); the solution is the one of smallest norm");
  }
}

FitResult fitted(const std::vector<Sample>& samples, const Options& options) {
  try {
    return fit(samples, options.basis, options.fit, options.weights);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(data_name(options) + ": " + error.what());
  }
}

void fit_data(const Options& options, const CommandLine& line) {
  require_valid(options);
  const std::vector<Sample> samples = samples_of(options);
  FitResult result = fitted(samples, options);
  sign(result.model, options, samples.size(), line);
  if (!options.output.empty()) {
    save(result.model, options.output);
  }
  print({.data = data_name(options),
         .weights = to_string(options.weights),
         .rows = static_cast<long>(samples.size()),
         .result = result},
        options.format);
  note_free_combinations(result);
}

constexpr const char* footer =
    "DATA.csv has the columns of the published data (lambda in micrometres) or wavelength_nm, theta_i_deg, phi_i_deg,\n"
    "theta_r_deg, phi_r_deg, f11 (in sr^-1), m12 ... m44 (divided by f11); - is standard input.\n"
    "\n"
    "rms is the root mean square of measured - model, for f11 in sr^-1 after division by the reflectance, for the\n"
    "other elements without unit. chi^2 is the weighted sum of squares. Elements that reciprocity or the basis ties\n"
    "together are fitted together, as a block. With several wavelengths, f11 is divided by each one's own reflectance\n"
    "at normal incidence, unless --reflectance gives it; the model keeps that table.\n"
    "\n"
    "Examples:\n"
    "  mmbrdf fit data.csv -o model.json\n"
    "  mmbrdf fit data.csv --wavelength 532 --basis germer2017 -o model.csv";

void add_basis_options(CLI::App& app, const std::shared_ptr<Options>& o) {
  add_option(app, "--basis", o->basis.family, family_from, "NAME", "isotropic, germer2017 or anisotropic [isotropic]");
  add_option(app, "--orders", o->basis.orders, orders_from, "N,M",
             "Highest radial order of f11 and of the other elements [7,4]");
  add_option(app, "--powers", o->fit.powers, whole_number, "P",
             "Highest power of the wavelength [1; 0 for one wavelength]");
  add_option(app, "--mapping", o->basis.mapping, disc_mapping_from, "NAME",
             "Hemisphere to disc: lambert or projected [lambert]");
}

void add_data_options(CLI::App& app, const std::shared_ptr<Options>& o) {
  add_option(app, "-w,--wavelength", o->wavelengths_nm, numbers, "NM[,NM...]", "Fit these wavelengths only, in nm");
  add_option(app, "--reflectance", o->fit.reflectance, reflectance_from, "NM:R[,NM:R...]",
             "Divide f11 by these reflectances, each at a\nwavelength in nm, linear between them");
  add_option(app, "--weights", o->weights, weights_from, "NAME", "none or speckle: cos(theta_r)/cos(theta_i) [none]");
  app.add_flag(
      "--minimum-norm", o->fit.minimum_norm,
      "Accept data that do not determine every coefficient, and\ntake the smallest solution (germer2017: always)");
}

}  // namespace

Run fit_command(CLI::App& app, const CommandLine& line) {
  const auto o = std::make_shared<Options>();
  app.add_option("DATA.csv", o->data, "Samples; - is standard input")->required()->option_text(" ");
  add_text(app, "-o,--output", o->output, "MODEL",
           "Write the model: JSON, or published coefficients if it ends in .csv");
  add_basis_options(app, o);
  add_data_options(app, o);
  add_text(app, "--name", o->name, "NAME", "Name of the model [file name]");
  add_text(app, "--attribution", o->attribution, "TEXT", "Whose data these are, kept in the model");
  add_option(app, "--format", o->format, format_from, "FORMAT", "Of the table: text, csv or json [text]");
  app.footer(footer);
  return [o, line] { fit_data(*o, line); };
}

}  // namespace mmbrdf::program
