// SPDX-License-Identifier: BSD-3-Clause
/// A simulated goniometer: a polarimeter with known imperfections that measures references and a model, for where there
/// is no instrument. All is reproducible: the same seed gives the same readings with every compiler.
#pragma once

#include <optional>
#include <random>
#include <span>
#include <vector>

#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/polarimetry/calibration.hpp"

namespace mmbrdf {

/// Standard deviations of what makes each state of generator and analyzer differ from the ideal one.
struct Imperfections {
  double retardance = radians(3);  ///< of the plate, the same for all states of an arm
  double azimuth = radians(1.5);   ///< of the plate, state by state
  double diattenuation = 0.01;     ///< of the plate, along its axis
  double circular_retardance = radians(0.3);
  double depolarization = 0.004;  ///< of each state: its polarized part is smaller by |this|
  double stray = 0.01;  ///< light of another polarization that the detector sees: components 2 and 3 of its response
};

/// The largest relative noise, speckle and change of gain.
inline constexpr double most_noise = 1;

/// Relative noise, speckle and changes of gain are factors with mean 1 and these standard deviations, lognormal: with
/// none but them no reading is negative.
struct GoniometerOptions {
  /// Of an instrument of two turning retarders; empty: one whose states are each made by plates that stand still. Turning
  /// ones have the imperfections retardance and diattenuation of each plate, and azimuth: of the offset of each plate and of
  /// the second polarizer. Their polarizers, nominally parallel, have the extinction of the reference polarizer below.
  std::vector<DialAngles> dials = {};
  double retardance = radians(131.81);  ///< of the plates, nominal
  std::vector<double> azimuths;         ///< of the plates, radians; empty: optimal_angles(retardance, 4)
  Imperfections imperfections;
  double polarizer_offset = radians(23);  ///< azimuth at dial 0
  double extinction = 1e-5;
  Film film{1.4607, 1.0, {4.15, 0.044}};  ///< SiO2 on Si at 532 nm, 1 µm
  double dial_error = 0;                  ///< of the polarizer, radians
  double gain_change = 0.02;              ///< relative, from one reference measurement to the next
  double drift = 0;  ///< relative, linear over the readings of one measurement, not seen by the monitor
  ReadingNoise noise{.dark = 0, .shot = 0, .relative = 1e-3};
  double speckle = 0;             ///< relative, of each reading of a model, independent: × √(cos θi / cos θr)
  double solid_angle = 1.114e-4;  ///< of the receiver, sr
};

/// A goniometer that was made once and measures many times.
class Goniometer {
 public:
  /// Draws the imperfections. Throws std::invalid_argument for options that are negative or not finite, and for
  /// relative noise above most_noise.
  Goniometer(const GoniometerOptions& options, unsigned long seed);

  const Polarimeter& polarimeter() const { return polarimeter_; }
  /// The true numbers of an instrument of turning retarders; none of any other.
  const std::optional<RotatingRetarders>& retarders() const { return retarders_; }
  const GoniometerOptions& options() const { return options_; }

  /// `count` empty references; as many polarizers, at dial angles in equal steps of 180°/count from 0; as many wafers,
  /// at angles of incidence from 30 to 75 degrees. Throws std::invalid_argument for a count below 1.
  std::vector<Reference> references(double wavelength, int count, unsigned long seed) const;

  /// Readings of any matrix, with the noise and the drift of the instrument.
  std::vector<double> readings(const Mueller& m, unsigned long seed) const;

  /// Readings of a model, with noise and speckle: for each geometry those of F · solid_angle · cos θr in
  /// Frame::scattering_plane. Throws std::invalid_argument as PreparedModel::evaluate does, where θr is 90
  /// degrees, and for a model that does not know all elements.
  std::vector<std::vector<double>> readings(const PreparedModel& model, std::span<const Geometry> geometries,
                                            unsigned long seed) const;

 private:
  /// Adds to the readings what an instrument adds; `speckle` is relative.
  void disturb(std::vector<double>& readings, double speckle, double gain, std::mt19937_64& engine) const;

  GoniometerOptions options_;
  std::optional<RotatingRetarders> retarders_;
  Polarimeter polarimeter_;
};

}  // namespace mmbrdf
