// SPDX-License-Identifier: BSD-3-Clause
// mmbrdf fit

#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/model/description.hpp"

#include <filesystem>
#include <memory>
#include <span>

#include "command.hpp"
#include "mmbrdf/files/instrument_file.hpp"
#include "mmbrdf/fitting/common_errors.hpp"
#include "mmbrdf/quantities/conventions.hpp"
#include "mmbrdf/quantities/fit_warnings.hpp"
#include "options/arguments.hpp"
#include "options/certificate.hpp"
#include "options/files.hpp"
#include "options/polarimetry.hpp"
#include "pages/fit_report.hpp"
#include "pages/output.hpp"

namespace mmbrdf::program {

namespace {

struct Options {
  std::string data, output, name, attribution, instrument;
  Basis basis;
  FitOptions fit;
  std::optional<Uncertainty> given_uncertainty;
  std::optional<std::vector<double>> wavelengths_nm;
  SampleTable table;
  std::optional<Weights> given_weights;
  Format format = Format::text;
};

/// Of the sample, unless something else was asked for that is of the noise.
Uncertainty uncertainty(const Options& options) {
  const bool of_noise = options.basis.family != Family::isotropic || options.fit.covariance != Covariance::residuals ||
                        options.given_weights == Weights::data;
  return options.given_uncertainty.value_or(of_noise ? Uncertainty::noise : Uncertainty::sample);
}

/// The mixed model estimates a scale of the speckle law; for the noise alone every row counts the same.
Weights weights(const Options& options) {
  return options.given_weights.value_or(uncertainty(options) == Uncertainty::sample ? Weights::speckle : Weights::none);
}

/// Throws std::invalid_argument for options that make no sense whatever the data are.
void require_valid(const Options& options) {
  if (!(options.fit.declared == DeclaredErrors{}) && uncertainty(options) == Uncertainty::noise)
    throw WrongUsage("--declare",
                     "goes with --uncertainty sample; of the noise alone, give the error with --term later");
  blocks(options.basis.family, options.basis.orders);
  if (options.fit.reflectance) mmbrdf::require_valid(*options.fit.reflectance);
  require_kept(options.data, options.output, "data");
  require_kept(options.instrument, options.output, "instrument");
}

/// Says who made the model, from what and how.
void sign(Model& model, const Options& options, long rows, const SaidOfTable& said, const CommandLine& line) {
  const std::filesystem::path origin = options.output.empty() ? options.data : options.output;
  model.name = options.name.empty() ? origin.stem().string() : options.name;
  model.provenance["data"] = data_name(options.data);
  model.provenance["rows"] = std::to_string(rows);
  if (!said.understood.empty()) model.provenance["table"] = said.understood;
  if (!said.reduction.empty()) model.provenance["reduction"] = said.reduction;
  model.provenance["command"] = line.text({options.data, options.output, options.instrument});
  model.provenance["software"] = software();
  model.provenance["weights"] = to_string(weights(options));
  model.provenance["uncertainty"] = to_string(model.posterior ? Uncertainty::sample : Uncertainty::noise);
  if (options.fit.covariance != Covariance::residuals)
    model.provenance["covariance"] = to_string(options.fit.covariance);
  if (!options.attribution.empty()) model.provenance["attribution"] = options.attribution;
}

void save_or_warn(const Model& model, const Options& options) {
  if (options.output.empty()) {
    for (const auto& [text, name] : {std::pair(options.name, "--name"), {options.attribution, "--attribution"}})
      if (!text.empty()) warn(std::string(name) + " is not used without --output");
    return;
  }
  save(model, options.output);
  warn_of_what_is_left_out(model, options.output, !options.name.empty());
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
    note("the data leave " + std::to_string(free) + " of " + counted(coefficient_count(result.model), "combination") +
         " of coefficients free (" + blocks + "); the solution is the one of smallest norm");
  }
}

/// The mixed model, weights and sandwiches need a first fit, and with it all samples in memory, and so do an instrument's errors.
bool streams(const Options& options) {
  return uncertainty(options) == Uncertainty::noise && weights(options) == Weights::none &&
         options.fit.covariance == Covariance::residuals && options.instrument.empty();
}

/// Says which option helps, where the library only refuses.
void require_instrument_of(std::span<const Sample> samples, const Calibration& instrument, const std::string& name) {
  try {
    mmbrdf::require_measured_by(samples, instrument, name);
  } catch (const std::invalid_argument& error) {
    const bool linear = instrument.covariance.empty();
    throw std::runtime_error(error.what() + std::string(linear ? "" : "; choose with --wavelength"));
  }
}

/// Adds what the instrument is uncertain by, which is the same error in all its samples.
void add_instrument(FitResult& result, std::span<const Sample> samples, const Options& options) {
  const Calibration instrument = load_instrument(options.instrument);
  const std::string name = base_name(options.instrument);
  heed(judged(instrument), name);
  require_instrument_of(samples, instrument, name);
  mmbrdf::add_instrument(result, samples, instrument, name);
}

/// Some of the samples of a stream at its first wavelength, evenly spread over what there was so far.
class Spread {
 public:
  void add(std::span<const Sample> samples) {
    for (const Sample& sample : samples) {
      ++number_;
      if (!some_.empty() && !same_wavelength(sample.wavelength, some_.front().wavelength)) continue;
      if (seen_++ % stride_ == 0) some_.push_back(sample), numbers_.push_back(number_);
      if (some_.size() < 2 * most_tried) continue;
      for (std::size_t i = 0; i < most_tried; ++i) some_[i] = some_[2 * i], numbers_[i] = numbers_[2 * i];
      some_.resize(most_tried), numbers_.resize(most_tried);
      stride_ *= 2;
    }
  }
  std::span<const Sample> some() const { return some_; }
  std::span<const long> numbers() const { return numbers_; }  ///< from 1, in the order of the data

