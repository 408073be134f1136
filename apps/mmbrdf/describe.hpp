// SPDX-License-Identifier: BSD-3-Clause
// What several commands say about a model.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/dataset.hpp"
#include "mmbrdf/model.hpp"

namespace mmbrdf::program {

/// "isotropic, orders 7,4, wavelength powers 0 to 1, lambert mapping: 142 modes, 284 coefficients"
std::string basis_line(const Model& model);

/// The same as fields, and the fitted wavelengths.
nlohmann::ordered_json basis_json(const Model& model);

/// Wavelengths (micrometres) at which to show the model: the fitted ones, else the nodes of the reflectance table; for
/// models that need none and know none, some one. Empty if nothing is known.
std::vector<double> known_wavelengths(const Model& model);

/// "theta_i <= 75, theta_r <= 81.87 degrees", or "not known"
std::string angles_line(const Validity& validity);

/// "theta_i <= 75, theta_r <= 81.87 degrees at 351, 532 nm", or what of it is known
std::string fitted_range(const Validity& validity);

/// Whether an angle or the wavelength is outside, and not only unknown.
bool leaves_known_range(Outside outside);

/// What the model called `model` does not say about its range. Empty if it says all.
std::string unknown_range_line(const std::string& model, const Validity& validity);

/// Says on standard error if --as-printed has no meaning for the model called `name`.
void note_unless_printed(const Model& model, const std::string& name);

/// Says on standard error how many samples lie outside what the model called `name` was fitted to, and what it does not
/// say of that.
void warn_if_outside(const Model& model, std::span<const Sample> samples, const std::string& name);

/// Directional-hemispherical reflectance at normal incidence: "0.97515 at 351 nm, 0.98416 at 532 nm"
std::string normal_reflectance_line(const Model& model);
nlohmann::ordered_json normal_reflectance_json(const Model& model);

/// Each field and each row of a table in a line of its own.
std::string printed(const nlohmann::ordered_json& json);

/// The same on standard output.
void print(const nlohmann::ordered_json& json);

}  // namespace mmbrdf::program
