// SPDX-License-Identifier: BSD-3-Clause
/// The subset method (Germer 2017, section 5): disjoint parts of the data are fitted apart, and the spread of what the
/// fits predict is a measure of the uncertainty of one of them. The covariance of a single fit predicts that spread
/// (theory 4.8), so the method tests the covariance; alone it knows little: with k parts a standard deviation has k − 1
/// degrees of freedom, and what all parts share (scale, angles, misfit of the model) does not show in it.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/polarization/analysis.hpp"
#include "mmbrdf/samples/partition.hpp"
#include "mmbrdf/uncertainty/budget.hpp"

namespace mmbrdf {

/// The fit to all samples, and to each part.
struct SubsetFits {
  Model whole;
  std::vector<Model> parts;
};

/// Of parts such as parts(samples, folds_by_row(samples.size(), 3)), the paper's "every other three data points".
/// Throws std::invalid_argument as fit() does, with the number of the part; and for a part that leaves more
/// combinations free than all samples do, so that its fit would not be one of the same model.
SubsetFits fit_parts(std::span<const std::vector<Sample>> parts, const Basis& basis = {},
                     const FitOptions& options = {}, Weights weights = Weights::none);

/// Directions in the plane of incidence at one theta_i: the source at azimuth 0, the detector at azimuth π (forward)
/// for theta_r ≥ 0, at azimuth 0 (back, towards the source) for theta_r < 0. Radians.
std::vector<Geometry> in_plane(double theta_i, std::span<const double> theta_r);

/// f_ss, f_sp, f_ps, f_pp in sr⁻¹, one for each geometry.
using PolarizedCurve = std::vector<PolarizedBrdf>;

/// What a model predicts at a wavelength (micrometres). Throws std::invalid_argument for an invalid model, wavelength
/// or geometry.
PolarizedCurve polarized_curve(const Model& model, double wavelength, std::span<const Geometry> geometries);

/// Standard uncertainty of polarized_curve() in first order, of the fit and of the terms. f_ab is linear in F11, F12, F21, F22 of the sp frame, so
///   u²(f_ab) = ¼ Σ_ee' c_e c_e' cov(F_e, F_e'),  c = (1, a, b, ab)   (theory 4.8).
/// Throws std::invalid_argument as prepare_uncertainty() and effects() do: without covariance, it is not known.
PolarizedCurve polarized_uncertainty(const Model& model, double wavelength, std::span<const Geometry> geometries,
                                     std::span<const TypeBTerm> terms = {});

/// How k curves lie to each other and to a reference. All is relative to the reference.
struct SubsetStatistics {
  PolarizedCurve mean;            ///< of the curves, sr⁻¹
  PolarizedCurve deviation;       ///< standard deviation of the k curves, k − 1 degrees of freedom, sr⁻¹
  double mean_deviation = 0;      ///< deviation / reference, mean over geometries and the four curves
  double root_mean_variance = 0;  ///< its root mean square; unlike the mean not too small for few curves
  double mean_distance = 0;       ///< mean of |mean / reference − 1|
  double largest_distance = 0;    ///< largest of them
  std::size_t largest_at = 0;     ///< its geometry
  std::size_t left_out = 0;       ///< geometries where the reference is not positive: in mean and deviation alone
};

/// Throws std::invalid_argument for fewer than 2 curves, curves of other lengths than the reference, empty ones, or a
/// reference that is positive nowhere.
SubsetStatistics subset_statistics(std::span<const PolarizedCurve> curves, const PolarizedCurve& reference);

/// Root mean square of uncertainty / reference: what root_mean_variance estimates. That of a fit to one of k equal
/// parts is √k times that of the fit to all, and more by √(n / (n − p)) or so where a part has only n samples for p
/// coefficients of f11. Throws std::invalid_argument as subset_statistics does.
double relative_rms(const PolarizedCurve& uncertainty, const PolarizedCurve& reference);

/// How samples are divided: dealt in turn, or by lot as often as there are splits, with seeds that count from `seed`.
struct Division {
  int parts = 3, splits = 1;
  bool random = false;
  unsigned long seed = 0;
  bool by_lot() const { return random || splits > 1; }
};
/// What is asked of each division of samples of one wavelength (micrometres).
struct SubsetQuestion {
  double wavelength = 0;
  std::vector<Geometry> geometries;
  const Model* reference = nullptr;  ///< what all is relative to; null: the fit to all samples
  Basis basis;
  FitOptions fit;
  Weights weights = Weights::none;
};
struct SubsetSplit {
  std::optional<unsigned long> seed;      ///< of the lot
  std::vector<PolarizedCurve> curves;     ///< of the fit to each part
  PolarizedCurve reference, uncertainty;  ///< of the fit to one part, as the covariance of the fit to all says
  SubsetStatistics statistics;
  double predicted = 0;  ///< relative_rms of the uncertainty
  Validity validity;     ///< of the fit to all
};
/// Throws std::invalid_argument for fewer splits than 1 or more than max_splits, and as folds_by_row(), fit_parts(),
/// polarized_curve() and subset_statistics() do.
std::vector<SubsetSplit> split_samples(std::span<const Sample> samples, const Division& division,
                                       const SubsetQuestion& question);
inline constexpr int max_splits = 10000;

/// Root mean square over splits of their root_mean_variance: what `predicted` of any of them says.
double root_mean_variance(std::span<const SubsetSplit> splits);

}  // namespace mmbrdf
