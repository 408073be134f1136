// SPDX-License-Identifier: BSD-3-Clause
// What analyze prints: about one geometry, and as columns about many.
#pragma once

#include "mmbrdf/quantities/answer.hpp"
#include "options/question.hpp"
#include "pages/page.hpp"

namespace mmbrdf::program {

struct AnalysisReport {
  const Question& question;
  Place place;
  const Answers& answers;
  Answer answer;
  bool budget = false;             ///< expanded, of each value
  std::optional<double> coverage;  ///< of the budget, beside that of 95 %
};

Page page_of(const AnalysisReport& report);
Json json_of(const AnalysisReport& report);

/// ",f11,…,f44,validity,u_f11,…,u_f44,depolarization,u_depolarization,…,estimable"
AddedColumns analyzed_columns(const Answers& answers, bool strict);

/// Throws std::invalid_argument, for --strict, unless a place is known to be inside the fitted range.
void require_inside(Outside outside, const Validity& validity);

}  // namespace mmbrdf::program
