// SPDX-License-Identifier: BSD-3-Clause
/// Published coefficients, in the layout that SCATMECH reads (docs/formats.md).
///
/// Reading throws std::runtime_error with "file:line: …" and the value that is wrong.
#pragma once

#include <iosfwd>
#include <string>

#include "mmbrdf/model/model.hpp"

namespace mmbrdf {

/// Published coefficient files: i, j, n, m, k, l, p, a without a header, rows in any order. The model has family
/// germer2017, no reflectance table, and its validity is unknown; powers of a mode that the file lacks are 0. Throws
/// std::runtime_error for indices that break a rule, duplicates, i > j, and p outside 0…9.
Model read_coefficients(const std::string& path);
Model read_coefficients(std::istream& in, const std::string& name);

/// The published layout, which SCATMECH reads; of an isotropic model its published form. Reading a published file and
/// writing it gives the same bytes, but for the line ends. Reflectance table, validity, covariance and rotation have no
/// place in it: the caller must say so. Throws std::invalid_argument for a model that has no published form: an
/// anisotropic one, or another mapping than lambert.
std::string to_coefficients_csv(const Model& model);

}  // namespace mmbrdf
