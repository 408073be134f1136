// SPDX-License-Identifier: BSD-3-Clause
/// Scattered directions drawn for an incident one, nearly as often as light goes there: for Monte-Carlo integration, renderers
/// and stray-light codes.
///
/// The caller owns the random numbers. A point (u1, u2) of the unit square is mapped to a direction: theta_r rises with u1, and
/// phi_r − phi_i from −π to π with u2, both continuously, so that stratified and quasi-random points stay so. The density is
/// close to |f11| cos theta_r; the pdf is exactly that of what is drawn (theory 5.3), so
///     the mean of weight() over uniform points is ∫ M cos theta_r dΩ_r
/// whatever the model, without bias. No point is rejected, and each costs the same.
///
/// **Polarized light** is drawn by f11, whatever its Stokes vector, and weight() is the whole matrix: the mean of its product
/// with any Stokes vector is right, too. Elements that the model does not know are NaN in it, as in evaluate(), and they make
/// components of M S NaN: a code without polarization takes element (0, 0), which is never unknown.
///
/// Where f11 is negative, which fits can be, it is drawn by |f11|, and the weight is negative; where it is 0, as often as
/// sampling_floor says: no weight is without bound. All functions throw std::invalid_argument for numbers outside [0, 1), for
/// invalid directions and for sizes that differ, in batches before anything is written. They may run in many threads at once.
#pragma once

#include <array>
#include <memory>
#include <span>

#include "mmbrdf/model/prepared.hpp"

namespace mmbrdf {

class SamplingMap;

/// Two numbers in [0, 1), of the caller's generator or sequence.
using UnitPoint = std::array<double, 2>;

struct SampledDirection {
  Direction reflected;
  double pdf = 0;  ///< per solid angle, sr⁻¹
};

/// The same as a unit vector.
struct SampledVector {
  Vector3 reflected{};
  double pdf = 0;  ///< per solid angle, sr⁻¹
};

/// Draws directions of a model at one wavelength, from tables that are made once: 0.3 MB in some milliseconds; 9 MB in some
/// tenths of a second, on all cores, where f11 depends on how the sample is turned (anisotropic, or as printed).
class DirectionSampler {
 public:
  /// Throws std::invalid_argument if f11 is positive nowhere. It is never unknown: there are no models without f11.
  explicit DirectionSampler(const PreparedModel& model);

  SampledDirection sample(const Direction& incident, const UnitPoint& u) const;

  /// Of unit vectors (z ≥ 0, length 1 to 1e-6).
  SampledVector sample(const Vector3& incident, const UnitPoint& u) const;

  /// Per solid angle, sr⁻¹: with it sample() comes upon a direction, for instance one that was drawn in another way. 0 for
  /// reflected directions below the horizon (theta_r in (π/2, π], z < 0), which it never draws.
  double pdf(const Direction& incident, const Direction& reflected) const;
  double pdf(const Vector3& incident, const Vector3& reflected) const;

  /// M cos theta_r / pdf, what Stokes vectors are multiplied with on the way: dimensionless, its mean is the reflectance.
  /// NaN in unknown elements.
  Mueller weight(const Direction& incident, const SampledDirection& drawn, Frame frame = Frame::xy) const;
  Mueller weight(const Vector3& incident, const SampledVector& drawn, Frame frame = Frame::xy) const;

  /// Many at once, the same to the last bit as one by one: an incident direction for each point, or one for all.
  /// threads 0: one for each core.
  void sample(std::span<const Direction> incident, std::span<const UnitPoint> u, std::span<SampledDirection> out,
              int threads = 1) const;
  void sample(std::span<const Vector3> incident, std::span<const UnitPoint> u, std::span<SampledVector> out,
              int threads = 1) const;
  void weights(std::span<const Direction> incident, std::span<const SampledDirection> drawn, Frame frame,
               std::span<Mueller> out, int threads = 1) const;
  void weights(std::span<const Vector3> incident, std::span<const SampledVector> drawn, Frame frame,
               std::span<Mueller> out, int threads = 1) const;

  /// That this was made of.
  const PreparedModel& model() const { return model_; }

 private:
  PreparedModel model_;
  std::shared_ptr<const SamplingMap> map_;
};

/// Directions are drawn at least this often, as a share of the mean over all azimuths at a theta_r, and all azimuths at a
/// theta_r as a share of the mean over the hemisphere: above the horizon pdf ≥ (sampling_floor / (1 + sampling_floor))² cos theta_r / π.
inline constexpr double sampling_floor = 0.01;

/// Bound on the relative difference of pdf() from the pdf that sample() gave for the same direction, but for 1e-12 of the
/// directions at steps of the tables and, of angles but not of vectors, those within 1e-6 rad of the horizon, where cos theta_r
/// is lost.
inline constexpr double sampling_error = 1e-8;

}  // namespace mmbrdf
