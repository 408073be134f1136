// SPDX-License-Identifier: BSD-3-Clause
// What --budget prints: a line for each value, with what each cause contributes to its uncertainty.
#pragma once

#include <string>
#include <vector>

#include "mmbrdf/uncertainty/expanded.hpp"
#include "pages/table.hpp"

namespace mmbrdf::program {

struct BudgetLine {
  std::string name;  ///< "f11", "dhr 532 nm, theta_i 8"
  double value = 0;
  ExpandedUncertainty uncertainty;
};

/// All lines have the same causes, first the fit. Empty if there are no lines.
std::string budget_text(const std::vector<BudgetLine>& lines);

/// {"terms": [{"term", "u", "degrees_of_freedom"}, …], "u", "degrees_of_freedom", "k", "U"}; null is infinite.
Json budget_json(const ExpandedUncertainty& uncertainty);

}  // namespace mmbrdf::program
