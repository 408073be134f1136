// SPDX-License-Identifier: BSD-3-Clause
// What analyze prints about one geometry.
#pragma once

#include "options/question.hpp"
#include "pages/analyzer.hpp"

namespace mmbrdf::program {

struct AnalysisReport {
  const Question& question;
  Place place;
  const Analyzer& analyzer;
  Analysis analysis;
};

void print_text(const AnalysisReport& report);
void print_json(const AnalysisReport& report);

/// A value to the digits that its standard uncertainty leaves: "0.3284 +- 0.0012". Without one: six digits.
std::string rounded(double value, const std::optional<double>& uncertainty);

}  // namespace mmbrdf::program
