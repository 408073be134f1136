// SPDX-License-Identifier: BSD-3-Clause
/// Coefficients that are polynomials of the wavelength: a(λ) = Σ_p λ^p a_p, kept power after power.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace mmbrdf {

/// 1, λ, λ² … λ^highest
inline std::vector<double> powers_of(double wavelength, int highest) {
  std::vector<double> result{1};
  for (int p = 0; p < highest; ++p) result.push_back(result.back() * wavelength);
  return result;
}

/// (1, λ, λ², …)ᵀ ⊗ 1: its transpose maps all coefficients to a(λ).
inline Eigen::MatrixXd repetition(Eigen::Index modes, const std::vector<double>& powers) {
  Eigen::MatrixXd result(modes * static_cast<Eigen::Index>(powers.size()), modes);
  for (Eigen::Index first = 0; const double power : powers) {
    result.middleRows(first, modes) = power * Eigen::MatrixXd::Identity(modes, modes);
    first += modes;
  }
  return result;
}

/// a(λ) of `modes` coefficients for each power, as many powers as there are.
inline std::vector<double> at_wavelength(std::span<const double> coefficients, std::size_t modes, double wavelength) {
  std::vector<double> result(modes);
  double power = 1;
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    if (i > 0 && i % modes == 0) power *= wavelength;
    result[i % modes] += power * coefficients[i];
  }
  return result;
}

}  // namespace mmbrdf
