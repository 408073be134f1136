// SPDX-License-Identifier: BSD-3-Clause
// What commands know of CLI11, which takes a compiler seconds for each source that reads it: option.cpp and main.cpp
// alone do.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace mmbrdf::program {

/// Exit status 2.
struct WrongUsage : std::runtime_error {
  using std::runtime_error::runtime_error;
  WrongUsage(const std::string& option, const std::string& what) : runtime_error(option + ": " + what) {}
};
inline WrongUsage missing(const std::string& option) { return WrongUsage(option + " is required"); }

/// One that was declared.
class Option {
 public:
  Option() = default;
  explicit Option(CLI::Option* option) : option_(option) {}

  Option required(bool is_required = true) const;
  Option option_text(const std::string& shown) const;
  Option description(const std::string& text) const;
  Option needs(const Option& other) const;
  Option excludes(const Option& other) const;
  Option excludes(const std::string& name) const;

 private:
  CLI::Option* option_ = nullptr;
};

/// `shown` is what the help prints after the option's name.
Option add_text(CLI::App& app, const std::string& names, std::string& target, const std::string& shown,
                const std::string& description);

/// Files that are arguments, one or more.
Option add_files(CLI::App& app, const std::string& name, std::vector<std::string>& target,
                 const std::string& description);

/// May be given again: each value is added to the others.
Option add_texts(CLI::App& app, const std::string& names, std::vector<std::string>& target, const std::string& shown,
                 const std::string& description);

/// `use` may throw WrongUsage.
Option add_used(CLI::App& app, const std::string& names, const std::function<void(const std::string&)>& use,
                const std::string& shown, const std::string& description);

Option add_flag(CLI::App& app, const std::string& names, bool& target, const std::string& description);

/// What the help prints below the options.
void set_footer(CLI::App& app, const std::string& footer);

/// A word as a shell takes it for one: in quotes if need be.
std::string shell_quoted(const std::string& word);

}  // namespace mmbrdf::program
