// SPDX-License-Identifier: BSD-3-Clause
// What the parts of a report are made of.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mmbrdf/model/description.hpp"
#include "mmbrdf/quantities/report.hpp"
#include "mmbrdf/quantities/trust.hpp"
#include "mmbrdf/radiometry/reflectance_uncertainty.hpp"

namespace mmbrdf {

using Json = nlohmann::ordered_json;
using Warnings = std::vector<std::string>;

/// A field of the report, what there is to warn of in it, and what is only to be noted.
struct ReportField {
  Json value = Json::array();
  Warnings warnings{}, notes{};
};

/// What is reported on.
struct ReportSubject {
  const Model& model;
  const std::string& name;
  std::vector<double> wavelengths;  // micrometres
  bool known_wavelengths;           // no: there is one, and it stands for a wavelength that nobody has said
  std::span<const TypeBTerm> terms = {};

  Json wavelength_json(double wavelength) const {
    return known_wavelengths ? Json(nanometres(wavelength)) : Json(nullptr);
  }
  UncertainModel uncertain_at(double wavelength) const {
    return uncertain(model, wavelength, {terms.begin(), terms.end()});
  }
};

inline std::string at(const Geometry& geometry) { return place_line(geometry); }

inline std::string count_of(std::size_t count, const std::string& what) {
  return counted(static_cast<long>(count), what);
}

inline std::string nm(double wavelength) { return nanometre_list(std::array{wavelength}); }

/// Where a table says what f11 is multiplied by; nothing of one value, which says it everywhere.
inline std::string reach_of(const ReflectanceTable& table) {
  if (table.values.size() < 2) return "";
  return "; valid from " + nm(table.wavelengths.front()) + " to " + nm(table.wavelengths.back()) + ", and f11 with it";
}

inline void add(Json& report, const std::string& name, ReportField field) {
  report[name] = std::move(field.value);
  for (std::string& warning : field.warnings) report["warnings"].push_back(std::move(warning));
  for (std::string& note : field.notes) report["notes"].push_back(std::move(note));
}

/// The fields uncertainty, terms, reflectances and budgets.
void add_reflectances(Json& report, const ReportSubject& subject);

/// All that samples say of a model, and of themselves.
void add_samples(Json& report, const Model& model, const ReportedSamples& data);

}  // namespace mmbrdf
