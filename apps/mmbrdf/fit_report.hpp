// SPDX-License-Identifier: BSD-3-Clause
// What `mmbrdf fit` prints.
#pragma once

#include <string>

#include "mmbrdf/fit.hpp"
#include "output.hpp"

namespace mmbrdf::program {

struct FitReport {
  std::string data;     ///< name of the data file
  std::string weights;  ///< none or speckle
  long rows;
  const FitResult& result;
};

/// The table of residuals, on standard output.
void print(const FitReport& report, Format format);

}  // namespace mmbrdf::program
