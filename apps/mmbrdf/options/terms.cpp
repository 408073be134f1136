// SPDX-License-Identifier: BSD-3-Clause
#include "options/terms.hpp"

#include "options/arguments.hpp"

namespace mmbrdf::program {

namespace {

/// k, which nobody has below 1, nor at 20 or more: who types 0.95 or 95 means a probability.
double coverage_from(const std::string& text) {
  constexpr double least = 1, per_cent = 20;
  const double factor = number(text);
  if (factor < least || factor >= per_cent)
    throw std::invalid_argument("\"" + text +
                                "\": expected a coverage factor k, as 2; U of 95 % coverage is in the budget anyway");
  return factor;
}

}  // namespace

const char* const terms_help =
    "--term: KIND is scale (relative), theta_i, theta_r or azimuth (degrees), calibration (of each element divided by\n"
    "f11). Errors of terms are independent of each other, and each is the same at all geometries. With --budget: what\n"
    "each contributes, the effective degrees of freedom (Welch and Satterthwaite), k of 95 % coverage (Student; 2 "
    "where\n"
    "they are infinite) and U = k u; --coverage 2 adds U = 2 u. The fit has the degrees of freedom rows less rank, "
    "where\n"
    "its model knows the rows; a term those given, or infinitely many.\n";

void add_terms(CLI::App& app, Terms& terms) {
  add_term(app, terms,
           "Add a standard uncertainty that the fit cannot know, as in\nscale=0.3%, theta_r=0.02deg, "
           "calibration=0.001; repeatable");
  const Option budget =
      add_flag(app, "--budget", terms.budget, "Print the budget of each value, and its expanded\nuncertainty");
  add_option(app, "--coverage", terms.coverage, coverage_from, "K",
             "In the budget also U = K u, as a certificate has it with\nK = 2")
      .needs(budget);
}

Option add_term(CLI::App& app, Terms& terms, const std::string& description) {
  return add_texts(app, "--term", terms.texts, "[NAME:]KIND=U[,dof=N]", description);
}

std::vector<TypeBTerm> terms_from(const Terms& terms) {
  std::vector<TypeBTerm> result;
  for (const std::string& text : terms.texts) result.push_back(parsed("--term", text, term_from));
  return result;
}

}  // namespace mmbrdf::program
