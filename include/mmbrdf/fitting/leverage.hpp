// SPDX-License-Identifier: BSD-3-Clause
/// How much each sample of a fit determines, and which do not belong; and what samples do to coefficients, for many sets
/// of them at the same geometries.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/fitting/fit.hpp"

namespace mmbrdf {

/// How much each sample determines, and how far it lies off.
struct SampleDiagnostics {
  struct Leverage {
    std::string block;
    int rank = 0;                ///< the leverages of all samples add up to it
    std::vector<double> values;  ///< of each sample: Σ w xᵀ (Xᵀ W X)⁺ x over the elements of the block
    std::size_t largest = 0;     ///< its sample
  };
  std::vector<Leverage> leverage;
  /// r √w / (s √(1 − h)) of each sample and element, s that of its block and h its leverage: near normal with variance
  /// 1 if the weights are right. 0 where the row alone decides its residual (h = 1), or s is 0.
  std::vector<Mueller> studentized;
};

/// Of the samples and weights that the result was fitted to, turned if the fit turned them. Throws
/// std::invalid_argument for samples that do not fit to it in number.
SampleDiagnostics sample_diagnostics(std::span<const Sample> samples, const FitResult& result,
                                     std::span<const Mueller> weights = {});

struct Outlier {
  std::size_t sample = 0, element = 0;  ///< counted from 0; element in row-major order
  double studentized = 0;
};

/// Samples and elements beyond ± threshold, the largest first. Of 100 000 normal residuals 6 exceed 4, none 5.
std::vector<Outlier> outliers(const SampleDiagnostics& diagnostics, double threshold = 5);

/// What values at given geometries do to the coefficients of a fit: one matrix, and so a product for each set of them, such
/// as the pixels of an image. Coefficients are those of the model's blocks, one block after the other; the fit is that of
/// a FitAccumulator with these weights, at one wavelength and divided by no reflectance.
class Influence {
 public:
  /// `weights` as FitAccumulator::add() takes them. With f11_only no other block is fitted. Throws as FitAccumulator does,
  /// and std::invalid_argument for a basis that turns samples.
  Influence(std::span<const Geometry> geometries, double wavelength, const Basis& basis,
            std::span<const Mueller> weights = {}, bool f11_only = false, const FitOptions& options = {});

  std::size_t geometries() const;
  std::size_t coefficients() const;
  /// The model whose coefficients are to be replaced; its covariances are (Xᵀ W X)⁺, those of rows of unit variance.
  const Model& model() const;

  /// Coefficients of each set, in the order of sets, and s² of each of its blocks: ‖W^½ (X a − y)‖² / (rows − rank), NaN
  /// where no degree of freedom is left and it is not known. The values of a set are f in sr⁻¹, 16 for each geometry in
  /// rows, or f11 alone; m = f / f11. A set with a value that is not finite where its weight is not 0 has NaN. What a set
  /// gives does not depend on the others, nor on threads (0: one for each core). Throws std::invalid_argument for sizes
  /// that do not fit.
  void fit(std::span<const float> values, std::span<double> coefficients, std::span<double> variances,
           int threads = 1) const;
  void fit(std::span<const double> values, std::span<double> coefficients, std::span<double> variances,
           int threads = 1) const;

 private:
  struct Parts;
  template <class Number>
  void fit_all(std::span<const Number> values, std::span<double> coefficients, std::span<double> variances,
               int threads) const;
  std::shared_ptr<const Parts> parts_;
};

}  // namespace mmbrdf
