// SPDX-License-Identifier: BSD-3-Clause
/// What stands under a signature: the uncertainty of one number, cause by cause, and expanded to 95 % coverage (GUM
/// 2008, 6 and annex G).
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "mmbrdf/uncertainty/budget.hpp"

namespace mmbrdf {

/// What one cause contributes to the uncertainty of a number.
struct Contribution {
  std::string name;
  double uncertainty = 0;                                    ///< standard (k = 1), in the unit of the number
  double freedom = std::numeric_limits<double>::infinity();  ///< degrees of freedom
};

/// Of a number that is a function of a matrix, with this gradient over the elements in the frame of the budget: a
/// contribution for each term.
std::vector<Contribution> contributions(const Budget& budget, const Mueller& gradient);

/// Of all causes together: the root of the sum of squares, since they are independent.
double standard_uncertainty(const std::vector<Contribution>& contributions);

struct ExpandedUncertainty {
  std::vector<Contribution> contributions;
  double uncertainty = 0;                                    ///< standard, of all together
  double freedom = std::numeric_limits<double>::infinity();  ///< effective: u⁴ / Σ u_c⁴ / ν_c (Welch and Satterthwaite,
                                                             ///< GUM G.4); causes of infinite freedom do not count
  double coverage_factor = 2;                                ///< k
  double expanded = 0;                                       ///< U = k u
};

/// Throws std::invalid_argument for an uncertainty that is negative or not finite, or a freedom below 1.
ExpandedUncertainty expanded(std::vector<Contribution> contributions);

/// k of 95 % coverage: of Student's distribution with this many degrees of freedom, whole or not, to 1e-5 (GUM table
/// G.2); 2 where they are infinite, as is customary, and not 1.96. Throws std::invalid_argument below 1.
double coverage_factor(double freedom);

}  // namespace mmbrdf
