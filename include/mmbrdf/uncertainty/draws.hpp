// SPDX-License-Identifier: BSD-3-Clause
/// Uncertainties by propagation of distributions: draws of a model's coefficients, and any quantity over them (GUM
/// Supplement 1: JCGM 101:2008; theory 4.4). For what is far from linear: eigenvalues, entropy, decompositions, a
/// depolarization near 0.
///
///   const Draws draws(model, 1000, seed);
///   const auto models = draws.at(0.532);
///   const auto d = values(models, [&](const PreparedModel& m) { return depolarization(m.evaluate(geometry)); });
///   distribution(d).standard_deviation, correlation(d, others), …
///
/// All quantities from one Draws are from the same draws, so their correlations are right, at all wavelengths.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/uncertainty/distribution.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"

namespace mmbrdf {

/// Throws std::invalid_argument, naming the block, if a covariance that is known has an eigenvalue below
/// −covariance_tolerance (prediction.hpp) × the largest. Variances of 0 (solutions of minimum norm) are fine.
void require_semidefinite(const Model& model);

/// What all draws say at a wavelength, worked out as a product of matrices: far faster than one model after the other. May be
/// used in many threads at once.
class DrawnMatrices {
 public:
  std::size_t count() const;

  /// Draws that are worked out together.
  static constexpr std::size_t together = 256;

  /// Of draws first, a multiple of `together`, to first + n − 1 (`together` or as many as there are): the matrix of draw
  /// first + d at geometry g goes to out[g × n + d], which is that of Draws::at() to batch_error (prediction.hpp) of the
  /// sum of the sizes that it is made of. What a geometry gives does not depend on its neighbours.
  void evaluate(std::size_t first, std::span<const Geometry> geometries, Frame frame, std::span<Mueller> out) const;

 private:
  friend class Draws;
  struct Prepared;
  explicit DrawnMatrices(std::shared_ptr<const Prepared> prepared) : prepared_(std::move(prepared)) {}
  std::shared_ptr<const Prepared> prepared_;
};

/// Draws a + V^½ z of the coefficients of each block, with z normal: distributed as N(a, V), also where V is singular.
/// The values of a reflectance table that has a covariance are drawn with the coefficients of block 11.
class Draws {
 public:
  /// The same seed gives the same draws, and a longer list begins with the shorter, to rounding. Throws
  /// std::invalid_argument for an invalid model, a block whose covariance is not known or not positive semidefinite, or
  /// unless 2 ≤ count ≤ max_draws.
  explicit Draws(const Model& model, int count = 1000, unsigned long seed = 0);
  static constexpr int max_draws = 1000000;

  int count() const { return count_; }

  /// The drawn models at a wavelength (micrometres), some 8 kB each at orders 7, 4. Throws as prepare() does.
  std::vector<PreparedModel> at(double wavelength) const;

  /// Their matrices alone. Throws as prepare_uncertainty() does.
  DrawnMatrices matrices_at(double wavelength) const;

 private:
  struct Coefficients;
  int count_;
  std::shared_ptr<const Coefficients> coefficients_;
};

/// One number for each drawn model.
template <class Quantity>
std::vector<double> values(std::span<const PreparedModel> draws, Quantity quantity) {
  std::vector<double> result;
  result.reserve(draws.size());
  for (const PreparedModel& draw : draws) result.push_back(quantity(draw));
  return result;
}

}  // namespace mmbrdf
