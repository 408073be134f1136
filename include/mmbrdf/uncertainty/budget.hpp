// SPDX-License-Identifier: BSD-3-Clause
/// Uncertainty budgets: what the fit leaves uncertain, and what all its data share and it cannot know, term by term.
///
/// The errors of different terms are independent. A term of type B (GUM 2008, 4.3) is one error, the same for all
/// geometries, with the standard uncertainty that the user gives; calibration is fifteen such errors.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"

namespace mmbrdf {

/// What is in error, in the measurements that the model was fitted to.
enum class ErrorOf {
  scale,        ///< all of F by one factor: reference reflectance, solid angle of the receiver, linearity. Relative
  theta_i,      ///< polar angle of the source, radians
  theta_r,      ///< polar angle of the detector, radians. It is in the measurement equation twice: F_measured(θr) =
                ///< F(θr + d) cos(θr + d) / cos θr, so dF/dd = ∂F/∂θr − tan θr F (theory 4.6)
  azimuth,      ///< phi_r − phi_i, radians
  calibration,  ///< each of the 15 elements m_ij = F_ij / f11, independently: absolute
};

/// "scale", "theta_i", …; the opposite throws std::invalid_argument for another name.
std::string to_string(ErrorOf what);
ErrorOf error_from(const std::string& name);

struct TypeBTerm {
  std::string name;  ///< for the table: "reference plaque"
  ErrorOf what = ErrorOf::scale;
  double uncertainty = 0;  ///< standard (k = 1), in [0, largest_term]: beyond, first order means nothing
  double freedom = std::numeric_limits<double>::infinity();  ///< degrees of freedom of the uncertainty, 1 or more
};
inline constexpr double largest_term = 10;

/// As people type it, [NAME:]KIND=U[,dof=N], angles in degrees: "scale=0.3%", "theta_r=0.02deg", "plaque:scale=0.003,dof=12".
/// Throws std::invalid_argument for another text.
TypeBTerm term_from(const std::string& text);

/// How F in sr⁻¹ changes with errors of one standard uncertainty: one matrix for each error, 15 for calibration. Where
/// the polarimeter sits on the arms, an error of an angle turns its axes along: slopes are of the matrix in the sp
/// frame, by central differences (relative error 1e-7), one-sided within 1e-4 of 90 degrees (5e-5).
/// Throws std::invalid_argument for an invalid geometry, an uncertainty out of range, and for theta_r
/// where cos θr < grazing_limit: F_measured has no limit there.
std::vector<Mueller> effects(const TypeBTerm& term, const PreparedModel& model, const Geometry& geometry,
                             Frame frame = Frame::xy);
inline constexpr double grazing_limit = 1e-9;

/// Of Σ weight × F, such as the mean over an aperture: the sum of the effects, since each error is one and the same at
/// all geometries.
std::vector<Mueller> effects(const TypeBTerm& term, const PreparedModel& model,
                             std::span<const WeightedGeometry> geometries, Frame frame = Frame::xy);

struct Budget {
  std::vector<BudgetTerm> terms;  ///< first those of PreparedUncertainty::parts()
  MuellerCovariance total;        ///< their sum
};

/// Throws std::invalid_argument as effects() does.
Budget budget(const PreparedModel& model, const PreparedUncertainty& fit, std::span<const TypeBTerm> terms,
              const Geometry& geometry, Frame frame = Frame::xy);

/// Of Σ weight × F.
Budget budget(const PreparedModel& model, const PreparedUncertainty& fit, std::span<const TypeBTerm> terms,
              std::span<const WeightedGeometry> geometries, Frame frame = Frame::xy);
/// With slopes of the fit that are known in another way.
Budget budget(const PreparedModel& model, const PreparedUncertainty& fit, const MuellerGradient& gradient,
              std::span<const TypeBTerm> terms, std::span<const WeightedGeometry> geometries, Frame frame = Frame::xy);

/// One matrix for each drawn model (draws.hpp), with errors of the terms drawn along, each normal. `model` is the
/// one that was drawn from. The same seed gives the same errors at all geometries, as it is the same instrument.
std::vector<Mueller> drawn(std::span<const PreparedModel> draws, const PreparedModel& model,
                           std::span<const TypeBTerm> terms, const Geometry& geometry, Frame frame = Frame::xy,
                           unsigned long seed = 0);

}  // namespace mmbrdf
