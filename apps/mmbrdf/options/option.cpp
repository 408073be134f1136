// SPDX-License-Identifier: BSD-3-Clause
#include "options/option.hpp"

#include <CLI/CLI.hpp>

namespace mmbrdf::program {

Option Option::required(bool is_required) const { return Option(option_->required(is_required)); }
Option Option::option_text(const std::string& shown) const { return Option(option_->option_text(shown)); }
Option Option::description(const std::string& text) const { return Option(option_->description(text)); }
Option Option::needs(const Option& other) const { return Option(option_->needs(other.option_)); }
Option Option::excludes(const Option& other) const { return Option(option_->excludes(other.option_)); }
Option Option::excludes(const std::string& name) const { return Option(option_->excludes(name)); }

Option add_text(CLI::App& app, const std::string& names, std::string& target, const std::string& shown,
                const std::string& description) {
  return Option(app.add_option(names, target, description)->option_text(shown));
}

Option add_texts(CLI::App& app, const std::string& names, std::vector<std::string>& target, const std::string& shown,
                 const std::string& description) {
  return Option(app.add_option(names, target, description)->option_text(shown)->allow_extra_args(false));
}

Option add_files(CLI::App& app, const std::string& name, std::vector<std::string>& target,
                 const std::string& description) {
  return Option(app.add_option(name, target, description)->option_text(" "));
}

Option add_used(CLI::App& app, const std::string& names, const std::function<void(const std::string&)>& use,
                const std::string& shown, const std::string& description) {
  return Option(app.add_option_function<std::string>(names, use, description)->option_text(shown));
}

Option add_flag(CLI::App& app, const std::string& names, bool& target, const std::string& description) {
  return Option(app.add_flag(names, target, description));
}

void set_footer(CLI::App& app, const std::string& footer) { app.footer(footer); }

std::string shell_quoted(const std::string& word) {
  const std::string plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./:,=+@%-";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string result = "'";
  for (const char c : word) result += c == '\'' ? "'\\''" : std::string(1, c);
  return result + "'";
}

}  // namespace mmbrdf::program
