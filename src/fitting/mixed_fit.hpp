// SPDX-License-Identifier: BSD-3-Clause
/// The mixed model of samples: each wavelength and block on its own, then polynomials of the wavelength through the
/// evaluated coefficients.
#pragma once

#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "mixed/block_fit.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/mixed/posterior.hpp"

namespace mmbrdf {

/// What the readings of a wavelength are weighed by, and what errors that they share do to them. Sums over parts of a
/// series add up if all parts had the same.
struct FirstPass {
  double reflectance = 1;   ///< what f11 is divided by
  std::vector<double> f11;  ///< of order first_order, after division: what the noise of f11 is relative to
  Model model;              ///< least squares of the evaluated modes, before division
};
/// Of samples of one wavelength. Throws std::invalid_argument, with the sample's number, where f11 is not positive.
FirstPass first_pass(std::span<const Sample> samples, const Basis& basis, const ReadingLaw& law, double reflectance);

/// Sums of a block over the samples of a wavelength; the columns d are those of declared errors of 1.
Gram sums_of(const MixedColumns& columns, std::span<const Sample> samples, const FirstPass& first,
             const ReadingLaw& law);

/// The orders of the isotropic modes behind a model of these.
Orders generous(const Orders& evaluated);

/// Why there is no mixed model of these; empty if there is.
std::string no_mixed_model(std::span<const Sample> samples, const Basis& basis, Covariance covariance, Weights weights);

/// Why one could not be found after all.
struct MixedFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Samples of a wavelength, and the law of their noise.
struct Series {
  std::vector<Sample> samples;
  ReadingLaw law;
  double reflectance = 1;
};

struct MixedFit {
  Posterior posterior;
  std::vector<std::vector<double>> coefficients;  ///< of each block, power after power
};
/// Throws as first_pass() and estimate() do.
MixedFit mixed_fit(const std::map<double, Series>& series, const Basis& basis, int powers,
                   const DeclaredErrors& declared);

/// Squares of the weights of a series, relative to the f11 of first_order that fits it best.
std::vector<Mueller> series_weights(const Series& series, const Basis& basis);

}  // namespace mmbrdf