 private:
  std::vector<Sample> some_;
  std::vector<long> numbers_;
  long number_ = 0;
  std::size_t seen_ = 0, stride_ = 1;
};

/// Of samples that cannot be fitted: what is wrong with them may be the reason.
void warn_of_faults(const Spread& some) {
  if (some.some().empty()) return;
  for (const Finding& finding : inspect(some.some(), some.numbers()).findings)
    if (finding.fault != "no fit") warn(to_string(finding));
}

FitResult fitted(const Options& options, long& rows, Spread& some, SaidOfTable& said) {
  FitAccumulator accumulator(options.basis);
  std::vector<Sample> all;
  said = read_samples_at(options.data, options.wavelengths_nm, options.table, [&](std::span<const Sample> samples) {
    rows += static_cast<long>(samples.size());
    some.add(samples);
    if (streams(options))
      accumulator.add(samples);
    else
      all.insert(all.end(), samples.begin(), samples.end());
  });
  try {
    if (streams(options)) return accumulator.solve(options.fit);
    FitOptions chosen = options.fit;
    chosen.uncertainty = uncertainty(options);
    FitResult result = fit(all, options.basis, chosen, weights(options));
    if (!options.instrument.empty()) add_instrument(result, all, options);
    return result;
  } catch (const std::invalid_argument& error) {
    warn_of_faults(some);
    throw std::runtime_error(data_name(options.data) + ": " + error.what());
  }
}

/// Keeps the laws from which the weights are.
void record_noise(Model& model, const FitResult& result) {
  std::string text;
  for (std::size_t i = 0; i < result.noise.size(); ++i) text += (i > 0 ? "; " : "") + noise_line(result, i);
  if (!text.empty()) model.provenance["noise"] = text;
}

void fit_data(const Options& options, const CommandLine& line) {
  require_valid(options);
  long rows = 0;
  Spread some;
  SaidOfTable said;
  FitResult result = fitted(options, rows, some, said);
  sign(result.model, options, rows, said, line);
  record_noise(result.model, result);
  save_or_warn(result.model, options);
  print({.data = data_name(options.data),
         .weights = to_string(weights(options)),
         .covariance = to_string(options.fit.covariance),
         .rows = rows,
         .result = result},
        options.format);
  for (const std::string& warning : fit_warnings(result, some.some(), some.numbers())) warn(warning);
  if (!result.model.posterior) note_free_combinations(result);
}

constexpr const char* footer =
    "DATA.csv has the columns of the published data (lambda in micrometres) or wavelength_nm, theta_i_deg, phi_i_deg,\n"
    "theta_r_deg, phi_r_deg, f11 (in sr^-1), m12 ... m44 (divided by f11); - is standard input. Tables as numpy, R or\n"
    "spreadsheets write them, in radians, of brf = pi f or of f_ss, f_sp, f_ps, f_pp or f_s, f_p are understood,\n"
    "which a note says. Columns that are not there, but for f11, and empty fields were not measured: their elements\n"
    "are unknown.\n"
    "--weights data needs their standard uncertainties too: u_f11, u_m12 ... u_m44.\n"
    "\n"
    "rms is the root mean square of measured - model, for f11 in sr^-1 after division by the reflectance, for the\n"
    "other elements without unit. chi^2 is the weighted sum of squares; with --weights data it is also given per "
    "degree\n"
    "of freedom, rows - rank: near 1 if uncertainties and model are right. Elements that reciprocity or the basis "
    "ties\n"
    "together are fitted together, as a block. With several wavelengths, f11 is divided by each one's own reflectance\n"
    "at normal incidence, unless --reflectance gives it; the model keeps that table. Any number of rows takes the "
    "same\n"
    "memory, but for --weights, --covariance sandwich and --instrument.\n"
    "\n"
    "Warnings tell of reflectances above 1, of f11 that is not positive, of samples in one plane or on one side of it, "
    "of\n"
    "chi^2 and condition, and of samples that would fit better in another frame or with other signs than those of\n"
    "xy: S2 = y - x, S4 = left - right.\n"
    "\n"
    "Examples:\n"
    "  mmbrdf fit data.csv -o model.json\n"
    "  mmbrdf fit data.csv --wavelength 532 --basis germer2017 -o model.csv";

void add_basis_options(CLI::App& app, const std::shared_ptr<Options>& o) {
  add_basis_option(app, o->basis);
  add_option(app, "--powers", o->fit.powers, whole_number, "P",
             "Highest power of the wavelength [1; 0 for one wavelength]");
  add_option(app, "--mapping", o->basis.mapping, disc_mapping_from, "NAME",
             "Hemisphere to disc: lambert or projected [lambert]");
}

void add_data_options(CLI::App& app, const std::shared_ptr<Options>& o) {
  add_option(app, "-w,--wavelength", o->wavelengths_nm, numbers, "NM[,NM...]", "Fit these wavelengths only, in nm");
  add_table_options(app, o->table);
  add_option(app, "--reflectance", o->fit.reflectance, reflectance_of_fit, "NM:R[,...]|FILE",
             "Divide f11 by these reflectances, each at a\nwavelength in nm, linear between them");
  add_option(app, "--uncertainty", o->given_uncertainty, uncertainty_from, "NAME",
             "sample: holds for a real sample, its anisotropy and\nwhat the basis misses included; noise: of the noise "
             "alone\n[sample; noise for other bases, --covariance and\n--weights data]");
  add_option(app, "--declare", o->fit.declared, declared_from, "NAME=U[,NAME=U...]",
             "Errors that all rows share: scale=0.3%, source=0.5deg,\nreceiver=0.5deg (of the arms); standard "
             "uncertainties [none]");
  add_weights_option(app, o->given_weights, "speckle; none for the noise alone");
  add_option(app, "--covariance", o->fit.covariance, covariance_from, "NAME",
             "residuals: --weights tell how uncertain a row is relative\nto others, residuals how much; sandwich: for "
             "noise that\nis not as the weights say; given: u of --weights data as\nthey are [residuals]");
  add_file(app, "--instrument", o->instrument, "INSTRUMENT.json",
           "Of mmbrdf calibrate: what it is uncertain by is added\nto the covariance, since all samples share it");
  add_flag(app, "--minimum-norm", o->fit.minimum_norm,
           "Accept data that do not determine every coefficient, and\ntake the smallest solution (germer2017: always)");
}

}  // namespace

Run fit_command(CLI::App& app, const CommandLine& line) {
  const auto o = std::make_shared<Options>();
  add_file(app, "DATA.csv", o->data, " ", "Samples; - is standard input").required();
  add_output_file(app, "-o,--output", o->output, "MODEL",
                  "Write the model: JSON, or published coefficients if it ends in .csv");
  add_basis_options(app, o);
  add_data_options(app, o);
  add_text(app, "--name", o->name, "NAME", "Name of the model [file name]");
  add_text(app, "--attribution", o->attribution, "TEXT", "Whose data these are, kept in the model");
  add_option(app, "--format", o->format, format_from, "FORMAT", "Of the table: text, csv, json or html [text]");
  set_footer(app, footer);
  return [o, line] { fit_data(*o, line); };
}

}  // namespace mmbrdf::program
