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
//   S         every covariance is formed as S Sᵀ from the triangle behind C, which keeps it positive semidefinite

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

/// R of XᵀWX = RᵀR.
MatrixXd triangle_of(const LeastSquares& rows) {
  const std::vector<double> state = rows.state();  // of [R Qᵀb], row by row from the diagonal on
  const Index n = rows.unknowns();
  MatrixXd r = MatrixXd::Zero(n, n);
  for (Index i = 0, first = 0; i < n; first += n + 1 - i++)
    r.row(i).tail(n - i) = Eigen::Map<const Eigen::RowVectorXd>(&state[static_cast<std::size_t>(first)], n - i);
  return r;
}

/// A sum of products S Sᵀ: no variance is negative, whatever the condition of the S.
class Covariances {
 public:
  explicit Covariances(Index size) : sum_(MatrixXd::Zero(size, size)) {}
  void add(const MatrixXd& s) { sum_.selfadjointView<Eigen::Lower>().rankUpdate(s); }
  std::vector<double> times(double factor) const {
    return row_major(factor * MatrixXd(sum_.selfadjointView<Eigen::Lower>()));
  }

 private:
  MatrixXd sum_;
};

}  // namespace

/// With a reflectance from the data themselves an error ε of τ changes both R, by R dᵀP ε, and what y is divided by:
///   dR = R dᵀP ε,     da = G Λ (ε − τ dR / R).
/// The reflectances of different wavelengths have nothing in common.
void FitAccumulator::add_own_reflectance_covariance(FitResult& result, const FitOptions& options, SvdCache& known,
                                                    const FitAccumulator* squares) const {
  Model& model = result.model;
  const Solution& f11 = result.solutions.front();
  const Index modes = index(blocks_.front().modes.size()), size = index(f11.x.size()),
              count = index(wavelengths_.size());
  const MatrixXd g = square(f11.inverse, size);
  const VectorXd d = vector(directional_hemispherical_slopes(blocks_.front(), basis_.family, basis_.mapping, {}));
  const double factor = squares ? small_sample_factor(f11) : *row_variance(f11, options.covariance);
  Covariances of_a(size);
  model.reflectance.covariance.clear();
  MatrixXd with_f11(size, count);  // row-major, transposed
  for (Index k = 0; const auto& [wavelength, at] : wavelengths_) {
    const LeastSquares& rows = at.elements.front();
    const double reflectance = model.reflectance.values[static_cast<std::size_t>(k)];
    const VectorXd tau = vector(rows.normal_vector()) / reflectance;
    const VectorXd q = square(rows.solve(options.rank_tolerance, &known).inverse, modes) * d;
    const MatrixXd root =  // of C
        triangle_of(squares ? squares->wavelengths_.at(wavelength).elements.front() : rows).transpose();
    const MatrixXd change = g * repetition(modes, powers_of(wavelength, model.powers)) *
                            (MatrixXd::Identity(modes, modes) - tau * q.transpose()) * root;
    const VectorXd change_of_r = reflectance * (root.transpose() * q);
    of_a.add(change);
    model.reflectance.covariance.push_back(factor * change_of_r.squaredNorm());
    with_f11.col(k++) = factor * (change * change_of_r);
  }
  model.blocks.front().covariance = of_a.times(factor);
  model.reflectance.covariance_with_f11.assign(with_f11.data(), with_f11.data() + with_f11.size());
}

/// G (Σ w² r² x xᵀ) G over the rows of each block; `squares` holds the rows with weights w² r².
void FitAccumulator::use_sandwich(FitResult& result, const FitOptions& options, const FitAccumulator& squares) const {
  Model& model = result.model;
  SvdCache known;
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    const Solution& solution = result.solutions[b];
    if (solution.degrees_of_freedom() <= 0) continue;
    const Index size = index(solution.x.size());
    const MatrixXd g = square(solution.inverse, size);
    Covariances of_a(size);
    for (const Element& element : model.blocks[b].block.elements)
      for (const auto& [wavelength, at] : squares.wavelengths_) {
        const LeastSquares& rows = at.elements[element.index()];
        of_a.add(g * repetition(rows.unknowns(), powers_of(wavelength, model.powers)) * triangle_of(rows).transpose());
      }
    model.blocks[b].covariance = of_a.times(small_sample_factor(solution));
  }
  if (takes_own_reflectance(options) && result.solutions.front().degrees_of_freedom() > 0)
    add_own_reflectance_covariance(result, options, known, &squares);
}

}  // namespace mmbrdf
