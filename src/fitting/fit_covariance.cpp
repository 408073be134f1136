// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Core>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "basis/spectral.hpp"
#include "fitting/row_variance.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"
#include "numerics/eigen_index.hpp"
#include "numerics/svd_cache.hpp"

// Covariances of a fit that are not s² (XᵀWX)⁺.
//
//   X, W, y   rows, weights and values at one wavelength, τ = XᵀW y; f11 is divided by the reflectance R
//   Λ         repeats a row over the powers of the wavelength: (1, λ, λ², …) ⊗ row
//   G         (Σ Λ XᵀWX Λᵀ)⁺ of the fit over all wavelengths, a = G Σ Λ τ
//   P, d      (XᵀWX)⁺ of f11 at one wavelength alone; its reflectance is R = dᵀ P XᵀW (R y)
//   C         covariance of τ at one wavelength: s² XᵀWX, or Σ w² r² x xᵀ from the residuals r ("sandwich")

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Symmetric or square matrices in row-major order.
MatrixXd square(const std::vector<double>& values, Index size) {
  return Eigen::Map<const MatrixXd>(values.data(), size, size).transpose();
}

VectorXd vector(const std::vector<double>& values) {
  return Eigen::Map<const VectorXd>(values.data(), index(values.size()));
}

std::vector<double> row_major(const MatrixXd& m) {
  const MatrixXd transposed = m.transpose();
  return {transposed.data(), transposed.data() + transposed.size()};
}

double small_sample_factor(const Solution& solution) {
  return static_cast<double>(solution.rows) / static_cast<double>(solution.degrees_of_freedom());
}

}  // namespace

/// With a reflectance from the data themselves an error ε of τ changes both R, by R dᵀP ε, and what y is divided by:
///   dR = R dᵀP ε,     da = G Λ (ε − τ dR / R).
void FitAccumulator::add_own_reflectance_covariance(FitResult& result, const FitOptions& options, SvdCache& known,
                                                    const FitAccumulator* squares) const {
  Model& model = result.model;
  const Solution& f11 = result.solutions.front();
  const Index modes = index(blocks_.front().modes.size()), size = index(f11.x.size()),
              count = index(wavelengths_.size());
  const MatrixXd g = square(f11.inverse, size);
  const VectorXd d = vector(directional_hemispherical_slopes(blocks_.front(), basis_.family, basis_.mapping, {}));
  MatrixXd covariance = MatrixXd::Zero(size + count, size + count);  // of a, then of R
  Index k = 0;
  for (const auto& [wavelength, at] : wavelengths_) {
    const LeastSquares& rows = at.elements.front();
    const double reflectance = model.reflectance.values[static_cast<std::size_t>(k)];
    const VectorXd tau = vector(rows.normal_vector()) / reflectance;
    const VectorXd q = square(rows.solve(options.rank_tolerance, &known).inverse, modes) * d;
    const MatrixXd c = squares ? square(squares->wavelengths_.at(wavelength).elements.front().normal_matrix(), modes)
                               : MatrixXd(*row_variance(f11, options.covariance) * square(rows.normal_matrix(), modes));
    MatrixXd slopes = MatrixXd::Zero(size + count, modes);
    slopes.topRows(size) = g * repetition(modes, powers_of(wavelength, model.powers)) *
                           (MatrixXd::Identity(modes, modes) - tau * q.transpose());
    slopes.row(size + k) = reflectance * q.transpose();
    covariance += slopes * c * slopes.transpose();
    ++k;
  }
  if (squares) covariance *= small_sample_factor(f11);
  covariance = (0.5 * (covariance + covariance.transpose())).eval();
  model.blocks.front().covariance = row_major(covariance.topLeftCorner(size, size));
  model.reflectance.covariance = row_major(covariance.bottomRightCorner(count, count));
  model.reflectance.covariance_with_f11 = row_major(covariance.bottomLeftCorner(count, size));
}

/// G (Σ w² r² x xᵀ) G over the rows of each block; `squares` holds the rows with weights w² r².
void FitAccumulator::use_sandwich(FitResult& result, const FitOptions& options, const FitAccumulator& squares) const {
  Model& model = result.model;
  SvdCache known;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Solution& solution = result.solutions[b];
    if (solution.degrees_of_freedom() <= 0) continue;
    const Index size = index(solution.x.size());
    MatrixXd middle = MatrixXd::Zero(size, size);
    for (const Element& element : blocks_[b].elements)
      for (const auto& [wavelength, at] : squares.wavelengths_) {
        const LeastSquares& rows = at.elements[element.index()];
        const MatrixXd repeat = repetition(rows.unknowns(), powers_of(wavelength, model.powers));
        middle += repeat * square(rows.normal_matrix(), rows.unknowns()) * repeat.transpose();
      }
    const MatrixXd g = square(solution.inverse, size);
    const MatrixXd half = g * middle * g * small_sample_factor(solution);
    model.blocks[b].covariance = row_major(0.5 * (half + half.transpose()));
  }
  if (takes_own_reflectance(options) && result.solutions.front().degrees_of_freedom() > 0)
    add_own_reflectance_covariance(result, options, known, &squares);
}

}  // namespace mmbrdf
