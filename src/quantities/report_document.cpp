// SPDX-License-Identifier: BSD-3-Clause
// A report as a document. Part of report.hpp.

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "mmbrdf/quantities/report.hpp"
#include "mmbrdf/text/rounding.hpp"
#include "quantities/report_blocks.hpp"

namespace mmbrdf {
namespace {

constexpr double many = 1e6;  // degrees of freedom
constexpr std::size_t wavelengths_beside = 4, wavelengths_in_words = 4;

/// Symbols of the quantities of the facts.
std::string symbol_of(const std::string& quantity) {
  static const std::map<std::string, std::string> symbols{{"dhr, theta_i 0", "DHR(0°)"},
                                                          {"dhr, theta_i 8", "DHR(8°)"},
                                                          {"dhr, theta_i 45", "DHR(45°)"},
                                                          {"dhr, theta_i 60", "DHR(60°)"},
                                                          {"dhr, theta_i 75", "DHR(75°)"},
                                                          {"bhr", "BHR"},
                                                          {"reflectance factor 0:45", "R(0°:45°)"},
                                                          {"reflectance factor 45:0", "R(45°:0°)"}};
  return symbols.at(quantity);
}

std::string nm_of(const Json& row) {
  return row["wavelength_nm"].is_null() ? "" : shortest(row["wavelength_nm"].get<double>()) + " nm";
}

std::optional<double> u_of(const Json& row) {
  return row["u"].is_null() ? std::nullopt : std::optional(row["u"].get<double>());
}

Json rows_of(const Json& rows, const std::string& quantity) {
  Json found = Json::array();
  for (const Json& row : rows)
    if (row["quantity"] == quantity) found.push_back(row);
  return found;
}

/// "0.9752(36) at 351 nm, 0.9841(36) at 532 nm"; of many wavelengths the first and the last.
std::string values_in_words(const Document& document, const Json& rows) {
  std::string text;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows.size() > wavelengths_in_words && i > 0 && i + 1 < rows.size()) continue;
    const Json& row = rows[i];
    const bool last_of_many = rows.size() > wavelengths_in_words && i > 0;
    text += last_of_many ? " … " : text.empty() ? "" : ", ";
    text += in_print(row["value"], u_of(row), document.notation());
    if (rows.size() > 1) text += " at " + nm_of(row);
  }
  return text;
}

std::string chi_in_words(const Document& document, const Json& facts) {
  if (!facts.contains("data")) return "χ²/ν is not known, for no samples are beside it";
  const Json& rows = facts["chi_squared"];
  if (rows.is_string()) return "χ²/ν is not known, for the samples do not state their uncertainties";
  const auto value = [&](const Json& row) {
    const double freedom = row["degrees_of_freedom"];
    return in_print(row["chi_squared_per_dof"], freedom > 0 ? std::optional(std::sqrt(2 / freedom)) : std::nullopt,
                    document.notation());
  };
  std::string text = "χ²/ν = " + value(rows.front()) + " (f₁₁)";
  if (rows.back()["degrees_of_freedom"] > 0) text += " and " + value(rows.back()) + " (other elements)";
  return text;
}

void add_summary(Document& document, const Json& facts, const std::string& name) {
  const Json dhr = rows_of(facts["reflectances"], "dhr, theta_i 8"),
             factor = rows_of(facts["reflectances"], "reflectance factor 0:45");
  const std::string where = dhr.size() == 1 && !nm_of(dhr[0]).empty() ? " at " + nm_of(dhr[0]) : "";
  const bool known = !dhr[0]["u"].is_null();
  document.summary(name + where, ": directional-hemispherical reflectance DHR(8°) = " + values_in_words(document, dhr) +
                                     "; reflectance factor R(0°:45°) = " + values_in_words(document, factor) + "; " +
                                     chi_in_words(document, facts) + ". " +
                                     (known ? "Uncertainties are standard (k = 1), of " +
                                                  facts["uncertainty"].get<std::string>() + "."
                                            : std::string("The uncertainty is not known.")));
}

