// SPDX-License-Identifier: BSD-3-Clause
#include "pages/budget.hpp"

#include <algorithm>
#include <cmath>

#include "pages/describe.hpp"

namespace mmbrdf::program {

namespace {

Json freedom_json(double freedom) { return std::isinf(freedom) ? Json() : Json(freedom); }

std::string freedom_text(double freedom) {
  if (std::isinf(freedom)) return "infinite";
  return freedom > 1e6 ? ">1e6" : format("%.0f", std::floor(freedom));  // k is that of a normal error there
}

/// To its own two digits.
std::string rounded(double u) {
  const double shown = without_rounding(u);
  return to_place_of(shown, shown);
}

}  // namespace

namespace {

/// The effects of all causes, and what they make together.
Table budget_table(const std::vector<BudgetLine>& lines, const std::optional<double>& coverage) {
  const std::vector<Contribution>& causes = lines.front().uncertainty.contributions;
  std::size_t width = 10;
  for (const BudgetLine& line : lines) width = std::max(width, line.name.size());
  Table table{{{"budget", "%-" + std::to_string(width) + "s"}, {"value", "%12s"}}};
  for (const Contribution& cause : causes)
    table.columns.push_back({cause.name, "%" + std::to_string(std::max<std::size_t>(10, cause.name.size())) + "s"});
  for (const char* name : {"together", "dof", "k", "U"}) table.columns.push_back({name, "%10s"});
  if (coverage) table.columns.push_back({"U, k = " + brief(*coverage), "%12s"});
  for (const auto& [name, value, u] : lines) {
    Table::Row& row = table.rows.emplace_back(Table::Row{name, to_place_of(without_rounding(value), u.expanded)});
    for (const Contribution& cause : u.contributions) row.push_back(rounded(cause.uncertainty));
    for (const std::string& cell :
         {rounded(u.uncertainty), freedom_text(u.freedom), format("%.2f", u.coverage_factor), rounded(u.expanded)})
      row.push_back(cell);
    if (coverage) row.push_back(rounded(*coverage * u.uncertainty));
  }
  return table;
}

}  // namespace

Page budget_page(const std::vector<BudgetLine>& lines, const std::optional<double>& coverage) {
  Page page;
  if (lines.empty()) return page;
  const std::vector<Contribution>& causes = lines.front().uncertainty.contributions;
  const double of_fit = causes.front().freedom;  // those of a fit are finite, if its model knows them
  std::string freedoms = "fit " + (std::isinf(of_fit) ? "not known (as if infinite)" : freedom_text(of_fit));
  for (std::size_t c = 1; c < causes.size(); ++c)
    freedoms += ", " + causes[c].name + " " + freedom_text(causes[c].freedom);
  page.add(budget_table(lines, coverage));
  page.add("degrees of freedom: " + freedoms +
           "; together by Welch and Satterthwaite\n"
           "U = k u: 95 % coverage, k of Student's distribution, 2 where the degrees of freedom are infinite\n" +
           (coverage ? "last column: U = " + brief(*coverage) + " u, whatever the degrees of freedom\n" : ""));
  return page;
}

Json budget_json(const ExpandedUncertainty& uncertainty, const std::optional<double>& coverage) {
  Json json;
  json["terms"] = Json::array();
  for (const auto& [name, u, freedom] : uncertainty.contributions)
    json["terms"].push_back({{"term", name}, {"u", u}, {"degrees_of_freedom", freedom_json(freedom)}});
  json["u"] = uncertainty.uncertainty;
  json["degrees_of_freedom"] = freedom_json(uncertainty.freedom);
  json["k"] = uncertainty.coverage_factor;
  json["U"] = uncertainty.expanded;
  if (coverage) {
    json["asked_k"] = *coverage;
    json["asked_U"] = *coverage * uncertainty.uncertainty;
  }
  return json;
}

}  // namespace mmbrdf::program
