// SPDX-License-Identifier: BSD-3-Clause
// mmbrdf export

#include "mmbrdf/formats/export.hpp"

#include <memory>

#include "command.hpp"
#include "mmbrdf/files/write_file.hpp"
#include "options/arguments.hpp"
#include "options/files.hpp"
#include "pages/output.hpp"

namespace mmbrdf::program {

namespace {

struct Options {
  std::string model, output, format, channel = "f11";
  std::optional<std::vector<double>> wavelengths_nm;
  std::optional<double> error_percent;
  int streams = 0, moments = 0;
  std::vector<double> suns_deg, views_deg, azimuths_deg;
};

/// By --as, or by the ending of the file.
const ExportFormat& format_of(const Options& options) {
  try {
    return options.format.empty() ? export_format_of(options.output) : export_format(options.format);
  } catch (const std::invalid_argument& error) {
    throw WrongUsage(options.format.empty() ? "FILE" : "--as", error.what());
  }
}

/// Of the formats that take angles of radiative transfer.
void require_transfer_options(const ExportFormat& format, const Options& o) {
  const bool vlidort = format.name == "vlidort";
  if (vlidort && o.streams == 0) throw missing("--streams");
  if (o.suns_deg.empty()) throw missing("--sun");
  if (o.views_deg.empty() && (!vlidort || !o.azimuths_deg.empty())) throw missing("--view");
  if (o.azimuths_deg.empty() && !o.views_deg.empty()) throw missing("--azimuth");
}

std::vector<double> in_radians(const std::vector<double>& degrees) {
  std::vector<double> result;
  for (const double one : degrees) result.push_back(radians(one));
  return result;
}

void export_model(const Options& options) {
  if (is_standard_output(options.output))
    throw WrongUsage("FILE", "\"-\": expected the name of a file; tables do not go to standard output");
  const ExportFormat& format = format_of(options);
  if (format.takes_transfer) require_transfer_options(format, options);
  if (options.error_percent && !format.takes_error)
    throw WrongUsage("--error", "a " + std::string(format.name) + " file has a grid of its own: leave it out");
  require_model_kept(options.model, options.output);
  const Model model = open_model(options.model);
  ExportOptions asked{.channel = options.channel};
  if (options.error_percent) asked.error = *options.error_percent / 100;
  if (options.wavelengths_nm) asked.wavelengths = micrometres(*options.wavelengths_nm);
  asked.transfer = {options.streams, options.moments, in_radians(options.suns_deg), in_radians(options.views_deg),
                    in_radians(options.azimuths_deg)};
  const Export table(model, format, asked);
  write_file(options.output, [&](std::ostream& out) { table.write(out); });
  note(options.output + ": " + table.understood());
}

std::string footer() {
  std::string text = "FILE is in the format that its ending says, or --as:\n";
  for (const ExportFormat& format : export_formats())
    text += program::format("  %-9s %-10s %s\n", std::string(format.name).c_str(), std::string(format.ending).c_str(),
                            std::string(format.meaning).c_str());
  return text +
         "A note says which table was written and what those who read it find: programs interpolate in it, and the "
         "coarsest\n"
         "table is taken whose rms error is at most --error. docs/formats.md says what readers make of each.\n"
         "\n"
         "Examples:\n"
         "  mmbrdf export ptfe plaque.pbsdf --wavelength 450,500,550,600,650\n"
         "  mmbrdf export ptfe-532 plaque.pbsdf --error 0.02\n"
         "  mmbrdf export ptfe-532 plaque.astm --channel f_ss\n"
         "  mmbrdf export ptfe plaque.nc\n"
         "  mmbrdf export ptfe-532 plaque.vlidort --streams 8 --sun 30,60 --view 0,40 --azimuth 0,90,180\n"
         "  mmbrdf export ptfe-532 plaque.6s --sun 30 --view 10 --azimuth 40";
}

}  // namespace

Run export_command(CLI::App& app, const CommandLine&) {
  const auto o = std::make_shared<Options>();
  add_model(app, o->model);
  add_file(app, "FILE", o->output, " ", "File to write").required();
  add_text(app, "--as", o->format, "FORMAT", "Format, whatever the ending of FILE");
  add_option(app, "-w,--wavelength", o->wavelengths_nm, numbers, "NM[,NM...]",
             "Wavelengths of the table, in nm [those of the fit]");
  add_text(app, "--channel", o->channel, "NAME",
           "What a format without polarization holds: f11, or a\nquantity of analyze in sr^-1, as f_ss [f11]");
  add_option(app, "--error", o->error_percent, positive_number, "PERCENT",
             "Largest rms error of what is interpolated in the\ntable, in percent of f11 [0.05]; not of bird, "
             "klems,\nvlidort and 6s, whose grids are given");
  add_option(app, "--streams", o->streams, whole_number, "N",
             "Of vlidort: cosines in a hemisphere, Gauss-Legendre on 0 to 1");
  add_option(app, "--moments", o->moments, whole_number, "M", "Of vlidort: how many, at most 2 N [2 N]");
  add_option(app, "--sun", o->suns_deg, numbers, "DEG[,DEG...]", "Of vlidort and 6s: polar angles of the sun");
  add_option(app, "--view", o->views_deg, numbers, "DEG[,DEG...]", "Of vlidort and 6s: polar angles of the view");
  add_option(app, "--azimuth", o->azimuths_deg, numbers, "DEG[,DEG...]",
             "Of vlidort and 6s: phi_r - phi_i, 180 is forward");
  set_footer(app, footer());
  return [o] { export_model(*o); };
}

}  // namespace mmbrdf::program
