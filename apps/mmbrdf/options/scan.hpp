// SPDX-License-Identifier: BSD-3-Clause
// Angles and wavelengths that run through ranges.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "options/question.hpp"

namespace mmbrdf::program {

/// What runs: theta_i, phi_i, theta_r, phi_r in degrees, wavelength in nm.
struct Scan {
  std::string variable;
  double from = 0, step = 0;
  long count = 0;
  std::vector<double> values = {};  ///< if there are any, these and no range

  double value(long i) const;
};

/// VARIABLE=FROM:TO:STEP, both ends included. Throws std::invalid_argument, naming the text.
Scan scan_from(const std::string& text);

/// Through wavelengths that were typed.
Scan wavelength_scan(const std::vector<double>& wavelengths_nm);

/// The product of the scans must not have more rows.
inline constexpr long max_scan_rows = 10000000;

/// What is not scanned must have been given by -i, -r and -w, but azimuths, which are 0 where a polar angle is scanned.
/// That, a variable that is scanned twice and too many rows are wrong usage.
void require_complete(const std::vector<Scan>& scans, const Question& question);

long row_count(const std::vector<Scan>& scans);

/// The question with the values of row `row` in it; the last scan runs fastest.
Question at_row(const std::vector<Scan>& scans, Question question, long row);

}  // namespace mmbrdf::program
