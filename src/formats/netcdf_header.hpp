// SPDX-License-Identifier: BSD-3-Clause
// The header of a NetCDF file in a classic format (Unidata, "File Format Specifications": magic CDF and 1, 2 or 5). The
// library believes it: a wrong count makes it take gigabytes or crash. So it is read here before the library sees it.
#pragma once

#include <string>

namespace mmbrdf {

/// Throws std::runtime_error, in one line, unless each count, length, type and offset of the header can be and all
/// variables are within the file. What is not classic (HDF5) is passed over.
void require_classic_header(const std::string& path);

}  // namespace mmbrdf
