// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarization/mueller.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "text/names.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using Signs = std::array<double, 4>;

/// D M D with D = diag(signs).
Mueller with_signs(const Mueller& m, const Signs& signs) {
  Mueller result;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      result(i, j) = signs[static_cast<std::size_t>(i)] * signs[static_cast<std::size_t>(j)] * m(i, j);
  return result;
}

constexpr Named<StokesConvention> convention_names[] = {
    {StokesConvention::germer2017, "germer2017"},
    {StokesConvention::s_first_right, "s_first_right"},
    {StokesConvention::p_first_left, "p_first_left"},
    {StokesConvention::p_first_right, "p_first_right"},
    {StokesConvention::p_first_left_handed_axes_left, "p_first_left_handed_axes_left"},
    {StokesConvention::p_first_left_handed_axes_right, "p_first_left_handed_axes_right"}};

/// D of a convention, relative to this project's.
Signs signs(StokesConvention convention) {
  switch (convention) {
    case StokesConvention::germer2017:
      return {1, 1, 1, 1};
    case StokesConvention::s_first_right:
      return {1, 1, 1, -1};
    case StokesConvention::p_first_left:
      return {1, -1, -1, 1};
    case StokesConvention::p_first_right:
      return {1, -1, -1, -1};
    case StokesConvention::p_first_left_handed_axes_left:
      return {1, -1, 1, 1};
    case StokesConvention::p_first_left_handed_axes_right:
      return {1, -1, 1, -1};
  }
  throw std::invalid_argument("no convention has the number " + std::to_string(static_cast<int>(convention)));
}

/// a x + b y. What is unknown has no part where its coefficient is the rounding of 0, as at turns by 90 degrees.
double sum(double a, double x, double b, double y) {
  constexpr double rounding = 1e-12;
  const double result = a * x + b * y;
  if (!std::isnan(result)) return result;
  return std::isnan(x) && std::abs(a) < rounding ? b * y : std::isnan(y) && std::abs(b) < rounding ? a * x : result;
}

Signs signs(StokesConvention from, StokesConvention to) {
  Signs product = signs(from);
  const Signs second = signs(to);
  for (std::size_t i = 0; i < 4; ++i) product[i] *= second[i];
  return product;
}

}  // namespace

std::string element_name(std::size_t element) {
  return std::to_string(element / 4 + 1) + std::to_string(element % 4 + 1);
}

Elements turned_into(const Elements& elements) {
  constexpr unsigned together[] = {1U << 1 | 1U << 2, 1U << 4 | 1U << 8, 1U << 7 | 1U << 11, 1U << 13 | 1U << 14,
                                   1U << 5 | 1U << 6 | 1U << 9 | 1U << 10};
  Elements result = elements;
  for (const Elements group : together)
    if ((group & elements).any()) result |= group;
  return result;
}

Elements turned_into(const Elements& elements, double scattered, double incident) {
  Mueller m;
  for (std::size_t e = 0; e < 16; ++e)
    if (elements[e]) m.elements[e] = std::numeric_limits<double>::quiet_NaN();
  return unknown_elements(rotated(m, scattered, incident));
}

Elements unknown_elements(const Mueller& m) {
  Elements result;
  for (std::size_t e = 0; e < 16; ++e) result[e] = std::isnan(m.elements[e]);
  return result;
}

std::string element_names(const Elements& elements) {
  std::string result;
  std::size_t left = elements.count();
  for (std::size_t e = 0; e < elements.size(); ++e) {
    if (!elements[e]) continue;
    result += (result.empty() ? "" : left == 1 ? " and " : ", ") + element_name(e);
    --left;
  }
  return result;
}

Mueller identity() { return diagonal(1, 1, 1, 1); }

Mueller diagonal(double m11, double m22, double m33, double m44) {
  return {{m11, 0, 0, 0, 0, m22, 0, 0, 0, 0, m33, 0, 0, 0, 0, m44}};
}

Mueller operator*(const Mueller& a, const Mueller& b) {
  Mueller product;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      product(i, j) = a(i, 0) * b(0, j) + a(i, 1) * b(1, j) + a(i, 2) * b(2, j) + a(i, 3) * b(3, j);
  return product;
}

Stokes operator*(const Mueller& m, const Stokes& s) {
  Stokes product;
  for (int i = 0; i < 4; ++i)
    product[static_cast<std::size_t>(i)] = m(i, 0) * s[0] + m(i, 1) * s[1] + m(i, 2) * s[2] + m(i, 3) * s[3];
  return product;
}

Mueller operator*(double factor, const Mueller& m) {
  Mueller product = m;
  for (double& element : product.elements) element *= factor;
  return product;
}

Mueller operator+(const Mueller& a, const Mueller& b) {
  Mueller sum = a;
  for (std::size_t i = 0; i < 16; ++i) sum.elements[i] += b.elements[i];
  return sum;
}

Mueller operator-(const Mueller& a, const Mueller& b) {
  Mueller difference = a;
  for (std::size_t i = 0; i < 16; ++i) difference.elements[i] -= b.elements[i];
  return difference;
}

Mueller transpose(const Mueller& m) {
  Mueller result;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) result(i, j) = m(j, i);
  return result;
}

Mueller normalized(const Mueller& m) {
  const double m11 = m(0, 0);
  if (m11 == 0 || !std::isfinite(m11))
    throw std::invalid_argument("M11 = " + shortest(m11) + ", must be finite and not 0");
  Mueller result = m;
  for (double& element : result.elements) element /= m11;
  if (std::ranges::any_of(result.elements, [](double element) { return std::isinf(element); }))
    throw std::invalid_argument("M11 = " + shortest(m11) + ", too small to divide the other elements by");
  return result;
}

Mueller rotator(double angle) { return rotator(std::cos(2 * angle), std::sin(2 * angle)); }

Mueller rotator(double cos_2a, double sin_2a) {
  return {{1, 0, 0, 0, 0, cos_2a, sin_2a, 0, 0, -sin_2a, cos_2a, 0, 0, 0, 0, 1}};
}

Mueller rotated(const Mueller& m, double scattered, double incident) {
  const double c_out = std::cos(2 * scattered), s_out = std::sin(2 * scattered);
  const double c_in = std::cos(2 * incident), s_in = std::sin(2 * incident);
  Mueller rows = m;
  for (int j = 0; j < 4; ++j) {
    rows(1, j) = sum(c_out, m(1, j), s_out, m(2, j));
    rows(2, j) = sum(c_out, m(2, j), -s_out, m(1, j));
  }
  Mueller result = rows;
  for (int i = 0; i < 4; ++i) {
    result(i, 1) = sum(c_in, rows(i, 1), s_in, rows(i, 2));
    result(i, 2) = sum(c_in, rows(i, 2), -s_in, rows(i, 1));
  }
  return result;
}

Mueller exchanged(const Mueller& m) { return with_signs(transpose(m), {1, 1, -1, 1}); }

Mueller mirrored(const Mueller& m) { return with_signs(m, {1, 1, -1, -1}); }

Mueller convert(const Mueller& m, StokesConvention from, StokesConvention to) { return with_signs(m, signs(from, to)); }

Stokes convert(const Stokes& s, StokesConvention from, StokesConvention to) {
  const Signs d = signs(from, to);
  return {d[0] * s[0], d[1] * s[1], d[2] * s[2], d[3] * s[3]};
}

std::string to_string(StokesConvention convention) { return name_of(convention_names, convention); }
StokesConvention convention_from(const std::string& name) { return value_of(convention_names, name, "convention"); }

}  // namespace mmbrdf
