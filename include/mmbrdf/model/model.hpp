// SPDX-License-Identifier: BSD-3-Clause
/// A Mueller-matrix BRDF model: coefficients over a list of modes. A model is prepared, then evaluated.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/basis/modes.hpp"
#include "mmbrdf/geometry/geometry.hpp"

namespace mmbrdf {

/// Directional-hemispherical reflectance by wavelength, linear between the nodes, constant beyond them. It multiplies
/// f11 of models that were fitted to several wavelengths. Empty: factor 1.
struct ReflectanceTable {
  std::vector<double> wavelengths{};          ///< micrometres, rising
  std::vector<double> values{};               ///< one for each
  std::vector<double> covariance{};           ///< of the values, square and row-major; empty: they count as exact
  std::vector<double> covariance_with_f11{};  ///< of each value (row) with each coefficient of block 11; empty with it
  double at(double wavelength) const;
  std::vector<double> weights(double wavelength) const;  ///< at(wavelength) = Σ weights × values
};

/// Throws std::invalid_argument unless sizes agree, wavelengths rise and are positive, values are positive and
/// covariances finite.
void require_valid(const ReflectanceTable& table);

/// Where the data were that a model was fitted to. Published coefficient files do not say it.
struct Validity {
  std::vector<double> wavelengths;    ///< micrometres, rising; empty: unknown
  std::optional<double> theta_i_max;  ///< largest polar angles in radians; none: unknown
  std::optional<double> theta_r_max;
};

/// Reasons for which a result lies outside the fitted range; a bit each.
enum Outside : unsigned {
  inside = 0,
  outside_theta_i = 1,
  outside_theta_r = 2,
  outside_wavelength = 4,
  unknown_range = 8,  ///< it is not known whether an angle or the wavelength is inside
};

/// "ok", or the reasons joined by "+": "theta_i+wavelength"; "unknown" for unknown_range.
std::string to_string(Outside outside);

/// Whether an angle or the wavelength is outside, and not only unknown.
bool leaves_known_range(Outside outside);

/// Modes that were fitted together, with their coefficients and what is known about them.
struct FittedBlock {
  Block block;
  std::vector<double> coefficients;  ///< powers × modes: all modes for λ⁰ first, then all for λ¹, …
  std::vector<double> covariance;    ///< of these coefficients, square and row-major; empty: unknown
  int rank = 0;                      ///< of the fit; 0: unknown
  double condition = 0;              ///< of the fit; 0: unknown
  std::vector<double> null_space{};  ///< orthonormal combinations of the coefficients that the data left free, (count −
                                     ///< rank) × count row-major; empty if there are none, or they are not known
};

/// Highest power of the wavelength that a model may have.
inline constexpr int max_power = 9;

/// Largest wavelength that a model takes, micrometres: beyond it λ⁹ would end in infinities.
inline constexpr double max_wavelength = 1e6;

/// Throws std::invalid_argument, with the wavelength in nm, unless 0 < wavelength ≤ max_wavelength.
void require_wavelength(double wavelength);

/// f11 = R(λ) Σ_p λ^p Σ a_p Y,   f_ij = f11 Σ_p λ^p Σ a_p Y, λ in micrometres (Eqs. 17–20). Plain data; fit() and
/// load_model() make valid ones, prepare() checks.
struct Model {
  std::string name;
  Family family = Family::isotropic;
  DiscMapping mapping = DiscMapping::lambert;
  Rotation rotation =
      Rotation::covariant;  ///< how the azimuths of the samples entered the fit, and those of a question
                            ///< enter an evaluation
  int powers = 0;           ///< highest power of the wavelength
  std::vector<FittedBlock> blocks;
  ReflectanceTable reflectance;
  Validity validity;
  std::map<std::string, std::string> provenance;  ///< free text: data, command, software, attribution, …
};

/// Throws std::invalid_argument if blocks, coefficient counts or the reflectance table do not fit together.
void require_valid(const Model& model);

/// Whether it is evaluated at phi_i = 0 and turned.
bool turns(const Model& model);

/// The model with the azimuths as they are: to compare with other programs, whatever it was fitted to.
Model as_printed(Model model);

int mode_count(const Model& model);
int coefficient_count(const Model& model);
Orders orders(const Model& model);

/// Which of the fitted ranges the question leaves. Angles and wavelengths at the edge are inside (to 1e-9).
Outside outside(const Validity& validity, double wavelength, const Geometry& geometry);

class PreparedIncidence;

/// A model at one wavelength: what does not depend on the geometry is done. Holds its own copy of all it needs.
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

  /// Of the model's table, at this wavelength.
  double reflectance() const { return reflectance_; }

 private:
  friend PreparedModel prepare(const Model&, double);
  friend class PreparedIncidence;
  friend struct Evaluation;
  struct Pattern;  // what is the same for all wavelengths
  PreparedModel(std::shared_ptr<const Pattern> pattern, double wavelength);
  void set(std::vector<double> coefficients);
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

/// Models that need no wavelength: with highest power 0, and no reflectance table or one with a single node. Returns
/// their wavelength, or 1 if that is unknown. Throws std::invalid_argument, with the fitted wavelengths, for others.
double only_wavelength(const Model& model);

/// Wavelengths (micrometres) at which to show a model: the fitted ones, else the nodes of its reflectance table, else 1
/// for a model with highest power 0. Empty if it depends on the wavelength and says nothing.
std::vector<double> known_wavelengths(const Model& model);

/// Whether these are its own. If not, and it has one, that stands for any wavelength.
bool knows_wavelength(const Model& model);

/// Bound on |error| / |f11| of an evaluated element for fitted models up to orders 7, 4, away from zeros of f11.
inline constexpr double evaluation_error = 1e-13;

}  // namespace mmbrdf
