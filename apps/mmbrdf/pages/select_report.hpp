// SPDX-License-Identifier: BSD-3-Clause
// What `mmbrdf select` prints.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mmbrdf/fitting/selection.hpp"
#include "pages/output.hpp"

namespace mmbrdf::program {

struct SelectReport {
  std::string data;     ///< name of the data file
  std::string weights;  ///< none, speckle, data or estimated
  long rows;
  std::vector<double> wavelengths;  ///< micrometres
  const SelectionOptions& options;
  std::span<const Partition> partitions;
  const Selection& selection;
};

/// The tables and the recommendation, on standard output.
void print(const SelectReport& report, Format format);

}  // namespace mmbrdf::program
