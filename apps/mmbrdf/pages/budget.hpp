// SPDX-License-Identifier: BSD-3-Clause
// What --budget prints: a line for each value, with what each cause contributes to its uncertainty.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mmbrdf/uncertainty/expanded.hpp"
#include "pages/page.hpp"

namespace mmbrdf::program {

struct BudgetLine {
  std::string name;  ///< "f11", "dhr 532 nm, theta_i 8"
  double value = 0;
  ExpandedUncertainty uncertainty;
};

/// All lines have the same causes, first the fit. With U of a coverage factor that was asked for, beside that of 95 %.
/// Empty if there are no lines.
Page budget_page(const std::vector<BudgetLine>& lines, const std::optional<double>& coverage);

/// {"terms": [{"term", "u", "degrees_of_freedom"}, …], "u", "degrees_of_freedom", "k", "U"}; null is infinite. Of a coverage
/// factor also "asked_k", "asked_U".
Json budget_json(const ExpandedUncertainty& uncertainty, const std::optional<double>& coverage);

}  // namespace mmbrdf::program
