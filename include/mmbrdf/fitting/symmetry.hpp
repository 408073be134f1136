// SPDX-License-Identifier: BSD-3-Clause
/// Symmetries that data break: reciprocity, handedness, isotropy; and what repeated samples say of the misfit.
///
/// They are tested by what breaking them explains. The samples of each wavelength are fitted by the modes of the
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

/// Lack of fit of a block against pure error: samples of the same wavelength and geometry scatter about their mean whatever
/// the model is; what residuals hold beyond that is misfit.
struct LackOfFit {
  std::string block;
  long repeats = 0;       ///< ν, degrees of freedom of the pure error: rows − geometries. 0: nothing is tested
  double pure_error = 0;  ///< √(SS / ν) of the scatter of repeats about their means
  double misfit = 0;  ///< √((RSS − SS) / q), q = rows − rank − ν: what pure error would be if the model were right
  double f = 0;       ///< of the two mean squares
  double p = 1;       ///< of an F at least as large
};

/// Of a fit without weights to these samples. Throws std::invalid_argument if it has not one residual for each.
std::vector<LackOfFit> lack_of_fit(std::span<const Sample> samples, const FitResult& fitted);

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

}  // namespace mmbrdf
