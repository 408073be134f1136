// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarization/decompositions.hpp"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "mmbrdf/polarization/analysis.hpp"
#include "polarization/bounded.hpp"
#include "polarization/kernel/analysis_kernels.hpp"
#include "text/numbers.hpp"

//   n        M / M11, whose elements are at most 1
//   d, p     diattenuation and polarizance vector of n
//   A(d)     diattenuator with unit transmittance of unpolarized light
//   X        what is left of n between diattenuators
//   m'       its lower right 3 × 3 block, U diag(σ) Vᵀ

namespace mmbrdf {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector3d;
using Eigen::Vector4d;
using Matrix16d = Eigen::Matrix<double, 16, 16>;
using RowMajor = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
using Svd = Eigen::JacobiSVD<Matrix3d>;

constexpr double rounding = 1e-13;       // of elements of n
constexpr double sufficient = 5e-15;     // of a product of factors
constexpr double largest_d0 = 1e8;       // relative to M11; it grows without bound where there is no diagonal form
constexpr double largest_d = 1 - 1e-14;  // of a diattenuator that can be inverted

Matrix4d matrix(const Mueller& m) { return Eigen::Map<const RowMajor>(m.elements.data()); }

Mueller as_mueller(const Matrix4d& matrix) {
  Mueller result;
  Eigen::Map<RowMajor>(result.elements.data()) = matrix;
  return result;
}

/// n; throws std::invalid_argument unless M11 > 0 and M is realizable.
Matrix4d normalized_realizable(const Mueller& m) {
  const bool possible = realizable(m);
  if (!(m(0, 0) > 0)) throw std::invalid_argument("M11 = " + shortest(m(0, 0)) + ", must be positive");
  if (!possible)
    throw std::invalid_argument("the matrix is not realizable, by " + shortest(realizability_margin(m)) +
                                " of M11; nearest_realizable() gives one that is");
  return matrix(normalized(m));
}

/// Of M11 where the kernel does not scale M, which is realizable; else 0.
int exponent_far_away(const Mueller& m) {
  int exponent = 0;
  std::frexp(m(0, 0), &exponent);
  return std::abs(exponent) > 300 && realizable(m) ? exponent : 0;
}

Mueller times_power_of_two(Mueller m, int exponent) {
  for (double& element : m.elements) element = bounded(std::ldexp(element, exponent));
  return m;
}

/// A(d), |d| ≤ 1; (1 − a) / d² = 1 / (1 + a) has no singularity.
Matrix4d diattenuator(const Vector3d& d) {
  const double length = d.norm();
  const double a = 1 - length < 1e-15 ? 0 : std::sqrt((1 - length) * (1 + length));  // √ of the rounding of d is 1e-8
  Matrix4d result;
  result << 1, d.transpose(), d, a * Matrix3d::Identity() + d * d.transpose() / (1 + a);
  return result;
}

Vector3d shortened(const Vector3d& d) {
  const double length = d.norm();
  return length > largest_d ? Vector3d(d * (largest_d / length)) : d;
}

/// What of v is perpendicular to a unit vector, or to 0; twice, since the rounding of the first time is not.
Vector3d across(const Vector3d& v, const Vector3d& axis) {
  const Vector3d once = v - axis.dot(v) * axis;
  return once - axis.dot(once) * axis;
}

/// x A(d)⁻¹, |d| < 1, row by row in the eigenvectors (1, ±d̂) and those across them: the error of a product with A(d) is
/// then that of rounding, however close |d| is to 1.
Matrix4d without_diattenuator(const Matrix4d& x, const Vector3d& d) {
  const double length = d.norm();
  const Vector3d axis = d.stableNormalized();  // 0 if d is
  Matrix4d result;
  for (int row = 0; row < 4; ++row) {
    const Vector3d b = x.row(row).tail<3>();
    const double along = b.dot(axis);
    const double plus = (x(row, 0) + along) / (1 + length), minus = (x(row, 0) - along) / (1 - length);
    result(row, 0) = (plus + minus) / 2;
    result.row(row).tail<3>() = (plus - minus) / 2 * axis + across(b, axis) / std::sqrt((1 - length) * (1 + length));
  }
  return result;
}

Matrix4d retarder(const Matrix3d& rotation) {
  Matrix4d result = Matrix4d::Identity();
  result.bottomRightCorner<3, 3>() = rotation;
  return result;
}

/// The smallest rotation from the direction of one vector to that of another; 1 if either is 0. A reflection at the
/// first direction, then one at the bisector; opposite directions have many.
Matrix3d smallest_rotation(const Vector3d& from, const Vector3d& to) {
  const Vector3d u = from.stableNormalized(), v = to.stableNormalized();
  if (u.isZero(0) || v.isZero(0)) return Matrix3d::Identity();
  const Vector3d across = (u - v).stableNormalized();
  Vector3d bisector = u + v;
  if (u.dot(v) < 0) bisector -= across.dot(bisector) * across;  // the rounding of |u| and |v|, where that counts
  bisector = bisector.norm() > 1e-15 ? bisector.normalized() : across.unitOrthogonal();
  const Matrix3d one = Matrix3d::Identity();
  return (2 * bisector * bisector.transpose() - one) * (2 * u * u.transpose() - one);
}

/// m_R of m' = m_Δ m_R.
Matrix3d rotation_of(const Matrix3d& m) {
  const Svd svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector3d& sigma = svd.singularValues();
  if (sigma[0] <= rounding) return Matrix3d::Identity();
  if (sigma[1] <= rounding) return smallest_rotation(svd.matrixV().col(0), svd.matrixU().col(0));
  const double handedness = svd.matrixU().determinant() * svd.matrixV().determinant() > 0 ? 1 : -1;
  if (sigma[2] <= rounding) return svd.matrixU() * Vector3d(1, 1, handedness).asDiagonal() * svd.matrixV().transpose();
  return handedness * svd.matrixU() * svd.matrixV().transpose();
}

/// Whether n = (1, p)(1, d)ᵀ, as for every realizable matrix with |d| = 1 or |p| = 1.
bool is_product(const Matrix4d& n) { return (n - n.col(0) * n.row(0)).cwiseAbs().maxCoeff() <= rounding; }

/// Whether n depolarizes nothing.
bool is_pure(const Matrix4d& n) { return n.squaredNorm() >= 4 - rounding; }

bool is_complete(const Vector3d& v) { return v.norm() >= 1 - rounding; }

/// Factors of n = diattenuator2 · middle · diattenuator1, middle = (d0, 0; 0, m').
struct Sandwich {
  Vector3d d2, d1;
  Matrix4d middle;
  Matrix4d product() const { return diattenuator(d2) * middle * diattenuator(d1); }
};

Matrix4d blocks_of(const Matrix4d& x) {
  Matrix4d result = Matrix4d::Zero();
  result(0, 0) = x(0, 0);
  result.bottomRightCorner<3, 3>() = x.bottomRightCorner<3, 3>();
  return result;
}

/// From a diattenuator in front: (1, d2) ~ n (1, −d1).
Sandwich sandwich(const Matrix4d& n, const Vector3d& d1) {
  const Vector4d out = n * Vector4d(1, -d1[0], -d1[1], -d1[2]);
  const Vector3d d2 = shortened(out.tail<3>() / out[0]);
  const Matrix4d right = without_diattenuator(n, d1);
  return {d2, d1, blocks_of(without_diattenuator(right.transpose(), d2).transpose())};
}

double distance(const Matrix4d& a, const Matrix4d& b) { return (a - b).cwiseAbs().maxCoeff(); }

/// The eigenvector (1, −d1) by squaring G nᵀ G n, which maps Stokes vectors to Stokes vectors. Where the eigenvalue is
/// not a single one, that part of unpolarized light which belongs to it: all of it where n is pure.
Sandwich leading(const Matrix4d& n) {
  const Vector4d g(1, -1, -1, -1);
  Sandwich best = sandwich(n, Vector3d::Zero());
  if (is_pure(n)) return best;
  double error = distance(best.product(), n);
  Matrix4d power = g.asDiagonal() * n.transpose() * g.asDiagonal() * n;
  for (int i = 0; i < 60 && error > sufficient && power(0, 0) > 0; ++i) {
    power /= power(0, 0);
    const Sandwich next = sandwich(n, shortened(-power.col(0).tail<3>()));
    const double next_error = distance(next.product(), n);
    if (next_error < error) {
      best = next;
      error = next_error;
    }
    power = (power * power).eval();
  }
  return best;
}

/// ∂A/∂d_k.
Matrix4d diattenuator_slope(const Vector3d& d, int k) {
  const double a = std::sqrt((1 - d.norm()) * (1 + d.norm()));
  const Vector3d e = Vector3d::Unit(k);
  Matrix4d result;
  result << 0, e.transpose(), e,
      -d[k] / a * Matrix3d::Identity() + (e * d.transpose() + d * e.transpose()) / (1 + a) +
          d * d.transpose() * (d[k] / (a * (1 + a) * (1 + a)));
  return result;
}

/// ∂n of each of the 16 unknowns, a column each: d2, d1, m' by rows, d0.
Matrix16d slopes(const Sandwich& s) {
  const Matrix4d a2 = diattenuator(s.d2), a1 = diattenuator(s.d1);
  Matrix16d result;
  for (int k = 0; k < 3; ++k) {
    result.col(k) = (diattenuator_slope(s.d2, k) * s.middle * a1).reshaped();
    result.col(3 + k) = (a2 * s.middle * diattenuator_slope(s.d1, k)).reshaped();
    for (int column = 0; column < 3; ++column)
      result.col(6 + 3 * k + column) = (a2.col(k + 1) * a1.row(column + 1)).reshaped();
  }
  result.col(15) = (a2.col(0) * a1.row(0)).reshaped();
  return result;
}

/// One Gauss–Newton step towards n, without directions that change n by less than `threshold` of the rest.
Sandwich improved(const Matrix4d& n, const Sandwich& s, const Matrix16d& slopes, double threshold) {
  Eigen::CompleteOrthogonalDecomposition<Matrix16d> solver;
  solver.setThreshold(threshold);
  solver.compute(slopes);
  const Matrix4d missing = n - s.product();
  const Eigen::Matrix<double, 16, 1> step = solver.solve(missing.reshaped());
  Sandwich result{shortened(s.d2 + step.segment<3>(0)), shortened(s.d1 + step.segment<3>(3)), s.middle};
  for (int row = 0; row < 3; ++row) result.middle.row(row + 1).tail<3>() += step.segment<3>(6 + 3 * row).transpose();
  result.middle(0, 0) += step[15];
  return result;
}

/// Where d1 or d2 is close to 1 the middle is found from n with few digits, and where the eigenvalue is nearly a
/// multiple one so is d1. What counts is the product: least squares, of the middle alone first, then of everything.
Sandwich refined(const Matrix4d& n, Sandwich best) {
  double error = distance(best.product(), n);
  const auto attempt = [&](const Sandwich& next) {
    const double next_error = distance(next.product(), n);
    if (!(next_error < error)) return;
    best = next;
    error = next_error;
  };
  for (int i = 0; i < 30 && error > sufficient; ++i) {
    const double before = error;
    Matrix16d columns = slopes(best);
    if (is_pure(n)) columns.middleCols<3>(3).setZero();  // d1 stays 0
    for (const double threshold : {1e-14, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4})
      attempt(improved(n, best, columns, threshold));
    columns.leftCols<6>().setZero();
    attempt(improved(n, best, columns, 1e-14));
    if (!(error < before)) break;
  }
  if (!(error <= symmetric_error) || best.middle(0, 0) > largest_d0)
    throw std::invalid_argument("the matrix has no diagonal depolarizer, or is too close to such a one");
  return best;
}

/// For n = (1, p)(1, d)ᵀ.
Sandwich of_product(const Vector3d& p, const Vector3d& d) {
  if (is_complete(p) && is_complete(d)) return {p, d, retarder(smallest_rotation(d, p)) / 2};
  return {p, d, Vector4d(1, 0, 0, 0).asDiagonal()};
}

/// The middle by its singular values.
SymmetricDecomposition unfolded(double m11, const Sandwich& s) {
  const Svd svd(s.middle.bottomRightCorner<3, 3>(), Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3d u = svd.matrixU(), v = svd.matrixV();
  Vector3d sigma = svd.singularValues();
  for (Matrix3d* side : {&u, &v})
    if (side->determinant() < 0) {
      side->col(2) *= -1;
      sigma[2] *= -1;
    }
  const auto times_m11 = [m11](double x) { return bounded(m11 * x); };
  return {as_mueller(diattenuator(s.d2)), as_mueller(retarder(u)),
          diagonal(times_m11(s.middle(0, 0)), times_m11(sigma[0]), times_m11(sigma[1]), times_m11(sigma[2])),
          as_mueller(retarder(v)), as_mueller(diattenuator(s.d1))};
}

}  // namespace

LuChipman lu_chipman(const Mueller& m) {
  if (const auto numbers = answer_of<Analysis::lu_chipman>(m)) return std::bit_cast<LuChipman>(*numbers);
  if (const int exponent = exponent_far_away(m)) {
    LuChipman result = lu_chipman(times_power_of_two(m, -exponent));
    result.diattenuator = times_power_of_two(result.diattenuator, exponent);
    return result;
  }
  const Matrix4d n = normalized_realizable(m);
  const Vector3d d = n.row(0).tail<3>(), p = n.col(0).tail<3>();
  if (is_complete(d) && is_product(n)) {
    const double length = p.norm();
    return {diagonal(1, length, length, length), as_mueller(retarder(smallest_rotation(d, p))),
            m(0, 0) * as_mueller(diattenuator(d.normalized()))};
  }
  const Vector3d inner = shortened(d);
  Matrix4d x = without_diattenuator(n, inner);
  const Matrix3d rotation = rotation_of(x.bottomRightCorner<3, 3>());
  const Matrix3d product = x.bottomRightCorner<3, 3>() * rotation.transpose();
  x.row(0) << 1, 0, 0, 0;
  x.bottomRightCorner<3, 3>() = (product + product.transpose()) / 2;
  return {as_mueller(x), as_mueller(retarder(rotation)), m(0, 0) * as_mueller(diattenuator(inner))};
}

double retardance(const Mueller& m) {
  const Matrix4d n = matrix(normalized(m));
  const Matrix3d r = n.bottomRightCorner<3, 3>();
  if (!(m(0, 0) > 0) || !(distance(n, retarder(r)) <= 1e-9) || !((r * r.transpose()).isIdentity(1e-9)) ||
      !(r.determinant() > 0))
    throw std::invalid_argument("the matrix is not that of a retarder");
  const Vector3d twice_sine(r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1));
  return std::atan2(twice_sine.norm(), r.trace() - 1);
}

double depolarization_power(const Mueller& m) {
  if (!(m(0, 0) > 0)) throw std::invalid_argument("M11 = " + shortest(m(0, 0)) + ", must be positive");
  const Mueller n = normalized(m);
  return std::max(1 - std::abs(n(1, 1) + n(2, 2) + n(3, 3)) / 3, 0.0);
}

SymmetricDecomposition symmetric_decomposition(const Mueller& m) {
  if (const auto numbers = answer_of<Analysis::symmetric_decomposition>(m))
    return std::bit_cast<SymmetricDecomposition>(*numbers);
  if (const int exponent = exponent_far_away(m)) {
    SymmetricDecomposition result = symmetric_decomposition(times_power_of_two(m, -exponent));
    result.depolarizer = times_power_of_two(result.depolarizer, exponent);
    return result;
  }
  const Matrix4d n = normalized_realizable(m);
  const Vector3d d = n.row(0).tail<3>(), p = n.col(0).tail<3>();
  const bool product = is_product(n) && (is_complete(d) || is_complete(p));
  return unfolded(m(0, 0), product ? of_product(p, d) : refined(n, leading(n)));
}

}  // namespace mmbrdf
