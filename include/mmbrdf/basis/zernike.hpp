// SPDX-License-Identifier: BSD-3-Clause
/// Zernike polynomials on the hemisphere: Germer 2017, Eqs. 3–7 (Eq. 5 with (−1)^s and |m|).
///
///   ρ      radius on the unit disc onto which the hemisphere is mapped
///   n, k   radial and azimuthal order: |k| ≤ n, n − k even
///   R_n^k  radial polynomial, R_n^k(1) = 1, R_n^{−k} = R_n^k
///   K_n^k  √((n+1)/π) R_n^|k|(ρ) az_k(φ),  az = cos kφ (k > 0), 1/√2 (k = 0), sin|k|φ (k < 0)
#pragma once

#include "mmbrdf/geometry/geometry.hpp"

namespace mmbrdf {

/// How a direction becomes a point of the unit disc. The functions K are orthonormal over the hemisphere
///   in solid angle, ∫ K_n^k K_m^l dΩ = δ, for lambert;   ∫ K_n^k K_m^l cos θ dΩ = δ/2 for projected.
enum class DiscMapping {
  lambert,    ///< ρ = √2 sin(θ/2), Eq. 6: equal areas for equal solid angles. The paper's choice.
  projected,  ///< ρ = sin θ, Eq. 7: equal areas for equal projected solid angles.
};

/// Point of the unit disc, ρ (cos φ, sin φ).
struct DiscPoint {
  double x = 0;
  double y = 0;
};

DiscPoint disc_point(const Direction& direction, DiscMapping mapping);

/// Point of the unit disc from a unit vector, without trigonometry. Not checked: the vector must have length 1 and z ≥
/// 0.
DiscPoint disc_point(const Vector3& unit_vector, DiscMapping mapping);

/// Largest radial order that any function of this library takes.
inline constexpr int max_order = 40;

/// R_n^k(ρ) by recurrence, 0 ≤ ρ ≤ 1. Zero if |k| > n or n − k is odd, as in the paper.
/// Throws std::invalid_argument if n is not in 0…max_order or ρ not in [0, 1].
/// |error| ≤ radial_error, as against 128-bit arithmetic (largest seen: 1.7e-15); the factorial sum of Eq. 5 is off by
/// 5e-10 at n = 20.
double radial(int n, int k, double rho);
inline constexpr double radial_error = 4e-15;

/// K_n^k at a direction (Eq. 3). Throws std::invalid_argument if n is not in 0…max_order or theta not in [0, π/2].
double zernike(int n, int k, const Direction& direction, DiscMapping mapping = DiscMapping::lambert);

/// Position of (n, k) in a table of all K up to some order: 0 (0,0); 1 (1,−1); 2 (1,1); 3 (2,−2); 4 (2,0); …
constexpr int zernike_index(int n, int k) { return (n * (n + 2) + k) / 2; }

/// Number of functions with radial order ≤ n.
constexpr int zernike_count(int order) { return (order + 1) * (order + 2) / 2; }

/// All K_n^k, n ≤ order, at one point of the disc, by the Cartesian recurrence; `values` has zernike_count(order)
/// places. Not checked: 0 ≤ order ≤ max_order. Does not throw or allocate.
/// |error| ≤ table_error √((n+1)/π); the largest seen up to order 40 is 7.4e-15.
void zernike_table(int order, const DiscPoint& point, double* values);
inline constexpr double table_error = 2e-14;

/// ∫ K_n^0 cos θ dΩ over the hemisphere; all other K integrate to 0.
double projected_integral(int n, DiscMapping mapping);

}  // namespace mmbrdf