/// A cell for each wavelength, no more than wavelengths_beside in a table.
void add_reflectance_tables(Document& document, const Json& reflectances) {
  const std::size_t count = rows_of(reflectances, "bhr").size(), each = reflectances.size() / count;
  for (std::size_t first = 0; first < count; first += wavelengths_beside) {
    const std::size_t end = std::min(count, first + wavelengths_beside);
    std::vector<std::string> headings{"quantity"};
    std::vector<bool> numbers(1 + end - first, true);
    numbers[0] = false;
    for (std::size_t w = first; w < end; ++w) {
      const std::string nm = nm_of(reflectances[w * each]);
      headings.push_back(nm.empty() ? "value" : nm);
    }
    bool beyond = false;
    Json rows = Json::array();
    for (std::size_t q = 0; q < each; ++q) {
      Json line = Json::array({symbol_of(reflectances[q]["quantity"])});
      for (std::size_t w = first; w < end; ++w) {
        const Json& row = reflectances[w * each + q];
        const std::string validity = row["validity"];
        const bool outside = validity != "ok" && validity != "unknown" && validity != "interpolated";
        beyond = beyond || outside;
        line.push_back(in_print(row["value"], u_of(row), document.notation()) + (outside ? " *" : ""));
      }
      rows.push_back(line);
    }
    document.table(
        "DHR: directional-hemispherical reflectance at an angle of incidence; BHR: bihemispherical; R: "
        "reflectance factor from one direction to another in the plane of incidence, on both sides of the "
        "normal. Unpolarized light; standard uncertainties (k = 1).",
        headings, numbers, rows, beyond ? "* beyond the fitted range: extrapolated" : "");
  }
}

/// The causes of one quantity, and at each wavelength what they contribute.
void add_budget_table(Document& document, const Json& budgets, const std::string& quantity, const Json& reflectances) {
  const Json rows = rows_of(budgets, quantity), values = rows_of(reflectances, quantity);
  if (rows.empty()) return;
  const std::size_t each = rows.size() / values.size();
  for (std::size_t first = 0; first < values.size(); first += wavelengths_beside) {
    const std::size_t end = std::min(values.size(), first + wavelengths_beside);
    std::vector<std::string> headings{"cause"};
    for (std::size_t w = first; w < end; ++w)
      headings.push_back(nm_of(values[w]).empty() ? "u" : "u at " + nm_of(values[w]));
    headings.emplace_back("ν");
    std::vector<bool> numbers(headings.size(), true);
    numbers[0] = false;
    Json lines = Json::array(), expanded = Json::array({"U = 2 u"}), value = Json::array({symbol_of(quantity)});
    for (std::size_t cause = 0; cause < each; ++cause) {
      const std::string name = rows[cause]["cause"];
      Json line = Json::array({name == "together" ? "together, u" : name});
      for (std::size_t w = first; w < end; ++w) {
        const double u = rows[w * each + cause]["u"];
        line.push_back(significant(u, 2));
        if (name != "together") continue;
        expanded.push_back(significant(reported_coverage * u, 2));
        value.push_back(in_print(values[w]["value"], reported_coverage * u, Notation::plus_minus));
      }
      const Json& freedom = rows[first * each + cause]["degrees_of_freedom"];
      line.push_back(freedom.is_null() ? "∞" : freedom.get<double>() > many ? "> 10⁶" : significant(freedom, 3));
      lines.push_back(line);
    }
    for (Json* last : {&expanded, &value}) {
      last->push_back("");
      lines.push_back(*last);
    }
    document.table("Uncertainty budget of " + symbol_of(quantity) +
                       ": standard uncertainties by cause, degrees of freedom ν (together: effective, by Welch and "
                       "Satterthwaite), and the value with its expanded uncertainty, k = 2.",
                   headings, numbers, lines);
  }
}

void add_budgets(Document& document, const Json& facts) {
  document.heading("Uncertainty budgets");
  if (facts["budgets"].empty()) return document.paragraph("The uncertainty is not known.");
  document.paragraph("Uncertainties are of " + facts["uncertainty"].get<std::string>() +
                     ". U = k u with k = 2; from some 50 effective degrees of freedom on it covers 95 % of a normal "
                     "error.");
  for (const char* quantity : {"dhr, theta_i 8", "reflectance factor 0:45"})
    add_budget_table(document, facts["budgets"], quantity, facts["reflectances"]);
}

void add_origin(Document& document, const ReportOrigin& origin) {
  Json rows = Json::array();
  const auto add = [&](const std::string& name, const std::string& value) {
    if (!value.empty()) rows.push_back({name, value});
  };
  add("date", origin.date);
  for (const auto& [what, name, digest] : origin.files) {
    add(what, name);
    add("SHA-256 of the " + what, digest);
  }
  add("software", origin.software);
  add("command", origin.command);
  if (rows.empty()) return;
  document.heading("Origin");
  document.table("Of what this report was made.", {"", ""}, {false, false}, rows);
}

