// SPDX-License-Identifier: BSD-3-Clause
// Certified reflectances as they are typed, or in a file.
#pragma once

#include <istream>
#include <string>
#include <vector>

#include "mmbrdf/radiometry/certificate.hpp"

namespace mmbrdf::program {

/// THETA:NM:R[+-U][,…], or the path of a CSV file with the columns wavelength_nm, reflectance, u_reflectance (or u) and,
/// unless it is 8, theta_i_deg. Of a file, values outside the fitted wavelengths are left out, with a note. Throws
/// WrongUsage for another form, std::runtime_error for a file that cannot be read.
std::vector<CertifiedReflectance> certificate_from(const std::string& text, const Validity& validity);

/// All values of such a file; errors are std::runtime_error with "name:line: ...".
std::vector<CertifiedReflectance> read_certificate(std::istream& in, const std::string& name);

}  // namespace mmbrdf::program
