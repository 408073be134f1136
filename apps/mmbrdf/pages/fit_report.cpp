// SPDX-License-Identifier: BSD-3-Clause
#include "pages/fit_report.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <span>

#include "mmbrdf/mixed/sample_traits.hpp"
#include "mmbrdf/model/description.hpp"
#include "mmbrdf/quantities/fit_warnings.hpp"
#include "pages/describe.hpp"
#include "pages/page.hpp"

namespace mmbrdf::program {

namespace {

/// Block that element number `element` belongs to; the number of blocks for an element without modes.
std::size_t block_of(const Model& model, std::size_t element) {
  const Element wanted{static_cast<int>(element) / 4, static_cast<int>(element) % 4};
  std::size_t block = 0;
  for (; block < model.blocks.size(); ++block) {
    const auto& elements = model.blocks[block].block.elements;
    if (std::find(elements.begin(), elements.end(), wanted) != elements.end()) break;
  }
  return block;
}

/// Rows of the 15 normalised elements.
long polarization_rows(const FitResult& result) {
  long rows = 0;
  for (std::size_t element = 1; element < 16; ++element) rows += result.elements[element].rows;
  return rows;
}

/// Of the 15, how many were measured.
long polarized_elements(const FitResult& result) {
  return std::ranges::count_if(std::span(result.elements).subspan(1),
                               [](const ElementFit& fit) { return fit.rows > 0; });
}

/// Whether chi^2 can be set beside the degrees of freedom.
bool knows_scale(const FitResult& result) { return result.weights == Weights::data; }

/// Whether the user's uncertainties count as they are.
std::string source_of_uncertainties(const std::string& covariance) {
  if (covariance == "given") return "those of the data, as given";
  if (covariance == "sandwich") return "the residuals, row by row (sandwich)";
  return "those of the data, scaled by the root of chi^2/dof (as given: --covariance given)";
}

Table::Row block_row(const FitResult& result, std::size_t b) {
  const Solution& solution = result.solutions[b];
  Table::Row row{result.model.blocks[b].block.name, solution.x.size(), solution.rank, solution.condition()};
  if (knows_scale(result)) row.push_back(solution.degrees_of_freedom() > 0 ? Json(solution.variance()) : Json());
  return row;
}

Table blocks(const FitResult& result) {
  Table table{{{"block", "%-20s"}, {"coefficients", "%12s"}, {"rank", "%6s"}, {"condition", "%11.4g"}}};
  if (knows_scale(result)) table.columns.push_back({"chi_squared_per_dof", "%10.3g", "chi^2/dof"});
  for (std::size_t b = 0; b < result.solutions.size(); ++b) table.rows.push_back(block_row(result, b));
  return table;
}

/// In CSV with its block, and with a line of all but 11.
Table elements(const FitResult& result) {
  Table table{{{"element", "%-7s"},
               {"rows", "%8s"},
               {"rms", "%12.6g"},
               {.name = "u_rms", .where = nowhere},
               {"chi_squared", "%12.6g", "chi^2"},
               {.name = "u_chi_squared", .where = nowhere}}};
  const std::vector<Column> of_blocks = blocks(result).columns;
  for (const Column& column : of_blocks) table.columns.push_back({column.name, "", "", in_csv});
  table.columns.push_back({"", " %s", "", in_text, ""});
  for (std::size_t element = 0; element < 16; ++element) {
    const ElementFit& fit = result.elements[element];
    const std::size_t b = block_of(result.model, element);
    const bool fitted = b < result.solutions.size();
    const char* without = result.model.not_measured[element] ? "not measured" : "no modes";
    const bool measured = fit.rows > 0;
    Table::Row row{element_name(element), fit.rows};
    row.resize(6);
    if (measured) {  // by chance so many squares differ by √2n from n
      const double count = static_cast<double>(fit.rows);
      row[2] = fit.rms;
      row[3] = fit.rms / std::sqrt(2 * count);
      row[4] = fit.chi_squared;
      row[5] = fit.chi_squared * std::sqrt(2 / count);
    }
    std::ranges::move(fitted ? block_row(result, b) : Table::Row{without, 0, 0}, std::back_inserter(row));
    row.resize(6 + of_blocks.size());
    const bool from_others = fitted && !result.model.not_measured[element];
    row.push_back(fitted && measured ? "" : from_others ? "from the others" : without);
    table.rows.push_back(row);
  }
  return table;
}

void print_csv(const FitReport& report) {
  Table table = elements(report.result);
  table.rows.push_back({"polarization", polarization_rows(report.result), polarization_rms(report.result)});
  std::cout << csv(table);
}

/// "rms of f11, sr^-1                 0.0051", to what chance leaves of a root mean square of so many.
std::string rms_line(const std::string& what, double rms, long count) {
  return format("rms of %-27s ", what.c_str()) + to_place_of(rms, rms / std::sqrt(2.0 * static_cast<double>(count))) +
         "\n";
}

std::string scale_lines(const FitReport& report) {
  const ReducedChiSquared reduced = chi_squared_per_dof(report.result);
  std::string text = format("%-34s %.3g\n", "chi^2/dof of f11", reduced.f11);
  if (const long count = polarized_elements(report.result); count > 0)
    text += format("%-34s %.3g\n", ("chi^2/dof of the " + std::to_string(count) + " others").c_str(), reduced.others);
  return text + format("%-34s ", "uncertainties of the model from") + source_of_uncertainties(report.covariance) + "\n";
}

std::string lines_below(const FitReport& report) {
  const Model& model = report.result.model;
  const std::string others = "the " + std::to_string(polarized_elements(report.result)) + " others / f11";
  const ElementFit& f11 = report.result.elements[0];
  std::string text =
      "\n" + rms_line(model.reflectance.values.empty() ? "f11, sr^-1" : "f11 / reflectance, sr^-1", f11.rms, f11.rows);
  if (const long rows = polarization_rows(report.result); rows > 0)
    text += rms_line(others, polarization_rms(report.result), rows);
  if (knows_scale(report.result)) text += scale_lines(report);
  text += format("%-34s ", "reflectance at normal incidence") + normal_reflectance_line(model) + "\n" +
          format("%-34s ", "uncertainties hold for") + (model.posterior ? "the sample" : "the noise alone") + "\n";
  if (model.posterior) {
    text += "\n";
    for (const std::string& line : described_sample(*model.posterior)) text += line + "\n";
  }
  for (std::size_t i = 0; i < report.result.noise.size(); ++i)
    text += (i == 0 ? "\nnoise of elements 14 and 41, relative for f11\n" : "") + noise_line(report.result, i) + "\n";
  return text;
}

Page page_of(const FitReport& report) {
  const Model& model = report.result.model;
  Page page;
  page.add(report.data + ": " + counted(report.rows, "row") + " at " + nanometre_list(model.validity.wavelengths) +
           "\nbasis " + basis_line(model) + ", weights " + report.weights + "\n\n");
  page.add(elements(report.result));
  page.add("\n");
  page.add(blocks(report.result));
  page.add(lines_below(report));
  return page;
}

Json noise_json(const FitResult& result) {
  Json json = Json::array();
  for (std::size_t i = 0; i < result.noise.size(); ++i) {
    const auto& [law, covariance, rows] = result.noise[i];
    json.push_back({{"wavelength_nm", nanometres(result.model.validity.wavelengths[i])},
                    {"scale", law.scale},
                    {"u_scale", law.scale * std::sqrt(covariance[0])},
                    {"incident_exponent", law.incident_exponent},
                    {"u_incident_exponent", std::sqrt(covariance[4])},
                    {"reflected_exponent", law.reflected_exponent},
                    {"u_reflected_exponent", std::sqrt(covariance[8])},
                    {"rows", rows}});
  }
  return json;
}

void print_json(const FitReport& report) {
  const Model& model = report.result.model;
  Json json{{"data", report.data}, {"rows", report.rows}, {"weights", report.weights}};
  json.update(basis_json(model));
  json["elements"] = json_of(elements(report.result));
  json["blocks"] = json_of(blocks(report.result));
  if (knows_scale(report.result)) {
    const auto [f11, others] = chi_squared_per_dof(report.result);
    json["chi_squared_per_dof"] = {{"f11", f11}, {"others", others}};
    json["covariance"] = report.covariance;
  }
  json["rms_f11"] = report.result.elements[0].rms;
  json["rms_polarization"] = polarization_rms(report.result);
  json["reflectance_at_normal_incidence"] = normal_reflectance_json(model);
  json["uncertainty"] = to_string(model.posterior ? Uncertainty::sample : Uncertainty::noise);
  if (model.posterior) json["sample"] = described_sample(*model.posterior);
  if (!report.result.noise.empty()) json["noise"] = noise_json(report.result);
  print(json);
}

}  // namespace

std::string noise_line(const FitResult& result, std::size_t i) {
  return nanometre_list(std::array{result.model.validity.wavelengths[i]}) + ": " + to_string(result.noise[i]);
}

void print(const FitReport& report, Format format) {
  if (format == Format::csv) return print_csv(report);
  if (format == Format::json) return print_json(report);
  std::cout << page_of(report).written(format);
}

}  // namespace mmbrdf::program
