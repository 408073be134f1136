// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarization/analysis.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "polarization/bounded.hpp"
#include "polarization/kernel/analysis_kernels.hpp"
#include "text/numbers.hpp"

//   σ_i     Pauli matrices, σ_0 = 1, in the order of Stokes components
//   T       coherency matrix ¼ Σ M_ij σ_i ⊗ conj σ_j; λ_q, v_q its eigenvalues and eigenvectors
//   p_q     λ_q / tr T
//   x 2^e   numbers are computed from M · 2^−e with its largest element in [½, 1), so that no square overflows

namespace mmbrdf {
namespace {

using Complex = std::complex<double>;
using Matrix4c = Eigen::Matrix4cd;

struct Scaled {
  Mueller m;
  int exponent = 0;
};

/// Throws std::invalid_argument if an element is not finite.
Scaled scaled(const Mueller& m) {
  double largest = 0;
  for (std::size_t i = 0; i < 16; ++i) {
    const double element = m.elements[i];
    if (!std::isfinite(element))
      throw std::invalid_argument("M" + element_name(i) + " = " + shortest(element) + ", must be finite");
    largest = std::max(largest, std::abs(element));
  }
  Scaled result{m, 0};
  std::frexp(largest, &result.exponent);
  for (double& element : result.m.elements) element = std::ldexp(element, -result.exponent);
  return result;
}

/// The matrix of the same, with M11 > 0. Not below the smallest normal number: a quotient of any element by it is
/// finite.
Mueller scaled_with_intensity(const Mueller& m) {
  Mueller result = scaled(m).m;
  if (!(m(0, 0) > 0)) throw std::invalid_argument("M11 = " + shortest(m(0, 0)) + ", must be positive");
  result(0, 0) = std::max(result(0, 0), std::numeric_limits<double>::min());
  return result;
}

/// a / b for b > 0.
double ratio(double a, double b) { return bounded(a / b); }

double length(const std::array<double, 3>& v) { return bounded(std::hypot(v[0], v[1], v[2])); }

/// σ_i(a, b).
Complex pauli(int i, int a, int b) {
  constexpr Complex one = 1, imaginary{0, 1};
  if (i < 2) return a != b ? 0.0 : (i == 1 && a == 1 ? -one : one);
  if (a == b) return 0;
  return i == 2 ? one : (a == 0 ? -imaginary : imaginary);
}

/// Row and column of T are (a, c) and (b, d), each pair counted 00, 01, 10, 11.
Matrix4c coherency_matrix(const Mueller& m) {
  Matrix4c t = Matrix4c::Zero();
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
          t(row, column) += m(i, j) / 4 * pauli(i, row / 2, column / 2) * std::conj(pauli(j, row % 2, column % 2));
  return t;
}

Mueller mueller_matrix(const Matrix4c& t) {
  Mueller m;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
          m(i, j) += (t(row, column) * pauli(i, column / 2, row / 2) * std::conj(pauli(j, column % 2, row % 2))).real();
  return m;
}

/// What the kernel answers of M or, where it does not scale, of M · 2^−e; nothing where M11 is nothing beside the rest.
/// Throws std::invalid_argument for what is not finite and unless M11 > 0.
template <Analysis analysis>
std::optional<double> relative(const Mueller& m) {
  auto number = answer_of<analysis>(m);
  if (!number) number = answer_of<analysis>(scaled_with_intensity(m));
  return number ? std::optional((*number)[0]) : std::nullopt;
}

void require_light(const Stokes& light) {
  const bool finite = std::all_of(light.begin(), light.end(), [](double s) { return std::isfinite(s); });
  const double polarized =
      finite && light[0] > 0 ? length({light[1] / light[0], light[2] / light[0], light[3] / light[0]}) : largest_double;
  if (polarized <= 1 + stokes_tolerance) return;
  throw std::invalid_argument("light (" + shortest(light[0]) + ", " + shortest(light[1]) + ", " + shortest(light[2]) +
                              ", " + shortest(light[3]) +
                              ") cannot exist: S1 must be positive and at least the length of the rest");
}

}  // namespace

double depolarization(const Mueller& m) {
  if (const auto d = relative<Analysis::depolarization>(m)) return *d;
  const Mueller x = scaled_with_intensity(m);
  double sum = 0;
  for (std::size_t i = 1; i < 16; ++i) sum += x.elements[i] * x.elements[i];
  return std::sqrt(sum / 3) / x(0, 0);
}

std::array<double, 3> diattenuation_vector(const Mueller& m) {
  scaled_with_intensity(m);
  return {ratio(m(0, 1), m(0, 0)), ratio(m(0, 2), m(0, 0)), ratio(m(0, 3), m(0, 0))};
}

double diattenuation(const Mueller& m) {
  const auto d = relative<Analysis::diattenuation>(m);
  return d ? *d : length(diattenuation_vector(m));
}

std::array<double, 3> polarizance_vector(const Mueller& m) {
  scaled_with_intensity(m);
  return {ratio(m(1, 0), m(0, 0)), ratio(m(2, 0), m(0, 0)), ratio(m(3, 0), m(0, 0))};
}

double polarizance(const Mueller& m) {
  const auto p = relative<Analysis::polarizance>(m);
  return p ? *p : length(polarizance_vector(m));
}

double degree_of_polarization(const Stokes& light) {
  require_light(light);
  return std::min(length({light[1] / light[0], light[2] / light[0], light[3] / light[0]}), 1.0);
}

double degree_of_polarization(const Mueller& m, const Stokes& incident) {
  require_light(incident);
  const Mueller x = scaled(m).m;
  const Stokes s{1, incident[1] / incident[0], incident[2] / incident[0], incident[3] / incident[0]};
  const Stokes out = x * s;  // elements of x are at most 1
  const double polarized = length({out[1], out[2], out[3]});
  constexpr double no_light = 1e-14;
  if (std::abs(out[0]) <= no_light && polarized <= no_light) return 0;
  if (!(out[0] > 0))
    throw std::invalid_argument("the matrix makes an intensity of " + shortest(out[0]) +
                                " times its largest element; it is not realizable");
  return ratio(polarized, out[0]);
}

PolarizedBrdf co_and_cross_polarized(const Mueller& m_sp) {
  const auto half = [&](double a, double b) {
    return (m_sp(0, 0) + a * m_sp(0, 1) + b * m_sp(1, 0) + a * b * m_sp(1, 1)) / 2;
  };
  const PolarizedBrdf usual{half(1, 1), half(1, -1), half(-1, 1), half(-1, -1)};
  if (std::isfinite(usual.ss) && std::isfinite(usual.sp) && std::isfinite(usual.ps) && std::isfinite(usual.pp))
    return usual;
  Mueller needed;
  for (const Element& element : {Element{0, 0}, {0, 1}, {1, 0}, {1, 1}})
    needed.elements[element.index()] = m_sp.elements[element.index()];
  if (unknown_elements(needed).any()) {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    return {unknown, unknown, unknown, unknown};
  }
  const auto [x, exponent] = scaled(needed);
  const auto f = [&x = x, e = exponent](double a, double b) {
    return bounded(std::ldexp((x(0, 0) + a * x(0, 1) + b * x(1, 0) + a * b * x(1, 1)) / 2, e));
  };
  return {f(1, 1), f(1, -1), f(-1, 1), f(-1, -1)};
}

Coherency coherency(const Mueller& m) {
  const auto [x, exponent] = scaled(m);
  const Matrix4c t = coherency_matrix(x);
  Coherency result;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      result[static_cast<std::size_t>(4 * row + column)] = {bounded(std::ldexp(t(row, column).real(), exponent)),
                                                            bounded(std::ldexp(t(row, column).imag(), exponent))};
  return result;
}

Mueller from_coherency(const Coherency& t) {
  Matrix4c matrix;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) {
      const Complex element = t[static_cast<std::size_t>(4 * row + column)];
      if (!std::isfinite(element.real()) || !std::isfinite(element.imag()))
        throw std::invalid_argument("element " + std::to_string(row + 1) + std::to_string(column + 1) +
                                    " of the coherency matrix is not finite");
      matrix(row, column) = element / 4.0;
    }
  Mueller m = mueller_matrix(matrix);
  for (double& element : m.elements) element = bounded(4 * bounded(element));
  return m;
}

