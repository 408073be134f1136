// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/fitting/symmetry.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <unsupported/Eigen/SpecialFunctions>

#include "basis/rows.hpp"
#include "text/numbers.hpp"

// Functions that break a symmetry are the terms of modes, with other signs or in other elements. With Z(i,r) =
// V_n^k(i) V_m^l(r), as in modes.cpp:
//
//   a mode of 11, 44, u, v     has Z(i,r), whose incident factor is of order (n, |k|), and Z(r,i) or its conjugate
//   a mode of 14, g, h         has Z(i,r) in the elements above or below the diagonal, and Z(r,i) in the others
//   i times Z                  mixes the Stokes components 2 and 3: (x, y) → (−y, x) for those of scattered light,
//                              (y, −x) for those of incident light

namespace mmbrdf {
namespace {

using Column = std::vector<Term>;  // a function: what it gives to each element

constexpr double azimuth_tolerance = radians(0.1);
constexpr double exact = 1e-12;  // residuals below this part of the data are no noise
constexpr int harmonics = 4;     // cos φ, sin φ, cos 2φ, sin 2φ

bool is_paired(const Mode& mode) {
  return mode.function == Function::m14 || mode.function == Function::g || mode.function == Function::h;
}

/// The terms of Z(i,r); the others are those of Z(r,i). Empty for a mode that is its own twin.
struct Halves {
  Column first, second;
};

Halves halves(const Mode& mode) {
  const auto [function, n, m, k, l] = mode;
  if (!is_paired(mode) && n == m && std::abs(k) == std::abs(l)) return {};
  Halves result;
  for (const Term& term : terms(mode, Family::isotropic)) {
    const bool first = is_paired(mode) ? term.row < term.column
                                       : term.incident == zernike_index(n, k) || term.incident == zernike_index(n, -k);
    (first ? result.first : result.second).push_back(term);
  }
  return result;
}

Column scaled(Column column, double factor) {
  for (Term& term : column) term.weight *= factor;
  return column;
}

Column joined(Column a, const Column& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Column in_element(Column column, int row, int col) {
  for (Term& term : column) {
    term.row = row;
    term.column = col;
  }
  return column;
}

/// i times the complex function.
Column times_i(Column column) {
  for (Term& term : column) {
    const bool of_scattered = term.row == 1 || term.row == 2;
    int& component = of_scattered ? term.row : term.column;
    if (component == (of_scattered ? 2 : 1)) term.weight = -term.weight;
    component = 3 - component;
  }
  return column;
}

std::vector<Column> reciprocity_breaking(const Block& block) {
  std::vector<Column> columns;
  for (const Mode& mode : block.modes)
    if (const Halves h = halves(mode); !h.first.empty()) columns.push_back(joined(h.first, scaled(h.second, -1)));
  return columns;
}

/// Re Z(i,r) in 14 and Re Z(r,i) in 41, for every n and m.
std::vector<Column> handed_14(int order) {
  std::vector<Column> columns;
  const Block block_11 = blocks(Family::isotropic, Orders{order, 0}).front();
  for (const Mode& mode : block_11.modes) {
    auto [first, second] = halves(mode);
    if (first.empty()) first = second = terms(mode, Family::isotropic);
    columns.push_back(joined(in_element(first, 0, 3), in_element(second, 3, 0)));
    if (mode.n != mode.m) columns.push_back(joined(in_element(second, 0, 3), in_element(first, 3, 0)));
  }
  return columns;
}

std::vector<Column> mirror_breaking(const Block& block, int order) {
  if (block.modes.front().function == Function::m14) return handed_14(order);
  std::vector<Column> columns;
  for (const Mode& mode : block.modes) switch (mode.function) {
      case Function::m11:
      case Function::m44:
        if (mode.n != mode.m && mode.k > 0) {  // Im Z(i,r) + Im Z(r,i), which is 0 for n = m
          const int e = mode.function == Function::m11 ? 0 : 3;
          const Mode imaginary{Function::m14, mode.n, mode.m, mode.k, mode.l};
          columns.push_back(in_element(terms(imaginary, Family::isotropic), e, e));
        }
        break;
      case Function::v:  // i Z(i,r) − i conj Z(r,i), which is 0 for n = m
        if (const Halves h = halves(mode); !h.first.empty())
          columns.push_back(joined(times_i(h.first), scaled(times_i(h.second), -1)));
        break;
      default:
        columns.push_back(times_i(terms(mode, Family::isotropic)));
    }
  return columns;
}

// ---- fits -----------------------------------------------------------------------------------------------------------

struct Problem {
  std::span<const Sample> samples;
  std::span<const Mueller> weights;
  std::vector<double> wavelengths;
  int order = 0;
  DiscMapping mapping = DiscMapping::lambert;
};

/// Rows of the block at one wavelength over some columns and, if asked, harmonics of φi in each element.
LeastSquares rows_at(const Problem& problem, double wavelength, const Block& block, const std::vector<Column>& columns,
                     bool with_harmonics) {
  const std::size_t extra = with_harmonics ? harmonics * block.elements.size() : 0;
  const std::size_t width = columns.size() + extra;
  LeastSquares result(static_cast<int>(width));
  const Rows functions(columns);
  for (std::size_t s = 0; s < problem.samples.size(); ++s) {
    const Sample sample = with_harmonics ? at_zero_azimuth(problem.samples[s]) : problem.samples[s];
    if (!same_wavelength(sample.wavelength, wavelength)) continue;
    const KTable k_i = functions_at(sample.geometry.incident, problem.order, problem.mapping),
                 k_r = functions_at(sample.geometry.reflected, problem.order, problem.mapping);
    std::vector<double> rows(block.elements.size() * width), values, weights;
    for (std::size_t e = 0; e < block.elements.size(); ++e) {
      const auto [row, column] = block.elements[e];
      functions.add(block.elements[e].index(), k_i, k_r, &rows[e * width]);
      if (with_harmonics)
        for (std::size_t h = 0; h < harmonics; ++h) {
          const double angle = static_cast<double>(1 + h / 2) * problem.samples[s].geometry.incident.phi;
          rows[e * width + columns.size() + harmonics * e + h] = h % 2 == 0 ? std::cos(angle) : std::sin(angle);
        }
      const double value = row + column == 0 ? sample.f11 : sample.normalized(row, column);
      values.push_back(std::isnan(value) ? 0 : value);
      weights.push_back(std::isnan(value) ? 0 : problem.weights.empty() ? 1 : problem.weights[s](row, column));
    }
    result.add(rows, values, weights);
  }
  return result;
}

double total_weight(const Problem& problem, const Block& block) {
  double weight = 0;
  for (std::size_t s = 0; s < problem.samples.size(); ++s)
    for (const auto& [row, column] : block.elements)
      if (!not_measured(problem.samples[s])[Element{row, column}.index()])
        weight += problem.weights.empty() ? 1 : problem.weights[s](row, column);
  return weight;
}

double squared(double x) { return x * x; }

FTest compared(const Problem& problem, const Block& block, const std::vector<Column>& more, bool with_harmonics) {
  std::vector<Column> columns;
  for (const Mode& mode : block.modes) columns.push_back(terms(mode, Family::isotropic));
  std::vector<std::size_t> modes(columns.size());
  std::iota(modes.begin(), modes.end(), std::size_t{0});
  columns.insert(columns.end(), more.begin(), more.end());

  FTest test;
  test.block = block.name;
  double without = 0, with = 0, data = 0;
  for (const double wavelength : problem.wavelengths) {
    const LeastSquares rows = rows_at(problem, wavelength, block, columns, with_harmonics);
    const LeastSquares base = rows.restricted(modes);
    const double tolerance = FitOptions{}.rank_tolerance;
    const Solution large = rows.solve(tolerance), small = base.solve(tolerance);
    test.rows += large.rows;
    test.extra += large.rank - small.rank;
    test.freedom += large.degrees_of_freedom();
    without += squared(small.residual_norm);
    with += squared(large.residual_norm);
    data += squared(base.residual_norm(std::vector<double>(modes.size(), 0.0)));
  }
  if (const double weight = total_weight(problem, block); weight > 0) {
    test.rms = std::sqrt(without / weight);
    test.rms_extended = std::sqrt(with / weight);
  }
  const double noise = std::max(with, squared(exact) * data);  // exact data have none
  if (test.extra <= 0 || test.freedom <= 0 || noise <= 0) {
    test.extra = 0;
    return test;
  }
  const auto q = static_cast<double>(test.extra), nu = static_cast<double>(test.freedom);
  test.f = std::max(0.0, without - with) / q * nu / noise;
  test.p = f_probability(test.f, q, nu);
  return test;
}

bool has_one_azimuth(std::span<const Sample> samples) {
  const Direction* first = nullptr;
  for (const Sample& sample : samples) {
    const Direction& incident = sample.geometry.incident;
    if (incident.theta <= azimuth_tolerance) continue;  // along the normal an azimuth means nothing
    if (!first) first = &incident;
    if (std::abs(std::remainder(incident.phi - first->phi, 2 * std::numbers::pi)) > azimuth_tolerance) return false;
  }
  return true;
}

}  // namespace

double f_probability(double f, double numerator, double denominator) {
  if (!(f >= 0) || !(numerator > 0) || !(denominator > 0))
    throw std::invalid_argument("F = " + shortest(f) + " with " + shortest(numerator) + " and " +
                                shortest(denominator) + " degrees of freedom");
  if (std::isinf(f)) return 0;
  const double x = denominator / (denominator + numerator * f);  // Abramowitz and Stegun 26.6.2
  return std::clamp(Eigen::numext::betainc(denominator / 2, numerator / 2, x), 0.0, 1.0);
}

SymmetryTests symmetry_tests(std::span<const Sample> samples, const Orders& orders, DiscMapping mapping,
                             std::span<const Mueller> weights) {
  if (samples.empty()) throw std::invalid_argument("no samples");
  require_valid(samples);
  if (!weights.empty() && weights.size() != samples.size())
    throw std::invalid_argument(std::to_string(weights.size()) + " weights for " + std::to_string(samples.size()) +
                                " samples");
  const Problem problem{samples, weights, wavelengths(samples), std::max(orders.f11, orders.other), mapping};
  SymmetryTests result;
  result.one_azimuth = has_one_azimuth(samples);
  for (const Block& block : without(not_measured(samples), blocks(Family::isotropic, orders))) {
    result.reciprocity.push_back(compared(problem, block, reciprocity_breaking(block), false));
    result.mirror.push_back(compared(problem, block, mirror_breaking(block, orders.other), false));
    if (!result.one_azimuth) result.azimuth.push_back(compared(problem, block, {}, true));
  }
  return result;
}

}  // namespace mmbrdf
