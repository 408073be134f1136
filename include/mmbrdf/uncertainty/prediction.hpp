// SPDX-License-Identifier: BSD-3-Clause
/// Standard uncertainties of what a model predicts: the covariance of its coefficients, propagated in first order (GUM;
/// theory 4.1). They are those of the fit alone: of the noise in the data, and of the misfit as far as it looks like
/// noise. What all data share (scale, angles, the sample) is not in them. A reflectance table that the fit took from
/// its data has a covariance and counts; one that was given to it counts as exact.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/polarization/covariance.hpp"

namespace mmbrdf {

/// Slopes of the sixteen elements of a matrix over the parameters of a model at one wavelength: 16 × parameters,
/// row-major, an element in each row. Sums of matrices have the sums of their gradients.
struct MuellerGradient {
  std::vector<double> values;
};

/// One independent part of an uncertainty.
struct BudgetTerm {
  std::string name;
  MuellerCovariance covariance;                              ///< of the elements of F, in sr⁻²
  double freedom = std::numeric_limits<double>::infinity();  ///< degrees of freedom
};

/// The covariance of a model's coefficients at one wavelength. May be used in many threads at once.
class PreparedUncertainty {
 public:
  /// Covariance of the Mueller BRDF in sr⁻¹, as PreparedModel::evaluate gives it. Blocks are fitted apart, so for F =
  /// f11 m
  ///   u²(F) = m² u²(f11) + f11² u²(m);   elements of one block, and all through f11, are correlated.
  /// Throws std::invalid_argument for an invalid geometry.
  MuellerCovariance evaluate(const Geometry& geometry, Frame frame = Frame::xy) const;

  /// The same of many geometries, several times faster, and with the same bits. Throws std::invalid_argument for lists of
  /// different lengths, too.
  void evaluate(std::span<const Geometry> geometries, Frame frame, std::span<MuellerCovariance> out) const;

  /// Standard uncertainties of the elements in sr⁻¹: the roots of the diagonal of evaluate(), without the rest of it, which
  /// takes longer. Squares differ from that diagonal by rounding, at most batch_error of its largest element. Unknown
  /// elements are NaN. Throws std::invalid_argument for an invalid geometry, and for lists of different lengths.
  Mueller standard_uncertainty(const Geometry& geometry, Frame frame = Frame::xy) const;
  /// The same of many geometries, many times faster, and with the same bits.
  void standard_uncertainty(std::span<const Geometry> geometries, Frame frame, std::span<Mueller> out) const;

  /// Covariance of f11 in sr⁻¹ (element 11) and of the other elements divided by it. Throws std::invalid_argument for
  /// an invalid geometry.
  MuellerCovariance normalized(const Geometry& geometry, Frame frame = Frame::xy) const;

  /// Slopes of the Mueller BRDF in sr⁻¹, and of a weighted sum of it over geometries, such as the mean over an
  /// aperture. The parameters are the coefficients at this wavelength, block after block; behind those of block 11
  /// comes the reflectance there, if the table has a covariance. Throws std::invalid_argument for an invalid geometry
  /// or a weight that is not finite.
  MuellerGradient gradient(const Geometry& geometry, Frame frame = Frame::xy) const;
  MuellerGradient gradient(std::span<const WeightedGeometry> geometries, Frame frame = Frame::xy) const;

  /// cov(a_e, b_e') of two matrices with these gradients, of this model at this wavelength: what else would share no
  /// parameters. covariance(gradient(g), gradient(g)) is evaluate(g) but for rounding. Throws std::invalid_argument for
  /// gradients of another size.
  MuellerCovariance covariance(const MuellerGradient& a, const MuellerGradient& b) const;

  /// covariance(gradient, gradient) in its parts. Of a fit of least squares it is one, "fit"; of the mixed model:
  ///   posterior     what noise, the end of the basis and the anisotropy of the sample leave open
  ///   declared …    errors that all readings share, as they were declared; those of an instrument likewise
  ///   projection    what the evaluated modes miss of the posterior mean: of higher orders, of the wavelength
  std::vector<BudgetTerm> parts(const MuellerGradient& gradient) const;
  /// parts(gradient(geometry, frame)) but for rounding, and faster.
  std::vector<BudgetTerm> parts(const Geometry& geometry, Frame frame = Frame::xy) const;

  /// Slopes of the mean of F over both hemispheres that gives the bihemispherical reflectance over π: of f11, the other
  /// elements are 0.
  MuellerGradient bihemispherical_gradient() const;

  std::size_t parameters() const;

  /// Degrees of freedom of the fit, and so of these uncertainties: degrees_of_freedom(model).
  double freedom() const;

  /// Whether the data of the fit determine every element at a geometry that is not unknown. Where they do not, its
  /// uncertainties are those of the part that is determined: too small. The rows of the elements over the coefficients may
  /// lie in the combinations that the data leave free with at most 1e-8 of their length (theory 4.7). Of a deficient fit
  /// whose free combinations are not known nothing is. Throws std::invalid_argument for an invalid geometry.
  bool estimable(const Geometry& geometry) const;

  /// Standard uncertainty of the directional-hemispherical reflectance for unpolarized light. Throws
  /// std::invalid_argument for an invalid direction.
  double directional_hemispherical_reflectance(const Direction& incident) const;
  /// The same of many directions, faster, and with the same bits. Throws std::invalid_argument for lists of different
  /// lengths, too.
  void directional_hemispherical_reflectance(std::span<const Direction> incident, std::span<double> out) const;

 private:
  friend PreparedUncertainty prepare_uncertainty(const Model&, double);
  struct Blocks;
  struct Slopes;
  explicit PreparedUncertainty(std::shared_ptr<const Blocks> blocks);

  std::shared_ptr<const Blocks> blocks_;
};

/// Throws std::invalid_argument for an invalid model or wavelength (micrometres), a block whose covariance is not
/// known, a covariance with an eigenvalue below −covariance_tolerance times its largest, or numbers that overflow
/// at this wavelength.
PreparedUncertainty prepare_uncertainty(const Model& model, double wavelength);

/// Names of the parts of its uncertainties, the same at all wavelengths; "fit" where they are not known. Throws
/// std::invalid_argument as prepare_uncertainty() does.
std::vector<std::string> names_of_parts(const Model& model);

/// Whether the covariance of every block is known: without one of them there is no uncertainty of any prediction.
bool knows_uncertainty(const Model& model);

inline constexpr double covariance_tolerance = 1e-9;
/// How far variances of evaluate(), standard_uncertainty() and covariance(gradient, gradient) are from each other, of the
/// largest at that geometry; azimuths of many turns add their rounding.
inline constexpr double batch_error = 1e-12;

}  // namespace mmbrdf
