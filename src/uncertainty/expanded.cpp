// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/uncertainty/expanded.hpp"

#include <cmath>
#include <stdexcept>
#include <unsupported/Eigen/SpecialFunctions>
#include <utility>

#include "mmbrdf/polarization/gradients.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr double outside_coverage = 0.05, normal_factor = 1.959963984540054;

/// Probability of |t| or more (Abramowitz and Stegun 26.7.1).
double two_sided(double t, double freedom) {
  return Eigen::numext::betainc(freedom / 2, 0.5, freedom / (freedom + t * t));
}

}  // namespace

double coverage_factor(double freedom) {
  if (!(freedom >= 1)) throw std::invalid_argument(shortest(freedom) + " degrees of freedom: must be 1 or more");
  if (std::isinf(freedom)) return 2;
  constexpr double as_normal = 1e6;  // from there on they differ by less than 3e-6
  if (freedom > as_normal) return normal_factor;
  double low = normal_factor, high = 13;  // that of one degree of freedom is 12.7
  while (high - low > 1e-9) {
    const double middle = (low + high) / 2;
    (two_sided(middle, freedom) > outside_coverage ? low : high) = middle;
  }
  return (low + high) / 2;
}

std::vector<Contribution> contributions(const Budget& budget, const Mueller& gradient) {
  std::vector<Contribution> result;
  for (const BudgetTerm& term : budget.terms)
    result.push_back({term.name, standard_uncertainty(gradient, term.covariance), term.freedom});
  return result;
}

double standard_uncertainty(const std::vector<Contribution>& contributions) {
  double variance = 0;
  for (const Contribution& c : contributions) variance += c.uncertainty * c.uncertainty;
  return std::sqrt(variance);
}

ExpandedUncertainty expanded(std::vector<Contribution> contributions) {
  ExpandedUncertainty result;
  for (const Contribution& c : contributions)
    if (!(c.uncertainty >= 0) || std::isinf(c.uncertainty))
      throw std::invalid_argument("uncertainty " + shortest(c.uncertainty) + " of " + c.name +
                                  ", must be 0 or more and finite");
    else if (!(c.freedom >= 1))
      throw std::invalid_argument(shortest(c.freedom) + " degrees of freedom of " + c.name + ": must be 1 or more");
  result.uncertainty = standard_uncertainty(contributions);
  double sum = 0;  // of (u_c / u)⁴ / ν_c
  for (const Contribution& c : contributions)
    if (c.uncertainty > 0) sum += std::pow(c.uncertainty / result.uncertainty, 4) / c.freedom;
  if (sum > 0) result.freedom = 1 / sum;
  result.coverage_factor = coverage_factor(result.freedom);
  result.expanded = result.coverage_factor * result.uncertainty;
  result.contributions = std::move(contributions);
  return result;
}

}  // namespace mmbrdf
