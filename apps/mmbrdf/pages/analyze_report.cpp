// SPDX-License-Identifier: BSD-3-Clause
#include "pages/analyze_report.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>

#include "pages/describe.hpp"
#include "pages/output.hpp"

namespace mmbrdf::program {

namespace {

const char* unit_of(const std::string& quantity) { return quantity.starts_with("f") ? " sr^-1" : ""; }

std::string validity_words(Outside outside) {
  const std::string name = to_string(outside);
  if (outside == inside) return name + ", inside the fitted range";
  return leaves_known_range(outside) ? name + ", outside the fitted range: the model extrapolates"
                                     : name + ", the fitted range is not known";
}

std::string estimable_words(const std::optional<bool>& estimable) {
  return !estimable   ? "not known"
         : *estimable ? "yes, the data of the fit determine every element here"
                      : "no, the data of the fit leave elements free here: uncertainties are too small";
}

std::string realizable_words(const Analysis& a) {
  if (a.realizable) return "yes, a scatterer can have this matrix";
  return a.elements(0, 0) > 0 ? "no, no scatterer can have this matrix: eigenvalue_min is negative"
                              : "no, no scatterer can have this matrix: f11 is not positive";
}

std::string uncertainty_words(const AnalysisReport& r) {
  const AnalysisOptions& options = r.analyzer.options();
  if (!r.analysis.budget) {
    return r.analyzer.unknown_uncertainty().empty() ? "not known: at theta_r = 90 a term theta_r has no limit"
                                                    : "not known: " + r.analyzer.unknown_uncertainty();
  }
  const bool has_instrument = r.analyzer.model().provenance.contains("instrument");
  const std::string alone = has_instrument ? "of the fit and its instrument" : "of the fit alone";
  const std::string among =
      has_instrument ? "of the fit, its instrument and the terms below" : "of the fit and of the terms below";
  const std::string text = options.terms.empty() ? alone + ": --term adds the rest of a budget" : among;
  return "standard (k = 1), " + text +
         (options.draws > 0 ? "; of ratios from " + std::to_string(options.draws) + " draws" : "");
}

/// As many decimals as two digits of the uncertainty have: the last one of 0.0123 is the second after its first.
std::string to_digits_of(double value, const std::optional<double>& uncertainty) {
  const int decimals =
      uncertainty && *uncertainty > 0 ? 1 - static_cast<int>(std::floor(std::log10(*uncertainty))) : -1;
  return decimals < 0 || decimals > 12 ? format("%.6g", value) : format("%.*f", decimals, value);
}

void print_quantity(const Quantity& q, const Analysis& a) {
  std::cout << format("%-24s", q.name.c_str());
  if (!q.value) {
    std::cout << (a.elements(0, 0) > 0 ? "has no meaning here\n" : "has no meaning where f11 is not positive\n");
    return;
  }
  std::cout << rounded(*q.value, q.uncertainty) << unit_of(q.name);
  if (q.low && q.high) {
    std::cout << "   95 % from " << to_digits_of(*q.low, q.uncertainty) << " to "
              << to_digits_of(*q.high, q.uncertainty);
  }
  std::cout << '\n';
}

void print_matrix(const Mueller& m) {
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      const double value = m(row, column);
      std::cout << format("%16.10f", std::abs(value) < 5e-11 ? 0 : value);  // no -0.0000000000
    }
    std::cout << '\n';
  }
}

/// u of f11 and of D from one covariance, in the sp frame.
struct Contribution {
  double f11 = 0;
  std::optional<double> depolarization;
};

Contribution contribution(const MuellerCovariance& covariance, const Mueller& elements) {
  Contribution result{standard_uncertainty(covariance)(0, 0), std::nullopt};
  if (elements(0, 0) > 0) result.depolarization = standard_uncertainty(depolarization_gradient(elements), covariance);
  return result;
}

/// What is left of a cancellation, such as of a scale in a ratio, is 0.
double without_rounding(double u, double total) {
  constexpr double rounding = 1e-6;
  return u > rounding * total ? u : 0;
}

/// "0.000316   9.3 %": u, and its part of the variance.
std::string with_share(double u, double total) {
  const double part = total > 0 ? u / total : 0;
  return format("%10.3g %6.1f %%", u, 100 * part * part);
}

