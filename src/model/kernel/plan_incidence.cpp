// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "model/kernel/plan_parts.hpp"

// How a model at one incident direction becomes the coefficients of kernel_incidence.hpp.

namespace mmbrdf {
namespace {

/// For each element and each K(reflected) the factor of that K without its norm.
std::array<std::vector<double>, 16> factors(const PreparedPattern& pattern, std::span<const double> of_modes,
                                            const DiscPoint& incident) {
  const int order = pattern.plan.order;
  std::array<double, zernike_count(max_order)> k_i;
  zernike_table(order, incident, k_i.data());
  std::array<std::vector<double>, 16> result;
  for (auto& of_element : result) of_element.resize(size(zernike_count(order)));
  for (std::size_t q = 0; q < of_modes.size(); ++q)
    for (std::size_t t = pattern.terms_end[q]; t < pattern.terms_end[q + 1]; ++t) {
      const Term& term = pattern.terms[t];
      result[term.element()][size(term.reflected)] +=
          of_modes[q] * term.weight * k_i[size(term.incident)] * pattern.table_norms[size(term.reflected)];
    }
  return result;
}

/// Adds the functions with k ≥ 0, or with k < 0, of one element as powers of t, which begin at `first`.
void add_powers(std::vector<double>& coefficients, int first, const HarmonicList& list, int order, bool even,
                double weight, const std::vector<double>& of_element) {
  for (int n = 0; n <= order; ++n)
    for (int k = n % 2; k <= n; k += 2) {
      const std::size_t index = size(zernike_index(n, even ? k : -k));
      if ((k == 0 && !even) || index >= of_element.size()) continue;
      const Radial radial = radial_polynomial(n, k);
      for (std::size_t a = 0; a < radial.size(); ++a)
        coefficients[size(first + list.begin[k]) + a] += weight * of_element[index] * radial[a];
    }
}

std::vector<double> plane_coefficients(const std::array<std::vector<double>, 16>& f) {
  using L = PlaneLayout;
  static constexpr struct {
    int first;
    std::size_t element;
    double weight = 1;
  } even[] = {{L::m12, 1},       {L::m21, 4},        {L::m34, 11},      {L::m43, 14},       {L::m44, 15},
              {L::u_re, 5, 0.5}, {L::u_re, 10, 0.5}, {L::v_re, 5, 0.5}, {L::v_re, 10, -0.5}},
    odd[] = {{L::m13, 2},  {L::m31, 8},       {L::m14, 3},        {L::m41, 12},      {L::m24, 7},
             {L::m42, 13}, {L::u_im, 9, 0.5}, {L::u_im, 6, -0.5}, {L::v_im, 9, 0.5}, {L::v_im, 6, 0.5}};
  // m22 = Re(u + v), m33 = Re(u − v), m32 = Im(u + v), m23 = Im(v − u)
  std::vector<double> result(L::count);
  add_powers(result, L::f11, f11_cosines, 7, true, 1, f[0]);
  for (const auto& [first, element, weight] : even)
    add_powers(result, first, even_cosines, 4, true, weight, f[element]);
  for (const auto& [first, element, weight] : odd) add_powers(result, first, odd_sines, 4, false, weight, f[element]);
  return result;
}

}  // namespace

Form incidence_form(const Plan& plan) {
  const bool covariant = plan.form == Form::isotropic || (plan.form == Form::germer2017 && plan.turned);
  return covariant ? Form::plane : Form::functions;
}

std::vector<double> incidence_coefficients(const PreparedPattern& pattern, std::span<const double> of_modes,
                                           const Direction& incident) {
  const bool plane = incidence_form(pattern.plan) == Form::plane;
  const double phi = plane || pattern.plan.turned ? 0 : incident.phi;
  const auto f = factors(pattern, of_modes, disc_point(Direction{incident.theta, phi}, pattern.mapping));
  if (plane) return plane_coefficients(f);
  std::vector<double> result(16 * f[0].size());
  for (std::size_t e = 0; e < 16; ++e)
    for (std::size_t j = 0; j < f[e].size(); ++j) result[16 * j + e] = f[e][j];
  return result;
}

}  // namespace mmbrdf
