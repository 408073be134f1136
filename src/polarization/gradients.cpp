// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarization/gradients.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "mmbrdf/polarization/analysis.hpp"
#include "polarization/bounded.hpp"
#include "text/numbers.hpp"

//   m       M / M11
//   x       a quantity that does not change with the scale of M, so that Σ M_ij ∂x/∂M_ij = 0
//   λ_q     eigenvalues of the coherency matrix T, falling; C_q Cloude's components; p_q = λ_q / M11
//           of the nearest realizable matrix

namespace mmbrdf {
namespace {

/// m for M11 > 0, no element beyond the largest double.
Mueller relative_to_m11(const Mueller& m) {
  Mueller result;
  for (std::size_t e = 0; e < 16; ++e) result.elements[e] = bounded(m.elements[e] / m(0, 0));
  return result;
}

/// From ∂x/∂m_ij (element 11 is not used) to ∂x/∂M_ij. `change` is Σ m_ij ∂x/∂m_ij.
Mueller of_elements(Mueller slopes, double change, double m11) {
  slopes(0, 0) = -change;
  for (double& slope : slopes.elements) slope = bounded(slope / m11);
  return slopes;
}

/// The gradient of √(Σ m_ij²) over the elements in `part` of m, divided by `norm`, which has the value `length`.
Mueller length_gradient(const Mueller& part, double length, double norm, double m11) {
  Mueller slopes;
  if (length > 0)
    for (std::size_t e = 0; e < 16; ++e) slopes.elements[e] = part.elements[e] / length / norm;
  return of_elements(slopes, length, m11);
}

/// C / 4 of the smallest eigenvalue, or the mean of those of all that are equal to it.
Mueller smallest_eigenvalue_slopes(const Mueller& m, const CloudeDecomposition& parts) {
  Mueller sum;
  int count = 0;
  for (std::size_t q = 0; q < 4; ++q)
    if (parts.weights[q] - parts.weights[3] <= realizability_tolerance * m(0, 0)) {
      sum = sum + parts.components[q];
      ++count;
    }
  return (0.25 / count) * sum;
}

void require_deviation(double sigma, std::size_t element) {
  if (!(sigma >= 0 && std::isfinite(sigma)))
    throw std::invalid_argument("standard deviation " + shortest(sigma) + " of element " + element_name(element) +
                                ", must be finite and not negative");
}

/// gᵀ V h. The exponents of long double have room for products of three doubles.
long double bilinear(const Mueller& g, const Mueller& h, const MuellerCovariance& v) {
  long double sum = 0;
  for (std::size_t e = 0; e < 16; ++e)
    for (std::size_t f = 0; f < 16 && g.elements[e] != 0; ++f)
      if (h.elements[f] != 0)  // what has no part may be unknown
        sum += static_cast<long double>(g.elements[e]) * v(e, f) * h.elements[f];
  return sum;
}

double within_double(long double x) {
  constexpr long double most = largest_double;
  return static_cast<double>(std::clamp(x, -most, most));
}

}  // namespace

Mueller depolarization_gradient(const Mueller& m) {
  const double d = depolarization(m);
  Mueller part = relative_to_m11(m);
  part(0, 0) = 0;
  return length_gradient(part, d, 3, m(0, 0));
}

Mueller diattenuation_gradient(const Mueller& m) {
  const auto [d2, d3, d4] = diattenuation_vector(m);
  Mueller part;
  part(0, 1) = d2, part(0, 2) = d3, part(0, 3) = d4;
  return length_gradient(part, diattenuation(m), 1, m(0, 0));
}

Mueller polarizance_gradient(const Mueller& m) { return transpose(diattenuation_gradient(transpose(m))); }

PolarizedBrdfGradients co_and_cross_polarized_gradients() {
  const auto gradient = [](double a, double b) {
    Mueller g;
    g(0, 0) = 0.5, g(0, 1) = a / 2, g(1, 0) = b / 2, g(1, 1) = a * b / 2;
    return g;
  };
  return {gradient(1, 1), gradient(1, -1), gradient(-1, 1), gradient(-1, -1)};
}

Mueller smallest_eigenvalue_gradient(const Mueller& m) {
  realizability_margin(m);  // refuses
  return smallest_eigenvalue_slopes(m, cloude_decomposition(m));
}

Mueller realizability_margin_gradient(const Mueller& m) {
  const double margin = realizability_margin(m);
  Mueller slopes = smallest_eigenvalue_slopes(m, cloude_decomposition(m));
  slopes(0, 0) -= margin;
  for (double& slope : slopes.elements) slope = bounded(slope / m(0, 0));
  return slopes;
}

Mueller purity_gradient(const Mueller& m) {
  const double d = depolarization(m);
  return of_elements(0.5 * relative_to_m11(m), bounded(1.5 * d * d), m(0, 0));
}

Mueller entropy_gradient(const Mueller& m) {
  entropy(m);  // refuses
  const CloudeDecomposition parts = cloude_decomposition(m);
  const CloudeDecomposition nearest = cloude_decomposition(nearest_realizable(m).matrix);
  std::array<double, 4> logarithms{};
  double mean = 0;
  std::size_t positive = 0;  // the eigenvalues above 0 come first
  for (; positive < 4 && nearest.weights[positive] > realizability_tolerance * m(0, 0); ++positive) {
    logarithms[positive] = std::log2(nearest.weights[positive] / m(0, 0)) / 2;
    mean += logarithms[positive];
  }
  mean /= static_cast<double>(std::max<std::size_t>(positive, 1));
  Mueller result;
  for (std::size_t q = 0; q < positive; ++q) {
    Mueller slopes = 0.25 * parts.components[q];
    slopes(0, 0) -= bounded(parts.weights[q] / m(0, 0));
    for (std::size_t e = 0; e < 16; ++e)
      result.elements[e] =
          bounded(result.elements[e] - bounded((logarithms[q] - mean) * bounded(slopes.elements[e] / m(0, 0))));
  }
  return result;
}

Mueller degree_of_polarization_gradient(const Mueller& m, const Stokes& incident) {
  const double degree = degree_of_polarization(m, incident);  // refuses
  if (degree == 0) return {};
  double scale = 0;
  for (const double element : m.elements) scale = std::max(scale, std::abs(element));
  Mueller x = m;  // with elements up to 1
  for (double& element : x.elements) element /= scale;
  const Stokes light{1, incident[1] / incident[0], incident[2] / incident[0], incident[3] / incident[0]};
  const Stokes out = x * light;
  const double polarized = std::hypot(out[1], out[2], out[3]);
  Mueller result;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) {
      const auto i = static_cast<std::size_t>(row), j = static_cast<std::size_t>(column);
      const double slope = row == 0 ? -degree : out[i] / polarized;
      result(row, column) = bounded(bounded(slope * light[j] / out[0]) / scale);
    }
  return result;
}

double covariance(const Mueller& gradient, const Mueller& other, const MuellerCovariance& of_elements) {
  return within_double(bilinear(gradient, other, of_elements));
}

double standard_uncertainty(const Mueller& gradient, const MuellerCovariance& of_elements) {
  return within_double(std::sqrt(std::max(bilinear(gradient, gradient, of_elements), 0.0L)));
}

double squared_depolarization_bias(const Mueller& sigma) {
  double sum = 0;
  for (std::size_t e = 1; e < 16; ++e) {
    require_deviation(sigma.elements[e], e);
    sum += sigma.elements[e] * sigma.elements[e];
  }
  return bounded(sum / 3);
}

double corrected_depolarization(const Mueller& m, const Mueller& sigma) {
  const double d = depolarization(m), bias = squared_depolarization_bias(sigma);
  return std::sqrt(std::max(bounded(d * d) - bias, 0.0));
}

}  // namespace mmbrdf
