// SPDX-License-Identifier: BSD-3-Clause
/// A model prepared at a wavelength, or at that and an incident direction, and evaluated.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "mmbrdf/model/model.hpp"

namespace mmbrdf {

class PreparedIncidence;

/// A model at one wavelength: what does not depend on the geometry is done. Holds its own copy of all it needs. Elements
/// that were not measured are NaN in its matrices: unknown_elements() says which.
/// Evaluation allocates nothing, locks nothing and may run in many threads at once.
class PreparedModel {
 public:
  /// The Mueller BRDF in sr⁻¹ at one geometry, in the frame asked for.
  /// Throws std::invalid_argument if a polar angle is not in [0, π/2] or an angle is not finite.
  Mueller evaluate(const Geometry& geometry, Frame frame = Frame::xy) const;

  /// The Mueller BRDF in sr⁻¹ for directions given as unit vectors (z ≥ 0, length 1 to 1e-6); along the normal, phi =
  /// 0. Throws std::invalid_argument for other vectors.
  Mueller evaluate(const Vector3& incident, const Vector3& reflected, Frame frame = Frame::xy) const;

  /// One matrix for each geometry, the same to the last bit as one by one. Throws std::invalid_argument if the sizes
  /// differ or for the first invalid geometry, before anything is written. With several threads, for unit vectors, in
  /// single precision: batch.hpp.
  void evaluate(std::span<const Geometry> geometries, Frame frame, std::span<Mueller> out) const;

  /// The unpolarized BRDF alone, sr⁻¹.
  double f11(const Geometry& geometry) const;

  Outside outside(const Geometry& geometry) const;

  /// The same model at another wavelength (micrometres, positive), with the coefficients it was prepared from.
  PreparedModel at(double wavelength) const;

  /// The same modes at the same wavelength with other coefficients, one for each mode, block after block as in the
  /// model: Σ_p λ^p a_p of its coefficients of power p; and another factor of f11. Cheap: for many draws of both.
  /// Throws std::invalid_argument for another number of coefficients, or numbers that are not finite.
  PreparedModel with(std::span<const double> coefficients, double reflectance) const;

  /// The model at one incident direction, for many reflected ones.
  PreparedIncidence at(const Direction& incident) const;

  double wavelength() const { return wavelength_; }

  /// Σ_p λ^p a_p of its coefficients of power p, one for each mode, block after block as in the model.
  std::span<const double> coefficients() const { return of_modes_; }

  /// Of the model's table, at this wavelength.
  double reflectance() const { return reflectance_; }

 private:
  friend PreparedModel prepare(const Model&, double);
  friend class PreparedIncidence;
  friend struct Evaluation;
  struct Pattern;  // what is the same for all wavelengths
  PreparedModel(std::shared_ptr<const Pattern> pattern, double wavelength);
  std::shared_ptr<const Pattern> pattern_;
  std::vector<double> of_modes_;  // coefficients at this wavelength
  std::vector<double> of_form_;   // the coefficients as the kernel takes them
  double reflectance_ = 1;
  double wavelength_ = 0;
};

/// A model at one wavelength and one incident direction: what is left are functions of the reflected direction.
class PreparedIncidence {
 public:
  /// As PreparedModel::evaluate, for the incident direction this was made for. Agrees with it to evaluation_error ×
  /// f11.
  Mueller evaluate(const Direction& reflected, Frame frame = Frame::xy) const;
  void evaluate(std::span<const Direction> reflected, Frame frame, std::span<Mueller> out) const;
  const Direction& incident() const { return incident_; }

 private:
  friend class PreparedModel;
  friend struct Evaluation;
  PreparedIncidence(const PreparedModel& model, const Direction& incident);

  std::shared_ptr<const PreparedModel::Pattern> pattern_;
  std::vector<double> of_form_;  // coefficients as the kernel takes them
  double reflectance_;
  Direction incident_;
};

/// Folds powers of the wavelength (micrometres, positive), norms and the reflectance into flat arrays.
/// Throws std::invalid_argument for an invalid model or wavelength.
PreparedModel prepare(const Model& model, double wavelength);

/// Bound on |error| / |f11| of an evaluated element for fitted models up to orders 7, 4, away from zeros of f11.
inline constexpr double evaluation_error = 1e-13;

}  // namespace mmbrdf
