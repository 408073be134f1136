// SPDX-License-Identifier: BSD-3-Clause
// Reflectances as they are typed, or in a file: certified ones, and those by which f11 is divided.
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

/// --reflectance: NM:R[,NM:R…] in any order, or the path of a table with the columns wavelength_nm and reflectance, or of these
/// two without names, in any order. A column of uncertainties is refused: it may be a third without a name, and a scale with
/// an uncertainty is a certificate.
/// Throws std::invalid_argument for another form, std::runtime_error for a file that cannot be read.
ReflectanceTable reflectance_from(const std::string& text);

/// The same of a fit, in which f11 is divided by the table and multiplied by it again: uncertainties do not count, as a note
/// says.
ReflectanceTable reflectance_of_fit(const std::string& text);

/// All values of such a file; errors are std::runtime_error with "name:line: ...".
std::vector<CertifiedReflectance> read_certificate(std::istream& in, const std::string& name);

}  // namespace mmbrdf::program
