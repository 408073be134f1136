// SPDX-License-Identifier: BSD-3-Clause
#include "pages/fit_report.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "mmbrdf/model/description.hpp"
#include "pages/describe.hpp"
#include "pages/output.hpp"

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

void print_text(const FitReport& report) {
  const Model& model = report.result.model;
  std::cout << report.data << ": " << counted(report.rows, "row") << " at "
            << nanometre_list(model.validity.wavelengths) << '\n'
            << "basis " << basis_line(model) << ", weights " << report.weights
            << "\n\nelement     rows          rms        chi^2\n";
  for (std::size_t element = 0; element < 16; ++element) {
    const ElementFit& fit = report.result.elements[element];
    std::cout << format("%-7s %8ld %12.6g %12.6g", element_name(element).c_str(), fit.rows, fit.rms, fit.chi_squared)
              << (block_of(model, element) < model.blocks.size() ? "\n" : "  no modes\n");
  }
  std::cout << "\nblock                coefficients   rank   condition\n";
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    const Solution& solution = report.result.solutions[b];
    std::cout << format("%-20s %12zu %6d %11.4g\n", model.blocks[b].block.name.c_str(), solution.x.size(),
                        solution.rank, solution.condition());
  }
  const char* f11 = model.reflectance.values.empty() ? "f11, sr^-1" : "f11 / reflectance, sr^-1";
  std::cout << format("\nrms of %-27s %.6g\n", f11, report.result.elements[0].rms)
            << format("rms of %-27s %.6g\n", "the 15 others / f11", polarization_rms(report.result))
            << format("%-34s ", "reflectance at normal incidence") << normal_reflectance_line(model) << '\n';
  for (std::size_t i = 0; i < report.result.noise.size(); ++i) {
    std::cout << (i == 0 ? "\nnoise of elements 14 and 41, relative for f11\n" : "") << noise_line(report.result, i)
              << '\n';
  }
}

void print_csv(const FitReport& report) {
  std::cout << "element,rows,rms,chi_squared,block,coefficients,rank,condition\n";
  for (std::size_t element = 0; element < 16; ++element) {
    const ElementFit& fit = report.result.elements[element];
    std::cout << element_name(element) << ',' << fit.rows << ',' << exact(fit.rms) << ',' << exact(fit.chi_squared);
    const std::size_t b = block_of(report.result.model, element);
    if (b == report.result.solutions.size()) {
      std::cout << ",no modes,0,0,\n";
      continue;
    }
    const Solution& solution = report.result.solutions[b];
    std::string block = report.result.model.blocks[b].block.name;
    std::replace(block.begin(), block.end(), ',', ' ');
    std::cout << ',' << block << ',' << solution.x.size() << ',' << solution.rank << ',' << exact(solution.condition())
              << '\n';
  }
  std::cout << "polarization," << polarization_rows(report.result) << ',' << exact(polarization_rms(report.result))
            << ",,,,,\n";
}

using Json = nlohmann::ordered_json;

Json elements_json(const FitResult& result) {
  Json json = Json::array();
  for (std::size_t element = 0; element < 16; ++element) {
    const ElementFit& fit = result.elements[element];
    json.push_back(
        {{"element", element_name(element)}, {"rows", fit.rows}, {"rms", fit.rms}, {"chi_squared", fit.chi_squared}});
  }
  return json;
}

Json blocks_json(const FitResult& result) {
  Json json = Json::array();
  for (std::size_t b = 0; b < result.model.blocks.size(); ++b) {
    const Solution& solution = result.solutions[b];
    json.push_back({{"block", result.model.blocks[b].block.name},
                    {"coefficients", solution.x.size()},
                    {"rank", solution.rank},
                    {"condition", solution.condition()}});
  }
  return json;
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
  json["elements"] = elements_json(report.result);
  json["blocks"] = blocks_json(report.result);
  json["rms_f11"] = report.result.elements[0].rms;
  json["rms_polarization"] = polarization_rms(report.result);
  json["reflectance_at_normal_incidence"] = normal_reflectance_json(model);
  if (!report.result.noise.empty()) json["noise"] = noise_json(report.result);
  print(json);
}

}  // namespace

std::string noise_line(const FitResult& result, std::size_t i) {
  return nanometre_list(std::array{result.model.validity.wavelengths[i]}) + ": " + to_string(result.noise[i]);
}

void print(const FitReport& report, Format format) {
  (format == Format::text ? print_text : format == Format::csv ? print_csv : print_json)(report);
}

}  // namespace mmbrdf::program
