// SPDX-License-Identifier: BSD-3-Clause
#include "model/kernel/plan_incidence.hpp"

// How a model at one incident direction becomes the coefficients of kernel_incidence.hpp.
#include <algorithm>
#include <array>
#include <cstdlib>

#include "model/kernel/plan_parts.hpp"

namespace mmbrdf {
namespace {

std::size_t size(int n) { return static_cast<std::size_t>(n); }

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

/// Adds the functions with k ≥ 0, or with k < 0, of one element as powers of t: those of each |k| begin at first[|k|].
void add_powers(std::vector<double>& coefficients, std::span<const int> first, bool even, double weight,
                const std::vector<double>& of_element) {
  const int highest = static_cast<int>(first.size()) - 1;
  for (int n = 0; n <= highest; ++n)
    for (int k = n % 2; k <= n; k += 2) {
      const std::size_t index = size(zernike_index(n, even ? k : -k));
      if ((k == 0 && !even) || index >= of_element.size()) continue;
      const Radial radial = radial_polynomial(n, k);
      for (std::size_t a = 0; a < radial.size(); ++a)
        coefficients[size(first[size(k)]) + a] += weight * of_element[index] * radial[a];
    }
}

std::vector<double> plane_coefficients(const std::array<std::vector<double>, 16>& f) {
  using L = PlaneLayout;
  std::vector<double> result(L::count);
  const auto f11 = std::array{0, 4, 8, 11, 14, 16, 18, 19};
  add_powers(result, f11, true, 1, f[0]);
  const auto even = [&](int at, std::size_t element, double weight = 1) {
    add_powers(result, std::array{at, at + 3, at + 5, at + 7, at + 8}, true, weight, f[element]);
  };
  const auto odd = [&](int at, std::size_t element, double weight = 1) {
    add_powers(result, std::array{at, at, at + 2, at + 4, at + 5}, false, weight, f[element]);
  };
  even(L::m12, 1);
  odd(L::m13, 2);
  odd(L::m14, 3);
  even(L::m21, 4);
  odd(L::m24, 7);
  odd(L::m31, 8);
  even(L::m34, 11);
  odd(L::m41, 12);
  odd(L::m42, 13);
  even(L::m43, 14);
  even(L::m44, 15);
  even(L::u_re, 5, 0.5);  // m22 = Re(u + v), m33 = Re(u − v), m32 = Im(u + v), m23 = Im(v − u)
  even(L::u_re, 10, 0.5);
  even(L::v_re, 5, 0.5);
  even(L::v_re, 10, -0.5);
  odd(L::u_im, 9, 0.5);
  odd(L::u_im, 6, -0.5);
  odd(L::v_im, 9, 0.5);
  odd(L::v_im, 6, 0.5);
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
