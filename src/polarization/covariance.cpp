// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarization/covariance.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "numerics/dense.hpp"
#include "numerics/semidefinite.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

/// The first argument, column after column, after M → left M right; the result is transposed.
MuellerCovariance transformed_once(const MuellerCovariance& covariance, const Mueller& left, const Mueller& right) {
  MuellerCovariance result;
  for (std::size_t other = 0; other < 16; ++other) {
    Mueller m;
    for (std::size_t e = 0; e < 16; ++e) m.elements[e] = covariance(e, other);
    m = left * m * right;
    for (std::size_t e = 0; e < 16; ++e) result(other, e) = m.elements[e];
  }
  return result;
}

}  // namespace

void require_valid(const MuellerCovariance& covariance) {
  using RowMajor = Eigen::Matrix<double, 16, 16, Eigen::RowMajor>;
  const Eigen::Map<const RowMajor> v(covariance.values.data());
  constexpr double rounding = 1e-9;
  if (!v.allFinite()) throw std::invalid_argument("the covariance is not finite");
  const double allowed = rounding * v.cwiseAbs().maxCoeff();
  for (Eigen::Index e = 0; e < 16; ++e)
    for (Eigen::Index other = e + 1; other < 16; ++other)
      if (std::abs(v(e, other) - v(other, e)) > allowed)
        throw std::invalid_argument("the covariance is not symmetric: " + shortest(v(e, other)) + " and " +
                                    shortest(v(other, e)) + " at " + std::to_string(e) + ", " + std::to_string(other) +
                                    ", counted from 0");
  require_semidefinite(dense::eigenvalues(v), "the elements", rounding);
}

Mueller standard_uncertainty(const MuellerCovariance& covariance) {
  Mueller result;
  for (std::size_t e = 0; e < 16; ++e) result.elements[e] = std::sqrt(std::max(covariance(e, e), 0.0));
  return result;
}

void set_unknown(MuellerCovariance& covariance, const Elements& elements) {
  for (std::size_t e = 0; e < 16; ++e)
    for (std::size_t other = 0; other < 16 && elements[e]; ++other)
      covariance(e, other) = covariance(other, e) = std::numeric_limits<double>::quiet_NaN();
}

MuellerCovariance transformed(const MuellerCovariance& covariance, const Mueller& left, const Mueller& right) {
  return transformed_once(transformed_once(covariance, left, right), left, right);
}

MuellerCovariance normalized(const MuellerCovariance& covariance, const Mueller& m) {
  const double f11 = m(0, 0);
  if (!(f11 > 0)) throw std::invalid_argument("M11 = " + shortest(f11) + ", must be positive");
  MuellerCovariance result;  // d(M_e / M11) = (dM_e − (M_e / M11) dM11) / M11
  for (std::size_t e = 0; e < 16; ++e)
    for (std::size_t f = 0; f < 16; ++f) {
      const double a = e == 0 ? 0 : m.elements[e] / f11, b = f == 0 ? 0 : m.elements[f] / f11;
      const double scale = (e == 0 ? 1 : f11) * (f == 0 ? 1 : f11);
      result(e, f) =
          (covariance(e, f) - a * covariance(0, f) - b * covariance(e, 0) + a * b * covariance(0, 0)) / scale;
    }
  return result;
}

}  // namespace mmbrdf