/// Names and values. What a provenance says are words of others, and stay as they are.
void add_words(Document& document, const std::string& heading, const std::string& caption, const Json& fields,
               const std::vector<std::string>& own) {
  document.heading(heading);
  Json rows = Json::array();
  for (const auto& [name, value] : fields.items()) {
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    const bool ours = std::ranges::find(own, name) != own.end();
    rows.push_back({name == "chi_squared" ? "χ² per degree of freedom" : document.in_symbols(name),
                    ours ? document.in_symbols(text) : text});
  }
  document.table(caption, {"", ""}, {false, false}, rows);
}

/// u by kind of error, each of all terms of the kind together.
Json terms_of(const Json& facts) {
  Json terms = Json::object();
  for (const Json& row : facts.value("terms", Json::array())) {
    Json& all = terms[row["kind"].get<std::string>()];
    all = std::hypot(all.is_null() ? 0 : all.get<double>(), row["u"].get<double>());
  }
  return terms;
}

Drawn drawn_of(const Model& model, const Json& facts, const ReportOrigin& origin, const ReportStyle& style) {
  Drawn drawn{model, origin, {}, style.theta_i_deg, 180, terms_of(facts)};
  for (const Json& row : rows_of(facts["reflectances"], "bhr"))
    if (!row["wavelength_nm"].is_null()) drawn.wavelengths.push_back(row["wavelength_nm"]);
  if (facts.contains("directions")) drawn.phi_i_deg = facts["directions"]["phi_i_deg"];
  return drawn;
}

/// With as many digits as reflectances have.
Json without_digits(Json said, const ReflectanceTable& table) {
  if (table.values.empty()) return said;
  std::string text;
  for (std::size_t i = 0; i < table.values.size(); ++i)
    text += (i > 0 ? ", " : "") + significant(table.values[i], 4) + " at " +
            shortest(nanometres(table.wavelengths[i])) + " nm";
  said["reflectance table"] = text + (table.covariance.empty() ? "; exact" : "; with its covariance") + reach_of(table);
  return said;
}

void add_model_part(Document& document, const Json& facts, const Drawn& drawn) {
  add_words(document, "Model", "The model, and what it says of its origin.",
            without_digits(facts["model"], drawn.model.reflectance), {"basis", "fitted range", "not measured"});
  document.heading("Reflectances");
  add_reflectance_tables(document, facts["reflectances"]);
  add_reflectance_figures(document, drawn);
  add_budgets(document, facts);
  document.heading("The model in pictures");
  add_model_figures(document, drawn);
  for (const char* field : {"fit", "sample", "realizability"})
    if (facts.contains(field)) add_field(document, field, facts[field]);
}

void add_samples_part(Document& document, const Json& facts, const Drawn& drawn) {
  add_words(document, "Data", "The samples, and what the following is of.", facts["data"], {"chi_squared"});
  for (const char* field : {"residuals", "chi_squared", "conventions", "reciprocity", "mirror_symmetry",
                            "dependence_on_phi_i", "noise", "repeats", "leverage", "outliers"}) {
    add_field(document, field, facts[field]);
    if (field == std::string("residuals")) add_residual_figures(document, drawn, facts["directions"]);
  }
}

}  // namespace

std::string report_document(const Model& model, const std::string& report_json, const ReportOrigin& origin,
                            const ReportStyle& style) {
  const Json facts = Json::parse(report_json);
  const std::string title = facts["title"], name = title.substr(std::string("Report on ").size());
  std::vector<std::string> names{name};
  if (facts.contains("data")) names.push_back(facts["data"]["name"]);
  Document document(title, style.notation, names);
  add_summary(document, facts, name);
  document.lines("warnings", facts["warnings"]);
  document.lines("notes", facts["notes"]);
  document.lines("contents", Json::array());
  add_origin(document, origin);
  const Drawn drawn = drawn_of(model, facts, origin, style);
  add_model_part(document, facts, drawn);
  if (facts.contains("data")) add_samples_part(document, facts, drawn);
  add_coefficient_figures(document, drawn);
  return document.text();
}

}  // namespace mmbrdf
