// SPDX-License-Identifier: BSD-3-Clause
/// Which orders, and which powers of the wavelength, the data support (theory 3.4).
///
/// f11 and the other elements are fitted apart, so their orders are chosen apart; the highest power of the wavelength
/// is one for both. Each candidate is fitted to all samples, and again without each fold of each partition. Of n rows
/// with weights w, residuals r and p determined coefficients,
///
///     RSS = Σ w r²,   AIC = n ln(RSS/n) + 2 p,   BIC = n ln(RSS/n) + p ln n,
///
/// where f11 has one row for each sample, of f11 / reflectance, and the others have 15, of m_ij: one RSS for all of
/// them. Both count rows as independent; where the model misses structure, they are not, and both ask for too high
/// orders.
///
/// The rule. Random folds are like the samples they are predicted from: they tell noise from signal, and nothing about
/// directions and wavelengths between those measured. Folds that are one incident angle or one wavelength do. So orders
/// are decided by the partition by angle, if there is one, else by the first; powers by the one by wavelength, if there
/// is one, else as orders. A candidate's error is the rms over all samples, each predicted without its fold.
///
///   1. Refused is what the data, or the data without some fold, do not determine.
///   2. Refused is an order above the one of smallest error, at the same powers, whose error is more than
///      1 + refusal_excess times as large: it fits well where there are data, and nowhere else. (The outermost angle is
///      predicted by extrapolation, so an error a few tens of percent above the smallest may be chance.)
///   3. Powers: for each part the lowest whose error (that of its best order) is within 1 + negligible_excess times the
///      smallest; then the higher of the two.
///   4. Orders: for each part, at these powers, the lowest whose error is within 1 + negligible_excess times the
///      smallest. What lies closer is not told apart by data, and fewer coefficients mean less uncertainty.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/samples/partition.hpp"

namespace mmbrdf {

inline constexpr double negligible_excess = 0.01;
inline constexpr double refusal_excess = 0.5;

/// From first to last, both included.
struct Range {
  int first = 0, last = 0;
};

struct SelectionOptions {
  Family family = Family::isotropic;
  DiscMapping mapping = DiscMapping::lambert;
  std::optional<Range> orders_f11 = {},
                       orders_other = {};  ///< default 2 to 9 and 2 to 6; of anisotropic, which grows fast, 1 to
                                           ///< 4 and 1 to 3
  std::optional<Range> powers = {};        ///< default 0 for one wavelength, 0 to 1 for several
  std::optional<ReflectanceTable> reflectance = {};  ///< as in FitOptions. The default is taken from the samples that
                                                     ///< are fitted, never from those left out.
  double rank_tolerance = FitOptions{}.rank_tolerance;
};

/// How well a candidate predicts what it was not fitted to.
struct HeldOut {
  double rms = 0;    ///< √(Σ w r² / Σ w) over all samples, each predicted without its fold
  double worst = 0;  ///< largest rms of one fold
  std::size_t worst_fold = 0;
  std::string undetermined;  ///< why a fold could not be predicted, and which; the first such. Empty: all could, and
                             ///< only then the rms mean anything.
};

struct Candidate {
  int order = 0, powers = 0;
  int coefficients = 0;
  int rank = 0;          ///< of all blocks together: p above
  double condition = 0;  ///< largest of a block
  double rms = 0, aic = 0, bic = 0;
  std::vector<HeldOut> held_out;  ///< one for each partition
  std::string refusal;            ///< why it should not be used; empty: it may
};

/// For f11, or for the 15 other elements.
struct PartSelection {
  std::vector<Candidate> candidates;       ///< by powers, then by order
  std::optional<std::size_t> recommended;  ///< position; none if all are refused
  std::string reason;                      ///< of the recommendation, or of there being none: one line
};

struct Selection {
  /// other: order 0 where the data leave all of its elements unknown at each order, and without candidates of f11 alone
  PartSelection f11, other;
  std::optional<Orders> orders;  ///< recommended; none if one part has no recommendation
  int powers = 0;
};

/// Throws std::invalid_argument for no partition or one of another number of samples, ranges that are empty or leave
/// what orders and powers may be, more powers than the wavelengths can tell, and for samples and weights as fit() does.
/// Samples are gone through once for each partition and once more; each fold then is a FitAccumulator.
Selection select_model(std::span<const Sample> samples, std::span<const Partition> partitions,
                       const SelectionOptions& options = {}, Weights weights = Weights::none);

}  // namespace mmbrdf
