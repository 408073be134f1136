// SPDX-License-Identifier: BSD-3-Clause
// Mueller BRDFs of isotropic samples as Mitsuba's measured_polarized and the KAIST data base have them: a tensor file of
// M[phi_d, theta_d, theta_h, wavelength, out, in] in sr⁻¹, perpendicular to the scattering plane, S4 > 0 right-handed.
#pragma once

#include "formats/reader.hpp"
#include "mmbrdf/formats/export.hpp"

namespace mmbrdf {

bool is_pbsdf(std::string_view head, std::uint64_t size);
std::unique_ptr<ForeignFile::Reader> open_pbsdf(const Source& source);

Export::Made make_pbsdf(const Model& model, const ExportOptions& options);

}  // namespace mmbrdf
