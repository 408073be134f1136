// SPDX-License-Identifier: BSD-3-Clause
// Errors that the fit cannot know, as they are typed: scale=0.3%, plaque:scale=0.003,dof=12 …
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mmbrdf/uncertainty/budget.hpp"
#include "options/option.hpp"

namespace mmbrdf::program {

/// --term, --budget and --coverage.
struct Terms {
  std::vector<std::string> texts;
  bool budget = false;
  std::optional<double> coverage = {};  ///< k, beside that of 95 %
};
void add_terms(CLI::App& app, Terms& terms);

/// --term alone.
Option add_term(CLI::App& app, Terms& terms, const std::string& description);

/// Throws WrongUsage for a text of another form.
std::vector<TypeBTerm> terms_from(const Terms& terms);

/// What the help says about both.
extern const char* const terms_help;

}  // namespace mmbrdf::program