/// Of terms, then of the total. `elements` are in the frame of the budget.
std::vector<std::pair<std::string, Contribution>> contributions(const Budget& budget, const Mueller& elements) {
  const Contribution total = contribution(budget.total, elements);
  std::vector<std::pair<std::string, Contribution>> result;
  for (const BudgetTerm& term : budget.terms) {
    Contribution c = contribution(term.covariance, elements);
    if (c.depolarization) c.depolarization = without_rounding(*c.depolarization, *total.depolarization);
    result.emplace_back(term.name, c);
  }
  result.emplace_back("total", total);
  return result;
}

void print_budget(const AnalysisReport& r) {
  const auto rows = contributions(*r.analysis.budget, r.analysis.elements_sp);
  const Contribution& total = rows.back().second;
  std::cout << "\nterm                     u(f11)    share   u(depol.)    share\n";
  for (const auto& [name, c] : rows) {
    std::cout << format("%-20.20s ", name.c_str()) << with_share(c.f11, total.f11);
    if (c.depolarization) std::cout << "  " << with_share(*c.depolarization, *total.depolarization);
    std::cout << '\n';
  }
}

nlohmann::ordered_json number_or_null(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nullptr;
}

nlohmann::ordered_json rows_of(const std::optional<Mueller>& m) {
  if (!m) return nullptr;
  nlohmann::ordered_json rows;
  for (std::size_t row = 0; row < 4; ++row)
    rows.push_back(std::vector<double>(&m->elements[4 * row], &m->elements[4 * row] + 4));
  return rows;
}

}  // namespace

std::string rounded(double value, const std::optional<double>& uncertainty) {
  return to_digits_of(value, uncertainty) +
         (uncertainty ? " +- " + (*uncertainty > 0 ? to_digits_of(*uncertainty, uncertainty) : "0") : "");
}

void print_text(const AnalysisReport& r) {
  const Analysis& a = r.analysis;
  std::cout << heading(r.place) << "validity: " << validity_words(a.outside)
            << "\nestimable: " << estimable_words(a.estimable) << "\nrealizable: " << realizable_words(a)
            << "\nuncertainties: " << uncertainty_words(r) << "\n\n";
  print_quantity({.name = "f11",
                  .value = a.elements(0, 0),
                  .uncertainty = a.uncertainties ? std::optional((*a.uncertainties)(0, 0)) : std::nullopt},
                 a);
  for (const Quantity& quantity : a.quantities) print_quantity(quantity, a);
  std::cout << "\nMueller BRDF in sr^-1, frame " << to_string(r.question.frame) << " ("
            << convention_note(r.question.frame) << ")"
            << (r.place.rotation == Rotation::as_printed ? ", as printed" : "") << '\n';
  print_matrix(a.elements);
  if (a.uncertainties) {
    std::cout << "its standard uncertainties\n";
    print_matrix(*a.uncertainties);
  }
  if (a.budget && a.budget->terms.size() > 1) print_budget(r);
}

void print_json(const AnalysisReport& r) {
  const Analysis& a = r.analysis;
  nlohmann::ordered_json json = to_json(r.place);
  add_frame(json, r.question.frame, r.place.rotation);
  json["unit"] = "sr^-1";
  json["validity"] = to_string(a.outside);
  json["estimable"] = a.estimable ? nlohmann::ordered_json(*a.estimable) : nullptr;
  json["realizable"] = a.realizable;
  json["mueller"] = rows_of(a.elements);
  json["u_mueller"] = rows_of(a.uncertainties);
  for (const Quantity& q : a.quantities) {
    nlohmann::ordered_json entry{{"value", number_or_null(q.value)}, {"uncertainty", number_or_null(q.uncertainty)}};
    if (q.has_interval) {
      entry["low"] = number_or_null(q.low);
      entry["high"] = number_or_null(q.high);
    }
    json["quantities"][q.name] = entry;
  }
  json["budget"] = nullptr;
  if (a.budget) {
    json["budget"] = nlohmann::ordered_json::array();
    for (const auto& [name, c] : contributions(*a.budget, a.elements_sp)) {
      json["budget"].push_back(
          {{"term", name}, {"u_f11", c.f11}, {"u_depolarization", number_or_null(c.depolarization)}});
    }
  }
  print(json);
}

}  // namespace mmbrdf::program
