// SPDX-License-Identifier: BSD-3-Clause
// The program mmbrdf: a table of commands, and what becomes of errors.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "command.hpp"
#include "mmbrdf/files/write_file.hpp"
#include "options/option.hpp"
#include "pages/output.hpp"
#include "streams/progress.hpp"

namespace mmbrdf::program {

namespace {

struct Command {
  const char* name;
  const char* purpose;
  Run (*declare)(CLI::App&, const CommandLine&);
};

constexpr Command commands[] = {
    {"evaluate", "Print the Mueller BRDF of a model at one geometry, or at each row of a file.", evaluate_command},
    {"analyze", "Print what the Mueller BRDF of a model says, with uncertainties.", analyze_command},
    {"integrate", "Print reflectances of a model, and its means over finite apertures.", integrate_command},
    {"inspect", "Say what measured samples are, and what seems to be wrong with them.", inspect_command},
    {"fit", "Fit a model to measured samples and print how well it fits.", fit_command},
    {"plan", "Say what a measurement will tell, before it is made.", plan_command},
    {"select", "Find the orders and powers that measured samples support.", select_command},
    {"subsets", "Fit parts of the data apart and say how far the fits agree.", subsets_command},
    {"compare", "Say how far a model is from samples or from another model.", compare_command},
    {"report", "Say what a model is and how far it can be trusted.", report_command},
    {"plot", "Draw a picture of a model or of samples, with Python.", plot_command},
    {"simulate", "Make samples that a model would give, with or without noise.", simulate_command},
    {"calibrate", "Find what a polarimeter makes and analyses from readings of references.", calibrate_command},
    {"instrument", "Print what a calibrated polarimeter is and how good.", instrument_command},
    {"reduce", "Turn the readings of a polarimeter into samples, with uncertainties.", reduce_command},
    {"info", "Print what a model holds and where it is valid.", info_command},
    {"materials", "List the built-in models.", materials_command},
    {"convert", "Turn a model, or a measurement of another program, into another format.", convert_command},
    {"export", "Write a model as a table that another program reads.", export_command},
    {"moments", "Print the Fourier moments of a model in azimuth, at cosines of polar angles.", moments_command},
};

constexpr const char* footer =
    "MODEL is the name of a built-in model, a JSON model file or a published coefficient file (CSV).\n"
    "Angles are in degrees, wavelengths in nanometres, BRDFs in sr^-1. Azimuths are those of the directions to the\n"
    "source and to the detector: forward scattering is at phi_r - phi_i = 180. Results go to standard output,\n"
    "warnings to standard error. Exit status: 0, 1 for bad input, 2 for wrong usage.\n"
    "\n"
    "Example:\n"
    "  mmbrdf evaluate ptfe --wavelength 532 --incident 45,0 --reflected 30,180\n"
    "\n"
    "mmbrdf COMMAND --help tells the rest.";

int wrong_usage(const CLI::App& app, const std::exception& error) {
  std::string command = "mmbrdf";
  for (const CLI::App* chosen : app.get_subcommands()) command += " " + chosen->get_name();
  say(error.what());
  std::cerr << "see " << command << " --help\n";
  return 2;
}

/// "A and B are required: ", and what the first of the arguments that are not there may be; empty if all of them are.
std::string missing_arguments(const CLI::App& app) {
  std::vector<std::string> names;
  std::string what;
  for (const CLI::App* chosen : app.get_subcommands())
    for (const CLI::Option* option : chosen->get_options()) {
      if (!option->get_required() || !option->get_positional() || !option->empty()) continue;
      if (names.empty()) what = option->get_description();
      names.push_back(option->get_name());
    }
  if (names.empty()) return "";
  std::ranges::replace(what, '\n', ' ');
  return joined(names, " and ") + (names.size() > 1 ? " are" : " is") + " required: " + what;
}

/// Without the program's name, backwards as CLI11 wants them. "help COMMAND" is "COMMAND --help".
std::vector<std::string> words_to_parse(const CommandLine& line) {
  std::vector<std::string> words = line.words;
  words.erase(words.begin());
  if (!words.empty() && words.front() == "help") {
    words.erase(words.begin());
    words.push_back("--help");
  }
  return {words.rbegin(), words.rend()};
}

extern "C" void leave_nothing_behind(int signal) {
  remove_temporary_files();
  end_progress();
  ::raise(signal);  // which waits for the end of this function, and then does what it does by default
}

/// For the signals that end a program, but for those that were told to be ignored.
void clean_up_at_signals() {
  for (const int signal : {SIGHUP, SIGINT, SIGTERM, SIGPIPE, SIGXCPU, SIGXFSZ, SIGABRT}) {
    struct sigaction before {
    }, action{};
    action.sa_handler = leave_nothing_behind;
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    if (::sigaction(signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN)
      ::sigaction(signal, &action, nullptr);
  }
}

int run(int argc, char** argv) {
  CLI::App app{"Mueller-matrix BRDFs: fit them to measurements, evaluate them anywhere.", "mmbrdf"};
  app.set_version_flag("--version", software(), "Print the version");
  app.set_help_flag("-h,--help", "Print this help");
  app.get_formatter()->column_width(34);
  app.get_formatter()->label("SUBCOMMAND", "COMMAND");
  app.get_formatter()->label("Subcommands", "Commands");
  app.get_formatter()->label("Positionals", "Arguments");
  app.require_subcommand(0, 1);
  app.footer(footer);

  const CommandLine line{{argv, argv + argc}};
  Run chosen = [&app] { std::cout << app.help(); };
  for (const Command& command : commands) {
    CLI::App* subcommand = app.add_subcommand(command.name, command.purpose)->group("Commands");
    // Nineteen commands have hundreds of options: too many to declare for the one that is there.
    if (std::ranges::find(line.words, command.name) == line.words.end()) continue;
    subcommand->parse_complete_callback([&chosen, run = command.declare(*subcommand, line)] { chosen = run; });
  }
  try {
    app.parse(words_to_parse(line));
    chosen();
  } catch (const CLI::CallForHelp&) {
    std::cout << app.help();
  } catch (const CLI::CallForVersion&) {
    std::cout << software() << '\n';
  } catch (const CLI::RequiredError& error) {
    const std::string arguments = missing_arguments(app);
    return wrong_usage(app, arguments.empty() ? std::runtime_error(error.what()) : std::runtime_error(arguments));
  } catch (const CLI::ParseError& error) {
    return wrong_usage(app, error);
  } catch (const WrongUsage& error) {
    return wrong_usage(app, error);
  }
  flush_output();
  return 0;
}

}  // namespace

std::string software() { return "mmbrdf " MMBRDF_VERSION; }

std::string CommandLine::text(const std::vector<std::string>& paths) const {
  std::string result = "mmbrdf";
  for (std::size_t i = 1; i < words.size(); ++i) {
    std::string word = words[i];
    for (const std::string& path : paths) {
      if (!path.empty() && word.ends_with(path)) {  // also in -oPATH and --output=PATH
        word = word.substr(0, word.size() - path.size()) + std::filesystem::path(path).filename().string();
        break;
      }
    }
    result += " " + shell_quoted(word);
  }
  return result;
}

}  // namespace mmbrdf::program

int main(int argc, char** argv) {
  std::ios::sync_with_stdio(false);
  mmbrdf::program::clean_up_at_signals();
  try {
    return mmbrdf::program::run(argc, argv);
  } catch (const std::bad_alloc&) {
    mmbrdf::program::say_failure("out of memory");
    return 1;
  } catch (const std::exception& error) {
    mmbrdf::program::say_failure(error.what());
    return 1;
  }
}
