// SPDX-License-Identifier: BSD-3-Clause
// What several commands say about a model.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/model/model.hpp"
#include "mmbrdf/quantities/trust.hpp"
#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf::program {

/// The fields of basis_line(), and the fitted wavelengths.
nlohmann::ordered_json basis_json(const Model& model);

/// Says on standard error if --as-printed has no meaning for the model called `name`.
void note_unless_printed(const Model& model, const std::string& name);

/// Says on standard error how many samples lie outside what the model called `name` was fitted to, and what it does not
/// say of that.
void warn_if_outside(const Model& model, std::span<const Sample> samples, const std::string& name);

/// Says on standard error at which of these wavelengths (micrometres), the first, more light comes back than falls in along
/// the normal, and what that usually comes from.
void warn_if_above_one(const Model& model, std::span<const double> wavelengths);

/// Directional-hemispherical reflectance at normal incidence: "0.9751 +- 0.0031 at 351 nm, 0.9842 +- 0.0036 at 532 nm"
std::string normal_reflectance_line(const Model& model);
nlohmann::ordered_json normal_reflectance_json(const Model& model);

/// "u: standard uncertainty of the fit alone; scale is not in it" and a line end, of those two; of the terms that were added.
std::string uncertainty_line(const std::string& uncertain, const std::string& missing,
                             const std::vector<std::string>& terms);

/// 0 for what is 0 but for rounding, and not -0.0000000000.
double without_rounding(double x);

/// Four lines: elements to the place of their uncertainties if these are known, else ten decimals; points below each
/// other.
std::string matrix_text(const Mueller& m, const std::optional<Mueller>& u = {});

/// An array of four rows.
nlohmann::ordered_json matrix_json(const Mueller& m);

/// Each field and each row of a table in a line of its own.
std::string printed(const nlohmann::ordered_json& json);

/// One of these as it is, several as {"rows": […]}.
std::string printed_all(const std::vector<nlohmann::ordered_json>& all);

/// printed() on standard output.
void print(const nlohmann::ordered_json& json);

}  // namespace mmbrdf::program
