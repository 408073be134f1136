// SPDX-License-Identifier: BSD-3-Clause
// mmbrdf plot: a picture of a model or of samples, drawn by the Python package.

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <stdexcept>

#include "command.hpp"
#include "options/option.hpp"

namespace mmbrdf::program {

namespace {

/// Python's interpreter, and after it whatever draws the picture, or says in a line why there is none.
constexpr const char* program_of_python =
    "import sys\n"
    "try:\n"
    "    from mmbrdf.plot.__main__ import main\n"
    "except ImportError as error:\n"
    "    sys.exit(f'mmbrdf: plot needs the Python package mmbrdf and matplotlib: {error}')\n"
    "sys.exit(main(prog='mmbrdf plot'))\n";

/// Becomes Python's interpreter; throws std::runtime_error where there is none.
[[noreturn]] void become_python(const std::vector<std::string>& words) {
  const char* chosen = std::getenv("MMBRDF_PYTHON");
  const std::string interpreter = chosen != nullptr && *chosen != '\0' ? chosen : "python3";
  std::vector<std::string> arguments = {interpreter, "-c", program_of_python};
  arguments.insert(arguments.end(), words.begin(), words.end());
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  std::cout.flush();
  ::execvp(pointers.front(), pointers.data());
  throw std::runtime_error("plot is drawn by Python: " + interpreter + ": " + std::strerror(errno) +
                           "; MMBRDF_PYTHON names another interpreter");
}

constexpr const char* footer =
    "mmbrdf plot KIND MODEL [DATA.csv] -o FILE.pdf|.png|.svg [options]\n"
    "\n"
    "Python draws it, with the package mmbrdf and matplotlib; MMBRDF_PYTHON names the interpreter [python3]. KIND is "
    "a\n"
    "function of mmbrdf.plot: hemisphere, map, residual-map, in-plane-curves, polar-in-plane, reflectance-factor,\n"
    "reflectance-against-angle, reflectance-against-wavelength, uncertainty-parts, anisotropy, coefficient-spectrum,\n"
    "depolarization-map, realizability-map, directions, suspicious, low-order-residuals or calibration.\n"
    "mmbrdf plot map --help tells the options.\n"
    "\n"
    "Examples:\n"
    "  mmbrdf plot hemisphere ptfe -w 532 -i 60 -o hemisphere.pdf --width 17\n"
    "  mmbrdf plot in-plane-curves sample.json data.csv -w 532 -i 45 -o curves.svg --width 8\n"
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
    become_python(words);
  };
}

}  // namespace mmbrdf::program
