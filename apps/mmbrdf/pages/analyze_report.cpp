// SPDX-License-Identifier: BSD-3-Clause
#include "pages/analyze_report.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "mmbrdf/model/at_wavelengths.hpp"
#include "mmbrdf/model/description.hpp"
#include "mmbrdf/text/rounding.hpp"
#include "pages/budget.hpp"
#include "pages/describe.hpp"
#include "pages/output.hpp"

namespace mmbrdf::program {

namespace {

std::string validity_words(Outside outside) {
  const std::string name = to_string(outside);
  if (outside == inside) return name + ", inside the fitted range";
  if (leaves_known_range(outside)) return name + ", outside the fitted range: the model extrapolates";
  return name + (outside == interpolated ? ", between fitted wavelengths" : ", the fitted range is not known");
}

std::string estimable_words(const Answer& a) {
  if (!a.estimable) return "not known";
  if (*a.estimable)
    return unknown_elements(a.elements).any() ? "yes, the data of the fit determine every element that was measured"
                                              : "yes, the data of the fit determine every element here";
  return leaves_known_range(a.outside)
             ? "no, no data of the fit reach here: uncertainties are not verified"
             : "no, the data of the fit leave elements free here: uncertainties are too small";
}

std::string realizable_words(const Answer& a) {
  if (!a.realizable) return "not known, " + not_measured_line(unknown_elements(a.elements));
  if (*a.realizable) return "yes, a scatterer can have this matrix";
  return a.elements(0, 0) > 0 ? "no, no scatterer can have this matrix: eigenvalue_min is negative"
                              : "no, no scatterer can have this matrix: f11 is not positive";
}

std::string uncertainty_words(const AnalysisReport& r) {
  const AnswerOptions& options = r.answers.options();
  if (!r.answer.budget) {
    return r.answers.unknown_uncertainty().empty() ? "not known: at theta_r = 90 a term theta_r has no limit"
                                                   : "not known: " + r.answers.unknown_uncertainty();
  }
  const std::string of_what = uncertain_of(r.answers.model());
  const std::string text =
      !options.terms.empty() ? " and of the terms below"
                             : std::string(of_what == "the fit" ? " alone" : "") + ": --term adds the rest of a budget";
  return "standard (k = 1), of " + of_what + text +
         (options.draws > 0 ? "; of ratios from " + std::to_string(options.draws) + " draws" : "");
}

std::string quantity_text(const Answered& q, std::string_view name, std::string_view unit, const Answer& a) {
  std::string text = format("%-24.*s", static_cast<int>(name.size()), name.data());
  if (!q.known) return text + "-  not measured\n";
  if (!q.value)
    return text + (a.elements(0, 0) > 0 ? "has no meaning here\n" : "has no meaning where f11 is not positive\n");
  const auto u = q.uncertainty ? std::optional(without_rounding(*q.uncertainty)) : std::nullopt;
  text += to_place_of(without_rounding(*q.value), u) + (u ? " +- " + to_place_of(*u, u) : "") +
          (unit.empty() ? "" : " ") + std::string(unit);
  if (q.low && q.high) text += "   95 % from " + to_place_of(*q.low, u) + " to " + to_place_of(*q.high, u);
  return text + "\n";
}

/// u of f11 and of the depolarization from one term of a budget, or from all.
struct Share {
  std::string_view term;
  double f11 = 0;
  std::optional<double> depolarization = {};
};

/// "0.00032   9.3 %": u, and its part of the variance.
std::string with_share(double u, double total) {
  const double part = total > 0 ? u / total : 0;
  return format("%10s %6.1f %%", to_place_of(u, u).c_str(), 100 * part * part);
}

std::vector<Share> shares(const Answer& a) {
  std::vector<Share> result;
  for (const BudgetTerm& term : a.budget->terms)
    result.push_back({term.name, standard_uncertainty(term.covariance)(0, 0)});
  result.push_back({"total", standard_uncertainty(a.budget->total)(0, 0)});
  const Answered& depolarization = a.quantities.front();
  for (std::size_t i = 0; i < depolarization.parts.size(); ++i) result[i].depolarization = depolarization.parts[i];
  return result;
}

std::string shares_text(const Answer& a) {
  const std::vector<Share> rows = shares(a);
  const Share& total = rows.back();
  std::string text = "\nterm                      u(f11)    share   u(depol.)    share\n";
  for (const Share& c : rows) {
    text += format("%-21.21s ", std::string(c.term).c_str()) + with_share(c.f11, total.f11);
    if (c.depolarization) text += "  " + with_share(*c.depolarization, *total.depolarization);
    text += "\n";
  }
  return text;
}

/// Of f11 and of each quantity that has a meaning, in first order.
std::vector<BudgetLine> budget_lines(const Answer& a) {
  Mueller f11;
  f11(0, 0) = 1;
  std::vector<BudgetLine> lines{{"f11", a.elements(0, 0), expanded(contributions(*a.budget, f11))}};
  for (const Answered& q : a.quantities) {
    if (!q.value) continue;
    std::vector<Contribution> parts;
    for (std::size_t i = 0; i < a.budget->terms.size(); ++i)
      parts.push_back({a.budget->terms[i].name, q.parts[i], a.budget->terms[i].freedom});
    lines.push_back({std::string(q.quantity->name), *q.value, expanded(std::move(parts))});
  }
  return lines;
}

nlohmann::ordered_json number_or_null(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nullptr;
}

void append(std::string& text, const std::optional<double>& value) {
  text += ',';
  if (value && !std::isnan(*value)) append_exact(text, *value);
}

std::string columns(const Answers& answers) {
  std::string text = element_columns(false) + ",validity";
  for (std::size_t element = 0; element < 16; ++element) text += ",u_f" + element_name(element);
  for (const Quantity& quantity : quantities(answers.options().light.has_value())) {
    const std::string name(quantity.name);
    text += "," + name + ",u_" + name;
    text += answers.has_interval(quantity) ? "," + name + "_low," + name + "_high" : "";
  }
  return text + ",realizable,estimable";
}

void append_fields(std::string& text, const Answer& a, const Answers& answers) {
  append_elements(text, a.elements);
  text += ',' + to_string(a.outside);
  for (std::size_t element = 0; element < 16; ++element)
    append(text, a.uncertainties ? std::optional(a.uncertainties->elements[element]) : std::nullopt);
  for (const Answered& q : a.quantities) {
    append(text, q.value);
    append(text, q.uncertainty);
    if (answers.has_interval(*q.quantity)) {
      append(text, q.low);
      append(text, q.high);
    }
  }
  text += a.realizable ? *a.realizable ? ",1," : ",0," : ",,";
  if (a.estimable) text += *a.estimable ? '1' : '0';
}

/// Draws of several wavelengths are kept while they are not more than some 160 MB.
std::size_t wavelengths_to_keep(int draws) {
  return draws > 0 ? static_cast<std::size_t>(std::clamp(20000 / draws, 1, 16)) : 16;
}

}  // namespace

Page page_of(const AnalysisReport& r) {
  const Answer& a = r.answer;
  std::string text = heading(r.place) + "validity: " + validity_words(a.outside) +
                     "\nestimable: " + estimable_words(a) + "\nrealizable: " + realizable_words(a) +
                     "\nuncertainties: " + uncertainty_words(r) + "\n\n";
  const auto u_f11 = a.uncertainties ? std::optional((*a.uncertainties)(0, 0)) : std::nullopt;
  text += quantity_text({.value = a.elements(0, 0), .uncertainty = u_f11}, "f11", "sr^-1", a);
  for (const Answered& q : a.quantities) text += quantity_text(q, q.quantity->name, q.quantity->unit, a);
  text += "\nMueller BRDF in sr^-1, frame " + to_string(r.question.frame) + " (" + convention_note(r.question.frame) +
          ")" + (r.place.rotation == Rotation::as_printed ? ", as printed" : "") + "\n" +
          matrix_text(a.elements, a.uncertainties);
  if (a.uncertainties) text += "its standard uncertainties\n" + matrix_text(*a.uncertainties, a.uncertainties);
  Page page;
  page.add(text);
  if (a.budget && r.budget) {
    page.add("\n");
    page.add(budget_page(budget_lines(a), r.coverage));
  } else if (a.budget && a.budget->terms.size() > 1) {
    page.add(shares_text(a));
  }
  return page;
}

Json json_of(const AnalysisReport& r) {
  const Answer& a = r.answer;
  nlohmann::ordered_json json = to_json(r.place);
  add_frame(json, r.question.frame, r.place.rotation);
  json["unit"] = "sr^-1";
  json["validity"] = to_string(a.outside);
  json["estimable"] = a.estimable ? nlohmann::ordered_json(*a.estimable) : nullptr;
  json["realizable"] = a.realizable ? nlohmann::ordered_json(*a.realizable) : nullptr;
  json["mueller"] = matrix_json(a.elements);
  json["u_mueller"] = a.uncertainties ? matrix_json(*a.uncertainties) : nullptr;
  for (const Answered& q : a.quantities) {
    nlohmann::ordered_json entry{{"value", number_or_null(q.value)}, {"uncertainty", number_or_null(q.uncertainty)}};
    if (r.answers.has_interval(*q.quantity)) {
      entry["low"] = number_or_null(q.low);
      entry["high"] = number_or_null(q.high);
    }
    json["quantities"][std::string(q.quantity->name)] = entry;
  }
  json["budget"] = nullptr;
  if (a.budget) {
    json["budget"] = nlohmann::ordered_json::array();
    for (const Share& c : shares(a)) {
      json["budget"].push_back(
          {{"term", c.term}, {"u_f11", c.f11}, {"u_depolarization", number_or_null(c.depolarization)}});
    }
  }
  if (a.budget && r.budget)
    for (const auto& [name, value, u] : budget_lines(a)) json["budgets"][name] = budget_json(u, r.coverage);
  return json;
}

void require_inside(Outside outside, const Validity& validity) {
  if (leaves_known_range(outside)) {
    throw std::invalid_argument("outside the fitted range (" + to_string(outside) +
                                "), refused by --strict: fitted are " + fitted_range(validity));
  }
  if (outside & unknown_range) throw std::invalid_argument("the fitted range is not known, refused by --strict");
}

AddedColumns analyzed_columns(const Answers& answers, bool strict) {
  using ByWavelength = AtWavelengths<std::function<PreparedAnswers(double)>>;
  const auto prepared = std::make_shared<ByWavelength>([answers](double wavelength) { return answers.at(wavelength); },
                                                       wavelengths_to_keep(answers.options().draws));
  return {columns(answers), [=](double wavelength, std::span<const Geometry> geometries) {
            std::vector<AddedFields> result;
            for (const Answer& a : (*prepared)(wavelength).at(geometries)) {
              if (strict) require_inside(a.outside, answers.model().validity);
              result.push_back({{}, a.outside});
              append_fields(result.back().text, a, answers);
            }
            return result;
          }};
}

}  // namespace mmbrdf::program
