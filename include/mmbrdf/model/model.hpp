// SPDX-License-Identifier: BSD-3-Clause
/// A Mueller-matrix BRDF model: coefficients over a list of modes, and what is known about them. It is prepared, then
/// evaluated: prepared.hpp.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mmbrdf/basis/modes.hpp"
#include "mmbrdf/geometry/direction_pairs.hpp"
#include "mmbrdf/geometry/geometry.hpp"
#include "mmbrdf/mixed/posterior.hpp"

namespace mmbrdf {

/// Directional-hemispherical reflectance by wavelength, linear between the nodes, constant beyond them. It multiplies
/// f11 of models that were fitted to several wavelengths. Empty: factor 1.
struct ReflectanceTable {
  std::vector<double> wavelengths{};  ///< micrometres, rising
  std::vector<double> values{};       ///< one for each
  std::vector<double> covariance{};   ///< of the values: square, row-major; variances alone: independent; empty: exact
  std::vector<double> covariance_with_f11{};  ///< of each value (row) with each coefficient of block 11; empty with it
  /// Polar angles, one for each value, of the directions whose directional-hemispherical reflectance the values make a
  /// certified one; empty if they do not. Errors of a posterior that change it do not count then.
  std::vector<double> certified_theta{};
  double at(double wavelength) const;
  std::vector<double> weights(double wavelength) const;  ///< at(wavelength) = Σ weights × values
};

/// Throws std::invalid_argument unless sizes agree, wavelengths rise and are positive, values are positive and
/// at most largest_coefficient, covariances at most its square.
void require_valid(const ReflectanceTable& table);

/// Throws std::invalid_argument for a wavelength (micrometres) beyond the ends of a table, to 1e-7; an empty one has none.
void require_reaches(const ReflectanceTable& table, double wavelength);

/// Pairs of directions of which the samples of a wavelength tell, whatever the part of the hemisphere that they cover.
struct SupportedPairs {
  double wavelength = 0;  ///< micrometres
  DirectionPairs pairs;
  friend bool operator==(const SupportedPairs&, const SupportedPairs&) = default;
};

/// Where the data were that a model was fitted to. Published coefficient files do not say it.
struct Validity {
  std::vector<double> wavelengths;    ///< micrometres, rising; empty: unknown
  std::optional<double> theta_i_max;  ///< largest polar angles in radians; none: unknown
  std::optional<double> theta_r_max;
  std::vector<SupportedPairs> supported{};  ///< of rising wavelengths, between which both count and beyond which the
                                            ///< nearest; one holds for all. Empty: all within the angles
};

/// Reasons for which a result lies outside the fitted range; a bit each.
enum Outside : unsigned {
  inside = 0,
  outside_theta_i = 1,
  outside_theta_r = 2,
  outside_wavelength = 4,
  unknown_range = 8,        ///< it is not known whether an angle or the wavelength is inside
  outside_directions = 16,  ///< no samples support these directions together
  interpolated = 32,        ///< not outside: between two fitted wavelengths
};

/// "ok", or the reasons joined by "+": "theta_i+wavelength"; "unknown" for unknown_range.
std::string to_string(Outside outside);

/// Whether an angle, the directions or the wavelength is outside, and not only unknown or between.
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
  long rows = 0;                     ///< of the fit; 0: unknown
};

/// Highest power of the wavelength that a model may have.
inline constexpr int max_power = 9;

/// Largest wavelength that a model takes, micrometres: beyond it λ⁹ would end in infinities.
inline constexpr double max_wavelength = 1e6;

/// Largest magnitude of coefficients and reflectances, and of their covariances. So what is evaluated at any wavelength is
/// finite in double precision.
inline constexpr double largest_coefficient = 1e40, largest_variance = 1e80;

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
  /// Of which no sample tells: they are unknown, NaN, wherever the model is asked, and a block of none but such is absent.
  /// All other elements without modes are 0.
  Elements not_measured{};
  ReflectanceTable reflectance;
  Validity validity;
  std::optional<Posterior>
      posterior{};  ///< of fits of the mixed model: their uncertainty; then no block has a covariance
  std::map<std::string, std::string> provenance;  ///< free text: data, command, software, attribution, …
};

/// Throws std::invalid_argument if blocks, coefficient counts or the reflectance table do not fit together.
void require_valid(const Model& model);

bool has_covariance(const Model& model);  ///< of a block, at least, or a posterior

/// Of the fit: rows less rank, of the block where that is least, and 1 at least. Infinite where it is not known.
double degrees_of_freedom(const Model& model);

/// Whether it is evaluated at phi_i = 0 and turned.
bool turns(const Model& model);

/// The elements that are unknown in a frame: those that were not measured, and where axes are turned those that they are
/// mixed with.
Elements unknown_elements(const Model& model, Frame frame = Frame::xy);

/// The model with the azimuths as they are: to compare with other programs, whatever it was fitted to.
Model as_printed(Model model);

int mode_count(const Model& model);
int coefficient_count(const Model& model);
Orders orders(const Model& model);

/// Which of the fitted ranges the question leaves. Angles and wavelengths at the edge are inside (to 1e-9).
Outside outside(const Validity& validity, double wavelength, const Geometry& geometry);
/// Of the wavelength alone.
Outside outside(const Validity& validity, double wavelength);

/// Models that need no wavelength: with highest power 0, and no reflectance table or one with a single node. Returns
/// their wavelength, or 1 if that is unknown. Throws std::invalid_argument, with the fitted wavelengths, for others.
double only_wavelength(const Model& model);

/// Wavelengths (micrometres) at which to show a model: the fitted ones, else the nodes of its reflectance table, else 1
/// for a model with highest power 0. Empty if it depends on the wavelength and says nothing.
std::vector<double> known_wavelengths(const Model& model);

/// Whether these are its own. If not, and it has one, that stands for any wavelength.
bool knows_wavelength(const Model& model);

}  // namespace mmbrdf
