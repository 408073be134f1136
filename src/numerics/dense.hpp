// SPDX-License-Identifier: BSD-3-Clause
/// Factorizations of dense matrices that several sources need. They are templates of Eigen, which take a compiler
/// seconds each: dense.cpp alone instantiates them.
#pragma once

#include <Eigen/Core>

namespace mmbrdf::dense {

/// m = U diag(s) Vᵀ, s falling.
struct Svd {
  Eigen::MatrixXd u, v;
  Eigen::VectorXd s;
};

/// U and V have as many columns as m has singular values.
Svd thin_svd(const Eigen::MatrixXd& m);
/// U and V are square.
Svd full_svd(const Eigen::MatrixXd& m);
/// The same without U.
Svd right_svd(const Eigen::MatrixXd& m);
Eigen::VectorXd singular_values(const Eigen::MatrixXd& m);

/// A symmetric matrix = V diag(values) Vᵀ, values rising; of the matrix the lower triangle counts.
struct Eigensystem {
  Eigen::MatrixXd vectors;
  Eigen::VectorXd values;
};
Eigensystem eigensystem(const Eigen::MatrixXd& symmetric);
Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& symmetric);

/// Of any square matrix, in no order.
Eigen::VectorXcd complex_eigenvalues(const Eigen::MatrixXd& m);

/// R of m = Q R, square. m has at least as many rows as columns.
Eigen::MatrixXd triangle(const Eigen::MatrixXd& m);
/// And multiplies others by Q from the right.
Eigen::MatrixXd triangle(const Eigen::MatrixXd& m, Eigen::MatrixXd& others);
/// R⁻¹.
Eigen::MatrixXd inverse_of_triangle(const Eigen::MatrixXd& r);

/// The x that makes |rows x − values| least; rows have full rank.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& rows, const Eigen::VectorXd& values);
/// The shortest such x for each column of values, whatever the rank.
Eigen::MatrixXd shortest_least_squares(const Eigen::MatrixXd& rows, const Eigen::MatrixXd& values);

}  // namespace mmbrdf::dense
