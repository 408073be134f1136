// SPDX-License-Identifier: BSD-3-Clause
// What `mmbrdf report` says, as fields that are printed as Markdown or JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/dataset.hpp"
#include "mmbrdf/model.hpp"

namespace mmbrdf::program {

struct ReportedModel {
  std::string name;
  const Model& model;
  std::vector<double> wavelengths;  ///< to report on, micrometres
  bool known_wavelengths;           ///< no: there is one, and it stands for a wavelength that nobody has said
};

/// title, warnings, model, fit, realizability, reflectances.
nlohmann::ordered_json model_facts(const ReportedModel& reported);

/// Adds residuals, symmetry tests, noise and outliers of samples, and warnings of them.
void add_data_facts(nlohmann::ordered_json& facts, const ReportedModel& reported, const std::string& data,
                    std::span<const Sample> samples);

}  // namespace mmbrdf::program
