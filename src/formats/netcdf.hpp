// SPDX-License-Identifier: BSD-3-Clause
// Self-describing NetCDF, 3 and 4: a variable brdf over any axes, the last two row and column if it has all elements, and
// wavelength_nm, theta_i_deg … phi_r_deg over some of these axes or none.
#pragma once

#include "formats/reader.hpp"
#include "mmbrdf/formats/export.hpp"

namespace mmbrdf {

bool is_netcdf(std::string_view head, std::uint64_t size);

/// Throws std::runtime_error in a build without NetCDF.
std::unique_ptr<ForeignFile::Reader> open_netcdf(const Source& source);

/// NetCDF-4 over wavelengths, polar angles of both directions and phi_r, with uncertainty and validity beside the matrices.
Export::Made make_netcdf(const Model& model, const ExportOptions& options);

}  // namespace mmbrdf
