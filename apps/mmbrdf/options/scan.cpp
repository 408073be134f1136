// SPDX-License-Identifier: BSD-3-Clause
#include "options/scan.hpp"

#include <algorithm>
#include <cmath>

#include "pages/output.hpp"

namespace mmbrdf::program {

namespace {

constexpr const char* form = "VARIABLE=FROM:TO:STEP, as in theta_r=-75:75:1";
constexpr const char* variables[] = {"theta_i", "phi_i", "theta_r", "phi_r", "wavelength"};

bool scanned(const std::vector<Scan>& scans, const std::string& variable) {
  return std::any_of(scans.begin(), scans.end(), [&](const Scan& scan) { return scan.variable == variable; });
}

void set(Question& question, const std::string& variable, double value) {
  if (variable == "wavelength") {
    question.wavelength_nm = value;
    return;
  }
  const bool incident = variable.ends_with("_i");
  std::optional<DirectionDegrees>& direction = incident ? question.incident : question.reflected;
  if (!direction)  // theta_r alone runs in the plane of incidence, forward where it is positive
    direction = DirectionDegrees{0, incident ? 0 : question.incident.value_or(DirectionDegrees{}).phi + 180};
  (variable.starts_with("theta") ? direction->theta : direction->phi) = value;
}

constexpr double largest = 1e6;  // as far as values are rounded to their decimals

long steps_between(const std::string& text, double from, double to, double step) {
  if (std::max(std::abs(from), std::abs(to)) > largest)
    throw std::invalid_argument("\"" + text + "\": expected values up to " + shortest(largest));
  if (step == 0 || (to - from) / step < 0) {
    throw std::invalid_argument("\"" + text + "\": no step of " + shortest(step) + " leads from " + shortest(from) +
                                " to " + shortest(to));
  }
  const double steps = (to - from) / step + 1e-9;  // the last one may be rounded
  if (!(steps < static_cast<double>(max_scan_rows)))
    throw std::invalid_argument("\"" + text + "\": more than " + std::to_string(max_scan_rows) + " values");
  return static_cast<long>(steps);
}

}  // namespace

/// Without the digits that a sum such as -75 + 751 × 0.1 ends in.
double Scan::value(long i) const {
  if (!values.empty()) return values[static_cast<std::size_t>(i)];
  return std::round((from + static_cast<double>(i) * step) * 1e9) / 1e9;
}

Scan wavelength_scan(const std::vector<double>& wavelengths_nm) {
  return {.variable = "wavelength", .count = static_cast<long>(wavelengths_nm.size()), .values = wavelengths_nm};
}

Scan scan_from(const std::string& text) {
  const std::size_t equals = text.find('='), first = text.find(':', equals), second = text.find(':', first + 1);
  if (equals == std::string::npos || first == std::string::npos || second == std::string::npos)
    throw std::invalid_argument("\"" + text + "\": expected " + form);
  const std::string variable = text.substr(0, equals);
  if (std::find(std::begin(variables), std::end(variables), variable) == std::end(variables))
    throw std::invalid_argument("\"" + variable + "\": expected theta_i, phi_i, theta_r, phi_r or wavelength");
  const double from = number(text.substr(equals + 1, first - equals - 1));
  const double to = number(text.substr(first + 1, second - first - 1)), step = number(text.substr(second + 1));
  return {variable, from, step, steps_between(text, from, to, step) + 1, {}};
}

void require_complete(const std::vector<Scan>& scans, const Question& question) {
  for (const Scan& scan : scans)
    if (std::count_if(scans.begin(), scans.end(), [&](const Scan& s) { return s.variable == scan.variable; }) > 1)
      throw WrongUsage("--scan", scan.variable + " is scanned twice");
  if (!question.incident && !scanned(scans, "theta_i")) throw missing("--incident (or --scan theta_i=...)");
  if (!question.reflected && !scanned(scans, "theta_r")) throw missing("--reflected (or --scan theta_r=...)");
  double rows = 1;
  for (const Scan& scan : scans) rows *= static_cast<double>(scan.count);
  if (rows > static_cast<double>(max_scan_rows))
    throw WrongUsage("--scan", "more than " + std::to_string(max_scan_rows) + " rows");
}

long row_count(const std::vector<Scan>& scans) {
  long rows = 1;
  for (const Scan& scan : scans) rows *= scan.count;
  return rows;
}

Question at_row(const std::vector<Scan>& scans, Question question, long row) {
  for (auto scan = scans.rbegin(); scan != scans.rend(); ++scan) {
    set(question, scan->variable, scan->value(row % scan->count));
    row /= scan->count;
  }
  return question;
}

}  // namespace mmbrdf::program
