// SPDX-License-Identifier: BSD-3-Clause
/// What a fit says against itself, and data before there is one: whether they are what they are taken for.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/quantities/trust.hpp"
#include "mmbrdf/samples/inspection.hpp"

namespace mmbrdf {

/// Σ w r² / (rows − rank) of f11 and of the 15 others together; of a block it is Solution::variance(). Where weights are
/// 1/u² (Weights::data): near 1 if the uncertainties are right and the model has the structure of the sample. 0 without
/// degrees of freedom.
struct ReducedChiSquared {
  double f11 = 0, others = 0;
};
ReducedChiSquared chi_squared_per_dof(const FitResult& result);

/// Beyond these there is a warning. A χ² per degree of freedom that large is no chance from 30 degrees of freedom on (p =
/// 1e-3); and with a condition that large the least determined combination of coefficients is 1e5 times as uncertain as
/// the best.
inline constexpr double high_chi_squared = 2, high_condition = 1e5;

/// A sentence for each of the following that holds, without a full stop:
///
///   - the samples lie in one plane only, or all on one side of it (to side_tolerance)
///   - with Weights::data, χ² per degree of freedom of f11 or the others exceeds high_chi_squared
///   - the condition of a block exceeds high_condition; not of a mixed model, whose uncertainty says it
std::vector<std::string> data_warnings(const FitResult& result);

/// Those of the fit itself (FitResult::warnings), data_warnings(), and of the model within the fitted angles, at no more
/// than most_checked of the fitted wavelengths:
///
///   - pairs of directions that no samples support: unsupported_line()
///   - a directional-hemispherical reflectance above 1 by more than `surely` standard uncertainties: energy_line()
///   - f11 that is not positive: not_positive_line()
///
/// and, if there are samples, what these show (row_findings(), which names them by `numbers`), that their angles are
/// radians, that f11 has a cosine too many or too few, and that they fit better in another frame or with other signs:
/// convention_warning(). They may be some of those fitted. Takes a few milliseconds for each wavelength and each of the conventions.
std::vector<std::string> fit_warnings(const FitResult& result, std::span<const Sample> samples = {},
                                      std::span<const long> numbers = {});
inline constexpr std::size_t most_checked = 12;

/// A fault that would not have been seen, and why.
struct Untested {
  std::string fault;   ///< "cosine"
  std::string reason;  ///< "3 samples, and a fit of low order has 14 coefficients"
};

/// "cannot be told: cosine: 3 samples, and a fit of low order has 14 coefficients"
std::string to_string(const Untested& untested);

/// What data are, seen before they are fitted.
struct Inspection {
  std::vector<Finding> findings;   ///< what is wrong with them; empty if nothing seems to be
  std::vector<Untested> untested;  ///< what else might be, for all that these data say
  Sides sides = no_side;
  double f11_residual =
      0;  ///< rms of f11 − fit of low order, relative to that of f11: noise and fine structure; 0: none
  std::vector<double> residuals;  ///< f11 − that fit of each sample, sr⁻¹; NaN where there is none
  double unsupported = 0;         ///< unsupported_share() of that fit
  std::string hole;               ///< unsupported_line() of it
  Hole hole_at;                   ///< unsupported_part() of it
  MissingShares missing;          ///< missing_shares() of it
};

/// row_findings(), and of fits of low orders (inspected_orders, isotropic, of minimum norm) to the samples of the first
/// wavelength, most_tried at most, without fill values:
///
///   angles in radians        that are taken for degrees: then none of the following is looked at
///   scale of f11             energy_line(): percent, π, a factor
///   cosine                   f11 is reciprocal after it is divided by cos θr, or multiplied by it: better_convention
///   azimuths, frame          sides_warning of folded azimuths, convention_warning()
///   no fit                   why there is none
///
/// Each with the option or column that mends it. A fault that is not found is untested if it, planted in these data, would
/// not be found either; and so are the last three with fewer samples than twice the coefficients of the fit, the cosine with
/// theta_i within 20 degrees, and the scale with fewer than 60, a fifth of the pairs of directions missing, a fifth of f11
/// left by the fit, or theta_r below 30 degrees. Then a reflectance above 2 by five standard uncertainties, or above 10,
/// is a fault all the same. `numbers` are those of row_findings(). Throws std::invalid_argument for invalid samples, or none.
Inspection inspect(std::span<const Sample> samples, std::span<const long> numbers = {});
inline constexpr Orders inspected_orders{4, 3};

/// What they are, in words: rows of a name, which may be empty, and what it is. And a line on what was looked at, if there
/// are no findings: "nothing seems to be wrong".
struct InspectionRow {
  std::string name, text;
};
std::vector<InspectionRow> inspection_rows(const Inspection& seen, std::span<const Sample> samples);
std::string verdict_line(const Inspection& seen);
std::string sides_line(Sides sides);

}  // namespace mmbrdf
