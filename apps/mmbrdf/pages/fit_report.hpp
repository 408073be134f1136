// SPDX-License-Identifier: BSD-3-Clause
// What `mmbrdf fit` prints.
#pragma once

#include <string>

#include "mmbrdf/fitting/fit.hpp"
#include "pages/output.hpp"

namespace mmbrdf::program {

struct FitReport {
  std::string data;        ///< name of the data file
  std::string weights;     ///< none, speckle, data or estimated
  std::string covariance;  ///< residuals, sandwich or given
  long rows;
  const FitResult& result;
};

/// "532 nm: sigma^2 = 0.0051^2 cos(theta_i)^0.80 / cos(theta_r)^1.04" with standard uncertainties: the law number i.
std::string noise_line(const FitResult& result, std::size_t i);

/// The table of residuals, on standard output.
void print(const FitReport& report, Format format);

}  // namespace mmbrdf::program
