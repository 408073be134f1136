// SPDX-License-Identifier: BSD-3-Clause
#include "numerics/dense.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace mmbrdf::dense {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Not BDCSVD: for the triangles of symmetric grids it returned singular vectors that were off by 2e-4 (Eigen 3.4).
Eigen::JacobiSVD<MatrixXd> factorized(const MatrixXd& m, unsigned vectors) {
  return Eigen::JacobiSVD<MatrixXd>(m, vectors);
}

MatrixXd triangle_of(const Eigen::HouseholderQR<MatrixXd>& qr) {
  return qr.matrixQR().topRows(qr.cols()).triangularView<Eigen::Upper>();
}

}  // namespace

Svd thin_svd(const MatrixXd& m) {
  const auto svd = factorized(m, Eigen::ComputeThinU | Eigen::ComputeThinV);
  return {svd.matrixU(), svd.matrixV(), svd.singularValues()};
}

Svd full_svd(const MatrixXd& m) {
  const auto svd = factorized(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {svd.matrixU(), svd.matrixV(), svd.singularValues()};
}

Svd right_svd(const MatrixXd& m) {
  const auto svd = factorized(m, Eigen::ComputeFullV);
  return {{}, svd.matrixV(), svd.singularValues()};
}

VectorXd singular_values(const MatrixXd& m) { return factorized(m, 0).singularValues(); }

Eigensystem eigensystem(const MatrixXd& symmetric) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(symmetric);
  return {solver.eigenvectors(), solver.eigenvalues()};
}

VectorXd eigenvalues(const MatrixXd& symmetric) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(symmetric, Eigen::EigenvaluesOnly).eigenvalues();
}

Eigen::VectorXcd complex_eigenvalues(const MatrixXd& m) { return Eigen::EigenSolver<MatrixXd>(m, false).eigenvalues(); }

MatrixXd triangle(const MatrixXd& m) { return triangle_of(Eigen::HouseholderQR<MatrixXd>(m)); }

MatrixXd triangle(const MatrixXd& m, MatrixXd& others) {
  const Eigen::HouseholderQR<MatrixXd> qr(m);
  others.applyOnTheRight(qr.householderQ());
  return triangle_of(qr);
}

MatrixXd inverse_of_triangle(const MatrixXd& r) {
  return r.triangularView<Eigen::Upper>().solve(MatrixXd::Identity(r.rows(), r.cols()));
}

VectorXd least_squares(const MatrixXd& rows, const VectorXd& values) {
  return Eigen::HouseholderQR<MatrixXd>(rows).solve(values);
}

MatrixXd shortest_least_squares(const MatrixXd& rows, const MatrixXd& values) {
  return rows.completeOrthogonalDecomposition().solve(values);
}

}  // namespace mmbrdf::dense
