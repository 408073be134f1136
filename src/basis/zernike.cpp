// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/basis/zernike.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <stdexcept>
#include <string>

#include "text/names.hpp"
#include "text/numbers.hpp"

// With w = x + iy = ρ e^{iφ}, the functions Z_n^k = R_n^k(ρ) e^{ikφ} obey
//
//     Z_n^k = w Z_{n−1}^{k−1} + w̄ Z_{n−1}^{k+1} − Z_{n−2}^k,     Z_n^{−k} = conj Z_n^k,
//
// which is the radial recurrence R_n^k = ρ (R_{n−1}^{|k−1|} + R_{n−1}^{k+1}) − R_{n−2}^k times e^{ikφ}. Terms with
// |k| > n are zero. No factorial, no trigonometry, no pole.

namespace mmbrdf {
namespace {

constexpr Named<DiscMapping> mapping_names[] = {{DiscMapping::lambert, "lambert"},
                                                {DiscMapping::projected, "projected"}};

constexpr std::size_t table_size = zernike_count(max_order);

constexpr double square_root(double value) {  // Newton; std::sqrt is not constexpr
  double root = 0.5 * (1 + value);            // from above, so the steps go down until rounding stops them
  for (double next = root; (next = 0.5 * (root + value / root)) < root;) root = next;
  return root;
}

/// √((n+1)/π), times 1/√2 for k = 0. Constants, so that K can be used before main() starts.
struct Norms {
  std::array<double, max_order + 1> zero{}, other{};
  constexpr Norms() {
    for (std::size_t n = 0; n <= max_order; ++n) {
      zero[n] = square_root(static_cast<double>(n + 1) / (2 * std::numbers::pi));
      other[n] = square_root(static_cast<double>(n + 1) / std::numbers::pi);
    }
  }
  constexpr double operator()(int n, int k) const { return (k == 0 ? zero : other)[static_cast<std::size_t>(n)]; }
};
constexpr Norms norm;

std::size_t at(int n, int k) { return static_cast<std::size_t>(zernike_index(n, k)); }

double disc_radius(double theta, DiscMapping mapping) {
  return mapping == DiscMapping::lambert ? std::numbers::sqrt2 * std::sin(theta / 2) : std::sin(theta);
}

/// Fills values with Re Z_n^k at (n, k) and Im Z_n^k at (n, −k).
void unnormalized_table(int order, const DiscPoint& w, double* values) {
  const auto re = [&](int n, int k) -> double& { return values[at(n, k)]; };
  const auto im = [&](int n, int k) -> double& { return values[at(n, -k)]; };
  re(0, 0) = 1;
  for (int n = 1; n <= order; ++n) {
    if (n % 2 == 0)  // Z_{n−1}^{−1} is the conjugate of Z_{n−1}^1, so the two products add up to a real number
      re(n, 0) = 2 * (w.x * re(n - 1, 1) + w.y * im(n - 1, 1)) - re(n - 2, 0);
    for (int k = 2 - n % 2; k <= n; k += 2) {
      const double below_re = re(n - 1, k - 1);
      const double below_im = k > 1 ? im(n - 1, k - 1) : 0;
      double z_re = w.x * below_re - w.y * below_im;
      double z_im = w.x * below_im + w.y * below_re;
      if (k < n) {
        z_re += w.x * re(n - 1, k + 1) + w.y * im(n - 1, k + 1) - re(n - 2, k);
        z_im += w.x * im(n - 1, k + 1) - w.y * re(n - 1, k + 1) - im(n - 2, k);
      }
      re(n, k) = z_re;
      im(n, k) = z_im;
    }
  }
}

}  // namespace

DiscPoint disc_point(const Direction& direction, DiscMapping mapping) {
  const double rho = disc_radius(direction.theta, mapping);
  return {rho * std::cos(direction.phi), rho * std::sin(direction.phi)};
}

DiscPoint disc_point(const Vector3& v, DiscMapping mapping) {
  const double scale = mapping == DiscMapping::lambert ? 1 / std::sqrt(1 + v[2]) : 1;
  return {v[0] * scale, v[1] * scale};
}

double radial(int n, int k, double rho) {
  if (n < 0 || n > max_order)
    throw std::invalid_argument("n = " + std::to_string(n) + ", must be in 0..." + std::to_string(max_order));
  if (!(rho >= 0 && rho <= 1)) throw std::invalid_argument("rho = " + shortest(rho) + ", must be in [0, 1]");
  if (k < -n || k > n || (n - k) % 2 != 0) return 0;
  std::array<double, table_size> values;
  unnormalized_table(n, {rho, 0}, values.data());
  return values[at(n, std::abs(k))];
}

double zernike(int n, int k, const Direction& direction, DiscMapping mapping) {
  if (!(direction.theta >= 0 && direction.theta <= radians(90)))
    throw std::invalid_argument("theta = " + shortest(in_degrees(direction.theta)) + " degrees, must be in 0...90");
  const double rho = std::min(1.0, disc_radius(direction.theta, mapping));  // √2 sin 45° may be rounded to above 1
  const double radius = radial(n, k, rho);                                  // checks n
  return norm(n, k) * radius * (k < 0 ? std::sin(-1.0 * k * direction.phi) : std::cos(k * direction.phi));
}

void zernike_table(int order, const DiscPoint& point, double* values) {
  unnormalized_table(order, point, values);
  for (int n = 0; n <= order; ++n)
    for (int k = -n; k <= n; k += 2) values[at(n, k)] *= norm(n, k);
}

double projected_integral(int n, DiscMapping mapping) {
  const double radial_integral = n == 0                                      ? std::numbers::pi
                                 : n == 2 && mapping == DiscMapping::lambert ? -std::numbers::pi / 3
                                                                             : 0;
  return std::sqrt((n + 1) / (2 * std::numbers::pi)) * radial_integral;
}

std::string to_string(DiscMapping mapping) { return name_of(mapping_names, mapping); }
DiscMapping disc_mapping_from(const std::string& name) { return value_of(mapping_names, name, "mapping"); }

}  // namespace mmbrdf
