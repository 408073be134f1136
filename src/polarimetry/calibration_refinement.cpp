// SPDX-License-Identifier: BSD-3-Clause
#include "polarimetry/calibration_refinement.hpp"

// Maximum likelihood of all unknowns at once: Σ (B − g A M W)² / σ², by Levenberg and Marquardt with the derivatives
// dB = dA M W + A dM W + A M dW. The scale that A and W share, and that of the gains, are held by two more rows.
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "numerics/dense.hpp"
#include "text/numbers.hpp"

namespace mmbrdf::calibration {
namespace {

using Eigen::Index;
using Eigen::Matrix4d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double least_sigma = 1e-5;  // of the largest reading: no weight of a single reading is infinite

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
      size += reference.kind == ReferenceKind::wafer ? 3 : 1;
    }
  }
  Index analyzer() const { return 4 * generator_states; }
  Index offset() const { return 4 * (generator_states + analyzer_states); }
  Index leak() const { return offset() + 1; }
};

void take_step(Unknowns& x, const Layout& layout, std::span<const Reference> references, const VectorXd& step) {
  x.generator += Eigen::Map<const MatrixXd>(step.data(), 4, layout.generator_states);
  x.analyzer += Eigen::Map<const MatrixXd>(step.data() + layout.analyzer(), 4, layout.analyzer_states);
  x.offset += step(layout.offset());
  x.leak_real += step(layout.leak());
  if (layout.leaks == 2) x.leak_imaginary += step(layout.leak() + 1);
  for (std::size_t i = 0; i < references.size(); ++i) {
    const Index at = layout.first[i];
    if (references[i].kind != ReferenceKind::wafer) {
      x.gains[i] += step(at);
      continue;
    }
    x.elements[i].tau += step(at);
    x.elements[i].psi += step(at + 1);
    x.elements[i].delta += step(at + 2);
  }
}

/// The derivative of a matrix over one unknown, by its place.
struct Derivative {
  Index place;
  Matrix4d slope;
};

void wafer_derivatives(std::vector<Derivative>& result, const DiattenuatorRetarder& wafer, Index at) {
  const auto& [tau, psi, delta] = wafer;
  result.push_back({at, matrix(mueller({1, psi, delta}))});
  // d/dψ: c → −2S, S → 2c, the sum that is on the diagonal of the first block does not change.
  Mueller over_psi = mueller({tau, psi + std::numbers::pi / 4, delta});  // c(ψ + 45°) = −S, S(ψ + 45°) = c
  over_psi(0, 0) = over_psi(1, 1) = 0;
  result.push_back({at + 1, 2 * matrix(over_psi)});
  Mueller over_delta = mueller({tau, psi, delta + std::numbers::pi / 2});
  over_delta(0, 0) = over_delta(1, 1) = over_delta(0, 1) = over_delta(1, 0) = 0;
  result.push_back({at + 2, matrix(over_delta)});
}

void polarizer_derivatives(std::vector<Derivative>& result, const Unknowns& x, double azimuth, double gain, Index at,
                           const Layout& layout) {
  const double a = x.leak_real, b = x.leak_imaginary;
  const Mueller m = leaky_polarizer(azimuth, a, b);
  result.push_back({at, matrix(m)});
  // d R(α) / dα = 2 R(α) G with G the generator of turns: M turns as R(−α) M R(α).
  Matrix4d turn = Matrix4d::Zero();
  turn(1, 2) = 1;
  turn(2, 1) = -1;
  result.push_back({layout.offset(), gain * 2 * (matrix(m) * turn - turn * matrix(m))});
  const auto leak = [&](double slope, double real, double imaginary) {
    Mueller d = diagonal(slope, slope, real, real);
    d(0, 1) = d(1, 0) = -slope;
    d(3, 2) = imaginary;
    d(2, 3) = -imaginary;
    return Matrix4d(gain * matrix(rotated(d, azimuth)));
  };
  result.push_back({layout.leak(), leak(a, 1, 0)});
  if (layout.leaks == 2) result.push_back({layout.leak() + 1, leak(b, 0, 1)});
}

struct Linearised {
  MatrixXd jacobian;   ///< in units of σ; the two rows that fix the scales come last
  VectorXd residuals;  ///< likewise
};

/// Sets up the rows of one reference.
void add_rows(Linearised& rows, Index first, const Unknowns& x, std::span<const Reference> references, std::size_t i,
              const Layout& layout, const CalibrationOptions& options, const VectorXd& sigma) {
  const Reference& reference = references[i];
  const bool wafer = reference.kind == ReferenceKind::wafer;
  const double gain = wafer ? 1 : x.gains[i];
  const Matrix4d unit = matrix(reference_matrix(x, references, i, options));
  std::vector<Derivative> derivatives;
  if (wafer) wafer_derivatives(derivatives, x.elements[i], layout.first[i]);
  if (reference.kind == ReferenceKind::empty) derivatives.push_back({layout.first[i], unit});
  if (reference.kind == ReferenceKind::polarizer)
    polarizer_derivatives(derivatives, x, x.offset + options.dial_sense * reference.angle, gain, layout.first[i],
                          layout);
  const Matrix4d m = gain * unit;
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
    const double gain = references[i].kind == ReferenceKind::wafer ? 1 : x.gains[i];
    const MatrixXd b =
        gain * x.analyzer.transpose() * matrix(reference_matrix(x, references, i, options)) * x.generator;
    for (Index q = 0; q < b.rows(); ++q)
      for (Index p = 0; p < b.cols(); ++p) {
        largest = std::max(largest, std::abs(b(q, p)));
        sigma(next++) = std::sqrt(variance(options.noise, b(q, p)));
      }
  }
  return sigma.cwiseMax(least_sigma * largest);
}

/// One minimisation with fixed weights.
void minimise(Unknowns& x, std::span<const Reference> references, const Layout& layout,
              const CalibrationOptions& options, const VectorXd& sigma) {
  double damping = 1e-6;
  Linearised now = linearised(x, references, layout, options, sigma);
  for (int iteration = 0; iteration < 50 && damping < 1e6; ++iteration) {
    const VectorXd scales = now.jacobian.colwise().norm().cwiseMax(1e-300).transpose();
    MatrixXd rows(now.jacobian.rows() + layout.size, layout.size);
    rows.topRows(now.jacobian.rows()) = now.jacobian * scales.cwiseInverse().asDiagonal();
    rows.bottomRows(layout.size) = std::sqrt(damping) * MatrixXd::Identity(layout.size, layout.size);
    VectorXd values = VectorXd::Zero(rows.rows());
    values.head(now.residuals.size()) = now.residuals;
    const VectorXd step = dense::least_squares(rows, values).cwiseQuotient(scales);
    Unknowns moved = x;
    take_step(moved, layout, references, step);
    Linearised next = linearised(moved, references, layout, options, sigma);
    const double before = now.residuals.squaredNorm(), after = next.residuals.squaredNorm();
    if (!(after <= before)) {
      damping *= 10;
      continue;
    }
    x = std::move(moved);
    now = std::move(next);
    damping /= 10;
    if (before - after <= 1e-12 * before) break;
  }
}

}  // namespace

Refinement refine(Unknowns& unknowns, std::span<const Reference> references, const CalibrationOptions& options) {
  const Layout layout(references, options);
  VectorXd sigma;
  for (int pass = 0; pass < 3; ++pass) {  // the weights follow what is predicted
    sigma = deviations(unknowns, references, options);
    minimise(unknowns, references, layout, options, sigma);
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
