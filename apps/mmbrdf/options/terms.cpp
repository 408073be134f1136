// SPDX-License-Identifier: BSD-3-Clause
#include "options/terms.hpp"

#include "options/arguments.hpp"

namespace mmbrdf::program {

namespace {

/// VALUE with the unit that belongs to the error: a part of 1 or %, or degrees. As a part of 1, or in radians.
double uncertainty_from(const std::string& text, ErrorOf what) {
  const bool angle = what == ErrorOf::theta_i || what == ErrorOf::theta_r || what == ErrorOf::azimuth;
  const std::string unit = angle ? "deg" : "%";
  const bool with_unit = text.ends_with(unit);
  const double value = number(with_unit ? text.substr(0, text.size() - unit.size()) : text);
  if (value < 0) throw std::invalid_argument("\"" + text + "\": expected 0 or more");
  return angle ? radians(value) : with_unit ? value / 100 : value;
}

double freedom_from(const std::string& text) {
  const double freedom = number(text);
  if (freedom < 1) throw std::invalid_argument("\"dof=" + text + "\": expected 1 or more");
  return freedom;
}

/// k, which nobody has below 1, nor at 20 or more: who types 0.95 or 95 means a probability.
double coverage_from(const std::string& text) {
  constexpr double least = 1, per_cent = 20;
  const double factor = number(text);
  if (factor < least || factor >= per_cent)
    throw std::invalid_argument("\"" + text +
                                "\": expected a coverage factor k, as 2; U of 95 % coverage is in the budget anyway");
  return factor;
}

TypeBTerm term_from(const std::string& text) {
  const std::size_t equals = text.find('='), dof = text.find(",dof=");
  if (equals == std::string::npos)
    throw std::invalid_argument("\"" + text + "\": expected [NAME:]KIND=VALUE, as in scale=0.3% or plaque:scale=0.003");
  const std::string name = text.substr(0, equals);
  const std::size_t colon = name.rfind(':');
  const ErrorOf what = error_from(colon == std::string::npos ? name : name.substr(colon + 1));
  TypeBTerm term{colon == std::string::npos ? name : name.substr(0, colon), what,
                 uncertainty_from(text.substr(equals + 1, dof - equals - 1), what)};
  if (dof != std::string::npos) term.freedom = freedom_from(text.substr(dof + 5));
  return term;
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