std::array<double, 4> coherency_eigenvalues(const Mueller& m) {
  if (const auto values = answer_of<Analysis::coherency_eigenvalues>(m)) return *values;
  const auto [x, exponent] = scaled(m);
  if (x == Mueller{}) return {};
  std::array<double, 4> result = answer_of<Analysis::coherency_eigenvalues>(x).value();
  for (double& value : result) value = bounded(std::ldexp(value, exponent));
  return result;
}

double realizability_margin(const Mueller& m) {
  if (const auto margin = relative<Analysis::realizability_margin>(m)) return *margin;
  const Mueller x = scaled_with_intensity(m);
  return ratio(coherency_eigenvalues(x)[0], x(0, 0));
}

bool realizable(const Mueller& m) {
  if (const auto is = answer_of<Analysis::realizable>(m)) return (*is)[0] != 0;
  const Mueller x = scaled(m).m;
  return x == Mueller{} || answer_of<Analysis::realizable>(x).value()[0] != 0;
}

double purity(const Mueller& m) {
  if (const auto purity = relative<Analysis::purity>(m)) return *purity;
  const double d = depolarization(m);
  return bounded((1 + 3 * d * d) / 4);
}

double entropy(const Mueller& m) {
  if (const auto entropy = relative<Analysis::entropy>(m)) return *entropy;
  Mueller x = scaled_with_intensity(m);
  x(0, 0) = std::max(x(0, 0), 0x1p-999);  // which the kernel takes; the probabilities hardly depend on it
  return answer_of<Analysis::entropy>(x).value()[0];
}

