// SPDX-License-Identifier: BSD-3-Clause
/// What a measurement will tell, before it is made: the covariance of a posterior depends on where is measured, on the
/// noise and on the variances of the sample, not on the readings (theory 8.6).
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/geometry/geometry.hpp"
#include "mmbrdf/mixed/posterior.hpp"

namespace mmbrdf {

/// The variances of a sample and the noise of an instrument.
struct VarianceComponents {
  struct OfBlock {
    std::vector<double> hyperparameters;  ///< as in BlockPosterior
    double noise_variance = 0;
  };
  Orders orders{12, 10};  ///< of the isotropic modes
  DiscMapping mapping = DiscMapping::lambert;
  ReadingLaw law;
  std::vector<double> f11;      ///< as in PosteriorAt; empty: 1/π everywhere
  std::vector<OfBlock> blocks;  ///< of the isotropic family; without hyperparameters: not measured
  Elements unread{};            ///< of these blocks, elements that readings do not tell of, those to come neither
};

/// Those of a fit at the fitted wavelength that is nearest (micrometres), for readings of the elements that it had.
VarianceComponents components_of(const Posterior& posterior, double wavelength);

/// For a sample that nobody measured: the medians of five fits of sintered PTFE, and this noise (relative for f11, at
/// normal directions). Of another material they are an order of magnitude.
VarianceComponents default_components(double noise = 0.007);

/// What is asked of a plan.
struct PlanTarget {
  enum class Kind {
    block,  ///< root mean square u of all elements of a block over directions up to 70°
    dhr,    ///< u of the directional-hemispherical reflectance at incident.theta, unpolarized
    f11,    ///< u of f11 at a geometry, sr⁻¹
  };
  Kind kind = Kind::block;
  std::size_t block = 0;
  Geometry geometry{};
};

/// A target with its name: "11", "12_13_21_31" … of the blocks; "dhr_45", "f_0_45", "f_0_45_90".
struct NamedTarget {
  std::string name;
  PlanTarget target;
};
/// All blocks that were measured, in canonical order.
std::vector<NamedTarget> block_targets(const VarianceComponents& components);
/// Of "dhr:THETA[,THETA...]" or "f:THETA_I:THETA_R[:PHI_R]", in degrees, phi_r 180 unless it is given. Throws
/// std::invalid_argument for another text.
std::vector<NamedTarget> targets_from(const std::string& text);

/// Directions to be measured.
struct NamedDesign {
  std::string name;
  std::vector<Geometry> geometries;
};
/// The design as it is, and twice with the sample turned between its readings: every second one by 180 degrees, and each
/// by 222.5 degrees from the one before.
std::vector<NamedDesign> with_turns(const NamedDesign& design);

/// Expected standard uncertainties of the targets from readings at these geometries, one for each time that it is there:
/// of the posterior part, by a model of all modes behind it; declared errors come on top, and what a model of lower orders
/// leaves out. Throws std::invalid_argument for components that do not agree
/// with the blocks, an invalid geometry, or a polar angle of 90 degrees, where the law is infinite.
std::vector<double> expected_uncertainties(const VarianceComponents& components, std::span<const Geometry> design,
                                           std::span<const PlanTarget> targets);

/// A candidate takes some kilobytes.
inline constexpr std::size_t most_candidates = 20000, most_picks = 1000;

/// The candidates to measure next, one after the other, each that which lowers the variances of the targets most, all
/// targets together in parts of what they are at the start; a candidate may come again. Throws as
/// expected_uncertainties() does, and std::invalid_argument without candidates or targets, or with more
/// candidates or picks than these.
std::vector<std::size_t> chosen(const VarianceComponents& components, std::span<const Geometry> design,
                                std::span<const PlanTarget> targets, std::span<const Geometry> candidates,
                                std::size_t count);

}  // namespace mmbrdf
