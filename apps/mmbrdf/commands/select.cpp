// SPDX-License-Identifier: BSD-3-Clause
// mmbrdf select

#include <memory>
#include <optional>

#include "command.hpp"
#include "mmbrdf/fitting/selection.hpp"
#include "options/arguments.hpp"
#include "options/certificate.hpp"
#include "options/files.hpp"
#include "pages/output.hpp"
#include "pages/select_report.hpp"

namespace mmbrdf::program {

namespace {

struct Options {
  std::string data;
  SelectionOptions selection;
  std::optional<std::vector<double>> wavelengths_nm;
  SampleTable table;
  FoldOptions folds;
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

void select(const Options& options) {
  const std::string name = data_name(options.data);
  const std::vector<Sample> samples = samples_at(options.data, options.wavelengths_nm, options.table);
  try {
    const Folds left_out = folds(samples, options.folds);
    if (!left_out.note.empty()) note(left_out.note);
    const Selection selection = select_model(samples, left_out.partitions, options.selection, options.weights);
    print({name, to_string(options.weights), static_cast<long>(samples.size()), wavelengths(samples), options.selection,
           left_out.partitions, selection},
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
  add_option(app, "--orders-f11", o->selection.orders_f11, orders_range, "A:B", "Orders of f11 [2:9; anisotropic 1:4]");
  add_option(app, "--orders-other", o->selection.orders_other, orders_range, "A:B",
             "Orders of the other elements [2:6; anisotropic 1:3]");
  add_option(app, "--powers", o->selection.powers, orders_range, "A:B",
             "Highest powers of the wavelength [0:1; 0 for one wavelength]");
}

}  // namespace

Run select_command(CLI::App& app, const CommandLine&) {
  const auto o = std::make_shared<Options>();
  add_file(app, "DATA.csv", o->data, " ", "Samples; - is standard input").required();
  add_option(app, "-w,--wavelength", o->wavelengths_nm, numbers, "NM[,NM...]", "Use these wavelengths only, in nm");
  add_table_options(app, o->table);
  add_option(app, "--basis", o->selection.family, family_from, "NAME",
             "isotropic, germer2017 or anisotropic [isotropic]");
  add_option(app, "--mapping", o->selection.mapping, disc_mapping_from, "NAME",
             "Hemisphere to disc: lambert or projected [lambert]");
  add_ranges(app, o);
  add_option(app, "--folds", o->folds.folds, whole_number, "K",
             "Folds of samples: number of the direction modulo K;\nrows of one direction stay together [3]");
  add_flag(app, "--random-folds", o->folds.random, "Take random folds instead");
  add_option(app, "--seed", o->folds.seed, seed, "SEED", "Of the random folds [1]");
  add_option(app, "--leave-out", o->folds.leave_out, leave_out_from, "WHAT",
             "angle, wavelength, angle,wavelength or none\n[what the data allow; wavelengths if there are 3]");
  add_option(app, "--reflectance", o->selection.reflectance, reflectance_of_fit, "NM:R[,...]|FILE",
             "Divide f11 by these reflectances, each at a\nwavelength in nm, linear between them");
  add_weights_option(app, o->weights);
  add_option(app, "--format", o->format, format_from, "FORMAT", "text, csv, json or html [text]");
  set_footer(app, footer);
  return [o] { select(*o); };
}

}  // namespace mmbrdf::program
