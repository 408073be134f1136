// SPDX-License-Identifier: BSD-3-Clause
// mmbrdf plot: a picture of a model or of samples, drawn by the Python package.

#include <CLI/CLI.hpp>
#include <algorithm>

#include "command.hpp"
#include "options/option.hpp"
#include "streams/python.hpp"

namespace mmbrdf::program {

namespace {

constexpr const char* footer =
    "mmbrdf plot KIND MODEL [DATA.csv] -o FILE.pdf|.png|.svg [options]\n"
    "\n"
    "Python draws it, with the package mmbrdf and matplotlib; MMBRDF_PYTHON names the interpreter [python3]. KIND is "
    "a\n"
    "function of mmbrdf.plot: hemisphere, map, residual-map, in-plane-curves, polar-in-plane, reflectance-factor,\n"
    "reflectance-against-angle, reflectance-against-wavelength, by-wavelength, uncertainty-parts, anisotropy,\n"
    "coefficient-spectrum, depolarization-map, realizability-map, residuals, directions, suspicious,\n"
    "low-order-residuals or calibration.\n"
    "mmbrdf plot map --help tells the options. --columns, --skip-incomplete, --frame and --convention are of the table "
    "of\n"
    "samples, as in mmbrdf fit; --shown-frame is the frame of the picture.\n"
    "\n"
    "Examples:\n"
    "  mmbrdf plot hemisphere ptfe -w 532 -i 60 -o hemisphere.pdf --width 17\n"
    "  mmbrdf plot in-plane-curves sample.json data.csv -w 532 -i 45 -o curves.svg --width 8\n"
    "  mmbrdf plot residuals sample.json lab.csv --columns theta_i_deg=AOI --frame sp -o residuals.pdf\n"
    "  mmbrdf plot reflectance-factor ptfe -w 443,555,670 --view 0,0 --view 45,180 -o plaque.png";

}  // namespace

Run plot_command(CLI::App& app, const CommandLine& line) {
  app.prefix_command();
  set_footer(app, footer);
  std::vector<std::string> words = line.words;
  const auto own = std::ranges::find(words, "plot");
  words.erase(words.begin(), own == words.end() ? own : own + 1);
  return [words] {
    if (words.empty()) throw missing("KIND");
    become_python("plot", "mmbrdf.plot.__main__", words);
  };
}

}  // namespace mmbrdf::program