Ratios ratios(const Mueller& m) {
  if (const auto all = answer_of<Analysis::ratios>(m)) return std::bit_cast<Ratios>(*all);
  return {depolarization(m), diattenuation(m), polarizance(m), purity(m), realizability_margin(m), entropy(m)};
}

CloudeDecomposition cloude_decomposition(const Mueller& m) {
  const auto parts = [](const std::array<double, 68>& numbers) {
    CloudeDecomposition result;
    std::copy_n(numbers.begin(), 4, result.weights.begin());
    for (std::size_t q = 0; q < 4; ++q)
      std::copy_n(numbers.begin() + 4 + 16 * q, 16, result.components[q].elements.begin());
    return result;
  };
  if (const auto numbers = answer_of<Analysis::cloude_decomposition>(m)) return parts(*numbers);
  const auto [x, exponent] = scaled(m);
  const bool is_zero = x == Mueller{};  // any components: those of a perfect depolarizer
  CloudeDecomposition result =
      parts(answer_of<Analysis::cloude_decomposition>(is_zero ? diagonal(1, 0, 0, 0) : x).value());
  for (double& weight : result.weights) weight = is_zero ? 0 : bounded(std::ldexp(weight, exponent));
  return result;
}

Projection nearest_realizable(const Mueller& m) {
  const auto projection = [&](const std::array<double, 17>& numbers, int exponent) {
    Projection result{m, bounded(std::ldexp(numbers[16], exponent))};
    for (std::size_t e = 1; e < 16; ++e) result.matrix.elements[e] = bounded(std::ldexp(numbers[e], exponent));
    return result;
  };
  if (const auto numbers = answer_of<Analysis::nearest_realizable>(m)) return projection(*numbers, 0);
  const auto [x, exponent] = scaled(m);
  if (m(0, 0) < 0) throw std::invalid_argument("M11 = " + shortest(m(0, 0)) + ", must not be negative");
  if (realizable(m)) return {m, 0};
  return projection(answer_of<Analysis::nearest_realizable>(x).value(), exponent);
}

}  // namespace mmbrdf
