// SPDX-License-Identifier: BSD-3-Clause
// What main.cpp and the commands know of each other.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace mmbrdf::program {

/// The words of the command line, for the provenance of what is written.
struct CommandLine {
  std::vector<std::string> words;

  /// As one would type it in a shell, but with the folders left out of these paths.
  std::string text(const std::vector<std::string>& paths) const;
};

/// "mmbrdf 1.2.3"
std::string software();

/// A command once its options are read.
using Run = std::function<void()>;

/// Each declares the options and the help of one command, and returns what it does. Degrees and nanometres are known
/// to these functions only.
Run evaluate_command(CLI::App& app, const CommandLine& line);
Run analyze_command(CLI::App& app, const CommandLine& line);
Run integrate_command(CLI::App& app, const CommandLine& line);
Run fit_command(CLI::App& app, const CommandLine& line);
Run select_command(CLI::App& app, const CommandLine& line);
Run inspect_command(CLI::App& app, const CommandLine& line);
Run plan_command(CLI::App& app, const CommandLine& line);
Run subsets_command(CLI::App& app, const CommandLine& line);
Run compare_command(CLI::App& app, const CommandLine& line);
Run report_command(CLI::App& app, const CommandLine& line);
Run plot_command(CLI::App& app, const CommandLine& line);
Run simulate_command(CLI::App& app, const CommandLine& line);
Run calibrate_command(CLI::App& app, const CommandLine& line);
Run instrument_command(CLI::App& app, const CommandLine& line);
Run reduce_command(CLI::App& app, const CommandLine& line);
Run info_command(CLI::App& app, const CommandLine& line);
Run materials_command(CLI::App& app, const CommandLine& line);
Run convert_command(CLI::App& app, const CommandLine& line);
Run export_command(CLI::App& app, const CommandLine& line);
Run moments_command(CLI::App& app, const CommandLine& line);

}  // namespace mmbrdf::program
