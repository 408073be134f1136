// SPDX-License-Identifier: BSD-3-Clause
// What `mmbrdf integrate` prints.

#include <algorithm>
#include <cmath>
#include <functional>

#include "pages/describe.hpp"
#include "pages/integrate.hpp"
#include "pages/page.hpp"

namespace mmbrdf::program {

namespace {

struct Named {
  Integral quantity;
  const char* name;
  const char* meaning;
  const char* unit;
};

constexpr Named quantities[] = {
    {Integral::dhr, "dhr", "directional-hemispherical reflectance", "1"},
    {Integral::hdr, "hdr", "hemispherical-directional reflectance", "1"},
    {Integral::bhr, "bhr", "bihemispherical reflectance", "1"},
    {Integral::brdf, "brdf", "BRDF f11, mean over source and receiver", "sr^-1"},
    {Integral::reflectance_factor, "reflectance_factor", "reflectance factor, pi x mean of f11", "1"},
    {Integral::radiance_factor, "radiance_factor", "radiance factor, pi x mean of f11", "1"},
    {Integral::reflectance, "reflectance", "reflected flux into the receiver per incident flux", "1"},
    {Integral::mueller, "mueller", "Mueller BRDF, mean over source and receiver, frame xy", "sr^-1"},
};

const Named& named(Integral quantity) {
  return *std::find_if(std::begin(quantities), std::end(quantities),
                       [&](const Named& q) { return q.quantity == quantity; });
}

/// The column of the polar angle; empty if there is none.
std::string theta_column(Integral quantity) {
  return quantity == Integral::dhr ? "theta_i_deg" : quantity == Integral::hdr ? "theta_r_deg" : "";
}

Json square(const std::vector<double>& elements) {
  Json json = Json::array();
  for (std::size_t row = 0; row < 4 && !elements.empty(); ++row)
    json.push_back(std::vector<double>(&elements[4 * row], &elements[4 * row] + 4));
  return elements.empty() ? nullptr : json;
}

/// A matrix is one cell in JSON, and sixteen in CSV.
std::vector<Column> columns(const Integrated& result) {
  const std::string name = to_string(result.quantity), theta = theta_column(result.quantity);
  const bool geometry = needs_geometry(result.quantity), matrix = result.quantity == Integral::mueller;
  const int width = std::max(11, static_cast<int>(name.size()) + 1);
  std::vector<Column> columns{{"wavelength_nm", "%13.10g", "wavelength_nm",
                               result.several_wavelengths ? everywhere : in_text | in_json, "unknown", shortest}};
  if (!theta.empty()) columns.push_back({.name = theta, .format = "%12.10g", .digits = shortest});
  columns.push_back({name, format("%%%d.6f", width), name, matrix ? in_json : everywhere});
  columns.push_back(
      {"u_" + name, format("%%%d.2g", width + 2), "u_" + name, matrix ? in_json : everywhere, "not known"});
  for (const std::string element : {"f", "u_f"})
    for (std::size_t e = 0; e < (matrix ? 16 : 0); ++e) columns.push_back({element + element_name(e), "", "", in_csv});
  if (geometry) {
    columns.push_back({.name = "quadrature_error", .where = in_csv | in_json, .digits = [](double error) {
                         return format("%.1e", error);
                       }});
    columns.push_back({.name = "geometries", .where = in_json});
  }
  columns.push_back({"validity", " %s", "validity", geometry ? everywhere : in_text | in_json});
  return columns;
}

Table table(const Integrated& result) {
  Table table{columns(result)};
  const bool matrix = result.quantity == Integral::mueller;
  for (const IntegratedRow& row : result.rows) {
    const bool known = !row.uncertainties.empty();
    Table::Row cells{row.wavelength_nm ? Json(*row.wavelength_nm) : Json()};
    if (row.theta_deg) cells.push_back(*row.theta_deg);
    cells.push_back(matrix ? square(row.values) : Json(row.values.front()));
    cells.push_back(matrix ? square(row.uncertainties) : known ? Json(row.uncertainties.front()) : Json());
    if (matrix) {
      cells.insert(cells.end(), row.values.begin(), row.values.end());
      cells.insert(cells.end(), row.uncertainties.begin(), row.uncertainties.end());
      if (!known) cells.resize(cells.size() + row.values.size());
    }
    if (needs_geometry(result.quantity)) cells.insert(cells.end(), {row.quadrature_error, row.geometries});
    cells.push_back(to_string(row.outside));
    table.rows.push_back(cells);
  }
  return table;
}

/// "532 nm, 8 deg", of what there are several.
std::string label(const Integrated& result, const IntegratedRow& row) {
  std::string text;
  if (result.several_wavelengths) text += brief(*row.wavelength_nm) + " nm";
  if (row.theta_deg) text += (text.empty() ? "" : ", ") + brief(*row.theta_deg) + " deg";
  return text;
}

std::vector<BudgetLine> budget_lines(const Integrated& result, const IntegratedRow& row) {
  std::vector<BudgetLine> lines;
  for (std::size_t e = 0; e < row.budgets.size(); ++e) {
    if (!(without_rounding(row.budgets[e].uncertainty) > 0)) continue;
    const std::string name = result.quantity == Integral::mueller ? "f" + element_name(e) : to_string(result.quantity);
    const std::string where = label(result, row);
    lines.push_back({name + (where.empty() ? "" : " " + where), row.values[e], row.budgets[e]});
  }
  return lines;
}

Json json_of(const Integrated& result) {
  Json json;
  json["model"] = result.model;
  json["quantity"] = to_string(result.quantity);
  json["meaning"] = named(result.quantity).meaning;
  json["unit"] = named(result.quantity).unit;
  if (needs_geometry(result.quantity)) {
    json["source"] = result.source;
    json["receiver"] = result.receiver;
  } else if (result.quantity != Integral::bhr) {
    json["polarization"] = result.polarization;
  }
  if (result.extrapolated) json["extrapolated_share_of_hemisphere"] = *result.extrapolated;
  json["rows"] = json_of(table(result));
  for (std::size_t r = 0; r < result.rows.size(); ++r) {
    Json& row = json["rows"][r];
    for (const auto& [name, value, u] : budget_lines(result, result.rows[r]))
      (result.quantity == Integral::mueller ? row["budgets"][name] : row["budget"]) = budget_json(u, result.coverage);
  }
  return json;
}

/// Lines of four, of what `shown` gives for each element.
std::string in_lines(const std::function<std::string(std::size_t)>& shown) {
  std::string text;
  for (std::size_t e = 0; e < 16; ++e) text += format("%14s", shown(e).c_str()) + (e % 4 == 3 ? "\n" : "");
  return text;
}

std::string matrices(const Integrated& result) {
  std::string text;
  for (const IntegratedRow& row : result.rows) {
    const bool known = !row.uncertainties.empty();
    const auto value = [&](std::size_t e) { return std::abs(row.values[e]) < 5e-9 ? 0 : row.values[e]; };
    const auto u = [&](std::size_t e) { return row.uncertainties[e] < 1e-15 ? 0 : row.uncertainties[e]; };
    text += "wavelength " + (row.wavelength_nm ? brief(*row.wavelength_nm) + " nm" : "unknown") +
            ", validity: " + to_string(row.outside) + "\n" + in_lines([&](std::size_t e) {
              if (std::isnan(row.values[e])) return std::string("-");
              return known ? to_place_of(value(e), u(e)) : format("%.8f", value(e));
            });
    text += "standard uncertainties";
    text += known ? "\n" + in_lines([&](std::size_t e) { return std::isnan(u(e)) ? "-" : to_place_of(u(e), u(e)); })
                  : " not known\n";
  }
  return text;
}

Page page_of(const Integrated& result) {
  const bool geometry = needs_geometry(result.quantity);
  std::string text = result.model + ": " + named(result.quantity).meaning;
  const std::string unit = named(result.quantity).unit;
  text += unit == "1" ? "" : " in " + unit;
  if (geometry)
    text += "\nsource      " + result.source + "\nreceiver    " + result.receiver + "\n";
  else
    text += (result.quantity == Integral::bhr ? "" : ", polarization " + result.polarization) + "\n";
  Page page;
  page.add(text);
  if (result.quantity == Integral::mueller)
    page.add(matrices(result));
  else
    page.add(table(result));
  text.clear();
  if (geometry) {
    double error = 0;
    long geometries = 0;
    for (const IntegratedRow& row : result.rows) {
      error = std::max(error, row.quadrature_error);
      geometries = std::max(geometries, row.geometries);
    }
    text += "quadrature: " + (geometries == 1 ? "1 geometry" : std::to_string(geometries) + " geometries") +
            format(", error below %.1e\n", error);
  }
  if (std::any_of(result.rows.begin(), result.rows.end(), [](const auto& row) { return !row.uncertainties.empty(); }))
    text += uncertainty_line(result.uncertain, result.not_in_it, result.terms);
  if (result.extrapolated) {
    text += format("extrapolated: %.1f %% of the hemisphere's projected solid angle lies beyond the fitted angles\n",
                   100 * *result.extrapolated);
  }
  std::vector<BudgetLine> lines;
  for (const IntegratedRow& row : result.rows)
    for (BudgetLine& line : budget_lines(result, row)) lines.push_back(std::move(line));
  page.add(text + (lines.empty() ? "" : "\n"));
  page.add(budget_page(lines, result.coverage));
  return page;
}

}  // namespace

Integral quantity_from(const std::string& name) {
  std::vector<std::string> names;
  for (const Named& q : quantities) {
    if (q.name == name) return q.quantity;
    names.emplace_back(q.name);
  }
  throw std::invalid_argument("\"" + name + "\": expected one of " + joined(names));
}

std::string to_string(Integral quantity) { return named(quantity).name; }

bool needs_geometry(Integral quantity) {
  return quantity != Integral::dhr && quantity != Integral::hdr && quantity != Integral::bhr;
}

std::string written(const Integrated& result, Format format) {
  if (format == Format::csv) return csv(table(result));
  return format == Format::json ? printed(json_of(result)) : page_of(result).written(format);
}

}  // namespace mmbrdf::program
