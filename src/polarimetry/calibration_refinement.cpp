// SPDX-License-Identifier: BSD-3-Clause
#include "polarimetry/calibration_refinement.hpp"

// Maximum likelihood of all unknowns at once: Σ (B − g A M W)² / σ², by Levenberg and Marquardt with the derivatives
// dB = dA M W + A dM W + A M dW. The scale that A and W share, and that of the gains, are held by two more rows.
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "numerics/dense.hpp"
#include "numerics/levenberg_marquardt.hpp"
#include "polarimetry/reference_slopes.hpp"

namespace mmbrdf::calibration {
namespace {

using Eigen::Index;
using Eigen::Matrix4d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Where each unknown stands: W, A, offset, leak, then those of each reference.
struct Layout {
  Index generator_states, analyzer_states, leaks;
  std::vector<Index> first;  ///< of each reference
  Index size;

  Layout(std::span<const Reference> references, const CalibrationOptions& options)
      : generator_states(index(options.generator_states)),
        analyzer_states(index(options.analyzer_states)),
        leaks(options.fit_polarizer_phase ? 2 : 1),
        size(4 * (generator_states + analyzer_states) + 1 + leaks) {
    for (const Reference& reference : references) {
      first.push_back(size);
      size += unknowns_of(reference.kind);
    }
  }
  Index analyzer() const { return 4 * generator_states; }
  Index offset() const { return 4 * (generator_states + analyzer_states); }
  PolarizerPlaces polarizer() const { return {offset(), offset() + 1, leaks == 2 ? offset() + 2 : -1}; }
};

void take_step(Unknowns& x, const Layout& layout, std::span<const Reference> references, const VectorXd& step) {
  x.generator += Eigen::Map<const MatrixXd>(step.data(), 4, layout.generator_states);
  x.analyzer += Eigen::Map<const MatrixXd>(step.data() + layout.analyzer(), 4, layout.analyzer_states);
  move_references(x, references, step, layout.first, layout.polarizer());
}

/// Sets up the rows of one reference.
void add_rows(Linearised& rows, Index first, const Unknowns& x, std::span<const Reference> references, std::size_t i,
              const Layout& layout, const CalibrationOptions& options, const VectorXd& sigma) {
  const Reference& reference = references[i];
  const auto [m, derivatives] = reference_slopes(x, references, i, options, layout.first[i], layout.polarizer());
  for (Index q = 0; q < layout.analyzer_states; ++q)
    for (Index p = 0; p < layout.generator_states; ++p) {
      const Index row = first + q * layout.generator_states + p;
      const auto a = x.analyzer.col(q);
      const auto w = x.generator.col(p);
      auto slope = rows.jacobian.row(row);
      slope.segment(4 * p, 4) = a.transpose() * m / sigma(row);
      slope.segment(layout.analyzer() + 4 * q, 4) = (m * w).transpose() / sigma(row);
      for (const auto& [place, d] : derivatives) slope(place) = a.dot(d * w) / sigma(row);
      const double reading = reference.readings[static_cast<std::size_t>(q * layout.generator_states + p)];
      rows.residuals(row) = (reading - a.dot(m * w)) / sigma(row);
    }
}

Linearised linearised(const Unknowns& x, std::span<const Reference> references, const Layout& layout,
                      const CalibrationOptions& options, const VectorXd& sigma) {
  const Index readings = sigma.size();
  Linearised rows{MatrixXd::Zero(readings + 2, layout.size), VectorXd::Zero(readings + 2)};
  for (std::size_t i = 0; i < references.size(); ++i)
    add_rows(rows, index(i) * layout.analyzer_states * layout.generator_states, x, references, i, layout, options,
             sigma);
  const double firm = 1e3 * rows.jacobian.colwise().norm().maxCoeff();
  double gains = 0, count = 0;
  for (std::size_t i = 0; i < references.size(); ++i)
    if (references[i].kind == ReferenceKind::empty) {
      rows.jacobian(readings + 1, layout.first[i]) = firm;
      gains += x.gains[i];
      ++count;
    }
  for (Index p = 0; p < layout.generator_states; ++p) rows.jacobian(readings, 4 * p) = firm;
  rows.residuals(readings) = firm * (static_cast<double>(layout.generator_states) - x.generator.row(0).sum());
  rows.residuals(readings + 1) = firm * (count - gains);
  return rows;
}

/// σ of each reading, from what the unknowns predict.
VectorXd deviations(const Unknowns& x, std::span<const Reference> references, const CalibrationOptions& options) {
  VectorXd sigma(index(references.size() * options.analyzer_states * options.generator_states));
  Index next = 0;
  double largest = 0;
  for (std::size_t i = 0; i < references.size(); ++i) {
    const MatrixXd b = x.analyzer.transpose() * expected(x, references, i, options) * x.generator;
    for (Index q = 0; q < b.rows(); ++q)
      for (Index p = 0; p < b.cols(); ++p) {
        largest = std::max(largest, std::abs(b(q, p)));
        sigma(next++) = std::sqrt(variance(options.noise, b(q, p)));
      }
  }
  return sigma.cwiseMax(least_sigma * largest);
}

}  // namespace

Refinement refine(Unknowns& unknowns, std::span<const Reference> references, const CalibrationOptions& options) {
  const Layout layout(references, options);
  VectorXd sigma;
  for (int pass = 0; pass < 3; ++pass) {  // the weights follow what is predicted
    sigma = deviations(unknowns, references, options);
    levenberg_marquardt(
        unknowns, [&](const Unknowns& x) { return linearised(x, references, layout, options, sigma); },
        [&](Unknowns& x, const VectorXd& step) { take_step(x, layout, references, step); });
  }
  const Linearised rows = linearised(unknowns, references, layout, options, sigma);
  const Index states = 4 * (layout.generator_states + layout.analyzer_states);
  Refinement result;
  result.chi_squared = rows.residuals.head(sigma.size()).squaredNorm();
  const VectorXd scales = rows.jacobian.colwise().norm().transpose();
  const MatrixXd inverse =
      dense::inverse_of_triangle(dense::triangle(rows.jacobian * scales.cwiseInverse().asDiagonal()));
  const VectorXd units = scales.head(states).cwiseInverse();
  const MatrixXd half = units.asDiagonal() * inverse.topRows(states);
  const double variance = result.chi_squared / static_cast<double>(degrees_of_freedom(references, options));
  result.covariance.resize(static_cast<std::size_t>(states * states));
  Eigen::Map<MatrixXd>(result.covariance.data(), states, states)
      .selfadjointView<Eigen::Lower>()
      .rankUpdate(half, variance);
  Eigen::Map<MatrixXd> full(result.covariance.data(), states, states);
  full.triangularView<Eigen::StrictlyUpper>() = full.transpose().eval();
  return result;
}

long degrees_of_freedom(std::span<const Reference> references, const CalibrationOptions& options) {
  const Index readings = index(references.size() * options.analyzer_states * options.generator_states);
  return readings - (Layout(references, options).size - 2);
}

}  // namespace mmbrdf::calibration
