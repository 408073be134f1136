// SPDX-License-Identifier: BSD-3-Clause
/// What is wrong with data, a fit or a model: symmetries that the data break, samples that do not belong, places where
/// the model is not physical.
///
/// Symmetries are tested by what breaking them explains. The samples of each wavelength are fitted by the modes of the
/// isotropic family, block by block, and again with more functions; of RSS and RSS' (Σ w r²), q more coefficients that
/// the data tell apart and ν degrees of freedom left,
///
///     F = ((RSS − RSS') / q) / (RSS' / ν)
///
/// follows the F distribution with q and ν degrees of freedom if there is no more to explain. That supposes independent
/// normal errors of variance 1/w. Speckle and the sample's structure are neither, and with thousands of rows the least
/// misfit is significant: compare the rms, not only p.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mmbrdf/fitting/fit.hpp"

namespace mmbrdf {

/// Probability that F with these degrees of freedom exceeds f. Throws std::invalid_argument unless f ≥ 0 and both are
/// positive.
double f_probability(double f, double numerator, double denominator);

/// One block, without and with more functions. Sums over wavelengths, each with its own coefficients.
struct FTest {
  std::string block;
  long rows = 0;
  long extra = 0;    ///< q. 0: the data do not tell the functions from the modes, and nothing is tested: F = 0, p = 1
  long freedom = 0;  ///< ν
  double rms = 0;    ///< √(RSS / Σ w)
  double rms_extended = 0;
  double f = 0;
  double p = 1;  ///< of an F at least as large
};

/// Samples that are each other's mirror image in the plane of incidence: the same theta_i ≥ pair_tolerance, phi_i and
/// theta_r, and opposite phi_r − phi_i, all within pair_tolerance. A sample without handedness has
/// m(−δ) = P m(δ) P, P = diag(1, 1, −1, −1), in axes turned with phi_i (theory 1.2). No model is involved.
struct MirrorPairs {
  long pairs = 0;
  Mueller rms;  ///< of m(δ) − P m(−δ) P, over √2: the noise of one sample, and what breaks the symmetry. Of f11:
                ///< relative to the mean of the two.
  Mueller mean;  ///< half the mean of that difference, with sin δ > 0 in the first: 0 but for noise / √(2 pairs)
};
inline constexpr double pair_tolerance = radians(0.01);
MirrorPairs mirror_pairs(std::span<const Sample> samples);

struct SymmetryTests {
  /// Each mode that is not its own twin split in two: Z(i,r) and Z(r,i) for 11, 44, u and v, the elements with i first
  /// and those with r first for 14, g and h.
  std::vector<FTest> reciprocity;
  /// With the modes of a handed sample, isotropic and reciprocal: those whose coefficients are imaginary (real for one
  /// index 4).
  std::vector<FTest> mirror;
  /// With cos phi_i, sin phi_i, cos 2 phi_i and sin 2 phi_i in each element, in axes turned with phi_i.
  std::vector<FTest> azimuth;
  /// The source has one azimuth (to 0.1 degrees, where theta_i is more than that): then `azimuth` is empty, and whether
  /// the sample is isotropic cannot be told.
  bool one_azimuth = true;
};

/// Weights as in FitAccumulator::add. Throws std::invalid_argument for no samples, invalid ones or orders that are out
/// of range.
SymmetryTests symmetry_tests(std::span<const Sample> samples, const Orders& orders,
                             DiscMapping mapping = DiscMapping::lambert, std::span<const Mueller> weights = {});

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

/// A model alone, at one wavelength: theta_i and theta_r in steps of 2.5 degrees up to theta_max, phi_r − phi_i in
/// steps of 7.5 degrees from 0 to 180 (theory 6.2).
struct ModelDiagnostics {
  struct Extreme {
    double value = 0;
    Geometry geometry;
  };
  double wavelength = 0, theta_max = 0;
  int geometries = 0;
  Extreme margin;            ///< smallest coherency eigenvalue of M / f11: negative is not realizable (Cloude 1986)
  int unrealizable = 0;      ///< how many are negative
  Extreme f11;               ///< smallest, sr⁻¹
  int not_positive_f11 = 0;  ///< how many are
  double dhr = 0;  ///< largest directional-hemispherical reflectance, in steps of 0.5 degrees: above 1, the model
                   ///< or the scale of its data creates energy
  double dhr_theta_i = 0;
};

/// Throws std::invalid_argument for an invalid model or wavelength, or theta_max not in [0, π/2].
ModelDiagnostics model_diagnostics(const Model& model, double wavelength, double theta_max = radians(90));

}  // namespace mmbrdf
