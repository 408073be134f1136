// SPDX-License-Identifier: BSD-3-Clause
// mmbrdf select

#include <memory>
#include <optional>

#include "command.hpp"
#include "mmbrdf/fitting/selection.hpp"
#include "options/arguments.hpp"
#include "options/files.hpp"
#include "pages/output.hpp"
#include "pages/select_report.hpp"

namespace mmbrdf::program {

namespace {

enum class LeaveOut { what_can_be, angle, wavelength, both, none };

struct Options {
  std::string data;
  SelectionOptions selection;
  std::optional<Range> orders_f11, orders_other, powers;
  std::optional<std::vector<double>> wavelengths_nm;
  int folds = 3;
  bool random = false;
  unsigned long seed = 1;
  LeaveOut leave_out = LeaveOut::what_can_be;
  Weights weights = Weights::none;
  Format format = Format::text;
};

Range orders_range(const std::string& text) {
  const std::size_t colon = text.find(':');
  try {
    const int first = whole_number(text.substr(0, colon));
    return {first, colon == std::string::npos ? first : whole_number(text.substr(colon + 1))};
  } catch (const std::invalid_argument&) {
    throw std::invalid_argument("\"" + text + "\": expected FIRST:LAST, whole numbers, as in 2:9");
  }
}

LeaveOut leave_out_from(const std::string& name) {
  if (name == "angle") return LeaveOut::angle;
  if (name == "wavelength") return LeaveOut::wavelength;
  if (name == "angle,wavelength") return LeaveOut::both;
  if (name == "none") return LeaveOut::none;
  throw std::invalid_argument("\"" + name + "\": expected angle, wavelength, angle,wavelength or none");
}

std::vector<Partition> partitions_of(const Options& options, std::span<const Sample> samples) {
  std::vector<Partition> result{options.random ? random_folds(samples.size(), options.folds, options.seed)
                                               : folds_by_row(samples.size(), options.folds)};
  const LeaveOut what = options.leave_out;
  if (what == LeaveOut::angle || what == LeaveOut::both) result.push_back(folds_by_incident_angle(samples));
  if (what == LeaveOut::wavelength || what == LeaveOut::both) result.push_back(folds_by_wavelength(samples));
  if (what == LeaveOut::what_can_be) {
    try {
      result.push_back(folds_by_incident_angle(samples));
    } catch (const std::invalid_argument& error) {
      note(error.what() + std::string("; folds alone decide, and see nothing between the angles measured"));
    }
    // Without one of two wavelengths no power could be tested.
    if (wavelengths(samples).size() > 2) result.push_back(folds_by_wavelength(samples));
  }
  return result;
}

/// Ranges that were not asked for: the full expansion grows fast, and soon has more coefficients than the data rows.
SelectionOptions completed(const Options& options, std::size_t wavelengths) {
  SelectionOptions result = options.selection;
  if (result.family == Family::anisotropic) {
    result.orders_f11 = {1, 4};
    result.orders_other = {1, 3};
  }
  result.orders_f11 = options.orders_f11.value_or(result.orders_f11);
  result.orders_other = options.orders_other.value_or(result.orders_other);
  result.powers = options.powers.value_or(Range{0, wavelengths > 1 ? 1 : 0});
  return result;
}

void select(const Options& options) {
  const std::string name = data_name(options.data);
  const std::vector<Sample> samples = samples_at(options.data, options.wavelengths_nm);
  try {
    const std::vector<double> there = wavelengths(samples);
    const std::vector<Partition> partitions = partitions_of(options, samples);
    const SelectionOptions asked = completed(options, there.size());
    const Selection selection = select_model(samples, partitions, asked, options.weights);
    print({name, to_string(options.weights), static_cast<long>(samples.size()), there, asked, partitions, selection},
          options.format);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(name + ": " + error.what());
  }
}

constexpr const char* footer =
    "DATA.csv is as for mmbrdf fit. f11 and the other elements are fitted apart, so each has its table and its order.\n"
    "CV is the root mean square of measured - model where the model was fitted without the fold that holds the\n"
    "sample: rows and random are folds of samples, angle and wavelength leave out one incident polar angle or one\n"
    "wavelength. Folds of samples tell noise from signal; only the others see what a model does between the angles\n"
    "measured, so they decide where there are any. AIC is n ln(rms^2) + 2 rank, BIC n ln(rms^2) + rank ln n.\n"
    "\n"
    "Recommended is the lowest order whose CV is within 1 % of the smallest. Refused is what the data do not\n"
    "determine, also without one fold, and orders above the best whose CV is more than 50 % larger. Powers are the\n"
    "lowest whose CV is within 1 % of the smallest, the higher of both tables.\n"
    "\n"
    "Examples:\n"
    "  mmbrdf select data.csv --wavelength 532\n"
    "  mmbrdf select data.csv --basis germer2017 --orders-f11 5:8 --powers 1 --format csv";

void add_ranges(CLI::App& app, const std::shared_ptr<Options>& o) {
  add_option(app, "--orders-f11", o->orders_f11, orders_range, "A:B", "Orders of f11 [2:9; anisotropic 1:4]");
  add_option(app, "--orders-other", o->orders_other, orders_range, "A:B",
             "Orders of the other elements [2:6; anisotropic 1:3]");
  add_option(app, "--powers", o->powers, orders_range, "A:B",
             "Highest powers of the wavelength [0:1; 0 for one wavelength]");
}

}  // namespace

Run select_command(CLI::App& app, const CommandLine&) {
  const auto o = std::make_shared<Options>();
  add_file(app, "DATA.csv", o->data, " ", "Samples; - is standard input").required();
  add_option(app, "-w,--wavelength", o->wavelengths_nm, numbers, "NM[,NM...]", "Use these wavelengths only, in nm");
  add_option(app, "--basis", o->selection.family, family_from, "NAME",
             "isotropic, germer2017 or anisotropic [isotropic]");
  add_option(app, "--mapping", o->selection.mapping, disc_mapping_from, "NAME",
             "Hemisphere to disc: lambert or projected [lambert]");
  add_ranges(app, o);
  add_option(app, "--folds", o->folds, whole_number, "K", "Folds of samples: row number modulo K [3]");
  add_flag(app, "--random-folds", o->random, "Take random folds instead");
  add_option(app, "--seed", o->seed, seed, "SEED", "Of the random folds [1]");
  add_option(app, "--leave-out", o->leave_out, leave_out_from, "WHAT",
             "angle, wavelength, angle,wavelength or none\n[what the data allow; wavelengths if there are 3]");
  add_option(app, "--reflectance", o->selection.reflectance, reflectance_from, "NM:R[,NM:R...]",
             "Divide f11 by these reflectances, each at a\nwavelength in nm, linear between them");
  add_weights_option(app, o->weights);
  add_option(app, "--format", o->format, format_from, "FORMAT", "text, csv or json [text]");
  set_footer(app, footer);
  return [o] { select(*o); };
}

}  // namespace mmbrdf::program
