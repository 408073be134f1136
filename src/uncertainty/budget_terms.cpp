// SPDX-License-Identifier: BSD-3-Clause
// Terms as people type them. Part of budget.hpp.

#include <stdexcept>

#include "mmbrdf/uncertainty/budget.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

double number_of(const std::string& text) {
  try {
    return parse_number(text);
  } catch (const std::invalid_argument&) {
    throw std::invalid_argument(in_quotes(text) + ": expected a number");
  }
}

/// VALUE with the unit that belongs to the error: a part of 1 or %, or degrees. As a part of 1, or in radians.
double uncertainty_from(const std::string& text, ErrorOf what) {
  const bool angle = what == ErrorOf::theta_i || what == ErrorOf::theta_r || what == ErrorOf::azimuth;
  const std::string unit = angle ? "deg" : "%";
  const bool with_unit = text.ends_with(unit);
  const double value = number_of(with_unit ? text.substr(0, text.size() - unit.size()) : text);
  if (value < 0) throw std::invalid_argument(in_quotes(text) + ": expected 0 or more");
  return angle ? radians(value) : with_unit ? value / 100 : value;
}

double freedom_from(const std::string& text) {
  const double freedom = number_of(text);
  if (freedom < 1) throw std::invalid_argument(in_quotes("dof=" + text) + ": expected 1 or more");
  return freedom;
}

}  // namespace

TypeBTerm term_from(const std::string& text) {
  const std::size_t equals = text.find('='), dof = text.find(",dof=");
  if (equals == std::string::npos)
    throw std::invalid_argument(in_quotes(text) +
                                ": expected [NAME:]KIND=VALUE, as in scale=0.3% or plaque:scale=0.003");
  const std::string name = text.substr(0, equals);
  const std::size_t colon = name.rfind(':');
  const ErrorOf what = error_from(colon == std::string::npos ? name : name.substr(colon + 1));
  TypeBTerm term{colon == std::string::npos ? name : name.substr(0, colon), what,
                 uncertainty_from(text.substr(equals + 1, dof - equals - 1), what)};
  if (dof != std::string::npos) term.freedom = freedom_from(text.substr(dof + 5));
  return term;
}

}  // namespace mmbrdf
