// SPDX-License-Identifier: BSD-3-Clause
/// A polarimeter: what states it makes and analyses, and the Mueller matrix that its readings stand for.
///
/// A reading is B_qp = a_q · M w_p: analysis state q, generator state p, dark-subtracted, divided by the monitor of the
/// incident power and by the gain. A measurement reads pairs of states: each analysis state with each generator state
/// (in matrices B = A M W, with the rows a_q and the columns w_p), or fewer, as two turning retarders do. Readings of a
/// grid stand in row-major order: all generator states of the first analysis state first. Both arms have the axes (⊥, ∥)
/// of the scattering plane, and the matrix is in Frame::scattering_plane.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/polarization/mueller.hpp"
#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf {

/// The states of one reading, counted from 0.
struct StatePair {
  std::size_t generator = 0, analyzer = 0;
  friend bool operator==(const StatePair&, const StatePair&) = default;
};

struct Polarimeter {
  std::vector<Stokes> generator = {};  ///< w_p: the light of each generator state
  std::vector<Stokes> analyzer = {};   ///< a_q: what each analysis state responds to
  /// Of the readings, in their order. Empty: each generator state with each analysis state.
  std::vector<StatePair> pairs = {};
  std::size_t readings() const { return pairs.empty() ? generator.size() * analyzer.size() : pairs.size(); }
  StatePair pair(std::size_t reading) const {
    return pairs.empty() ? StatePair{reading % generator.size(), reading / generator.size()} : pairs[reading];
  }
};

/// The same states, read in these pairs. Throws std::invalid_argument for a state that is not there.
Polarimeter reading(const Polarimeter& polarimeter, std::vector<StatePair> pairs);

/// "generator state 2, analyzer state 1": counted from 1.
std::string to_string(const StatePair& pair);

/// Of an arm, in readings, instruments and calibrations: the covariance of both arms has (8 × that)² numbers.
inline constexpr std::size_t most_states = 100;

/// A polarizer along ⊥ and behind it a retarder at each of these azimuths (radians); the analyzer mirrors it:
/// w = retarder(azimuth) (1, 1, 0, 0), a = ½ (1, 1, 0, 0) retarder(azimuth).
Polarimeter ideal_polarimeter(double retardance, std::span<const double> azimuths);

/// Fully polarized light of unit intensity by its name: s and p, +45 (from s towards p) and −45, L and R; or u, which is not
/// polarized. Throws std::invalid_argument for another name.
Stokes named_state(const std::string& name);

/// Generator states w and analysis states a = ½ w' of these names.
Polarimeter ideal_polarimeter(std::span<const std::string> generator, std::span<const std::string> analyzer);

/// Ratio of the largest to the smallest of the four singular values: √3 at best; infinite for fewer than four
/// independent states, or for one that is not finite.
double condition_number(std::span<const Stokes> states);

/// Azimuths of a retarder behind a polarizer that make this condition number smallest, rising and symmetric about 0, in
/// [−π/2, π/2]: for four states of the best plate, 131.81 degrees, ±15.12 and ±51.69 degrees. The best end of a simplex
/// search from 40 starts, the same each time. Throws std::invalid_argument for a retardance that is not finite or a
/// multiple of π (there are no four independent states), and for fewer than 4 states or more than 16.
std::vector<double> optimal_angles(double retardance, int states);

/// The readings of a matrix.
std::vector<double> readings(const Polarimeter& polarimeter, const Mueller& m);

/// σ² of a reading B: dark² + shot · |B| + (relative · B)². In units of the readings.
struct ReadingNoise {
  double dark = 0;
  double shot = 0;
  double relative = 0;
};
double variance(const ReadingNoise& noise, double reading);

/// The sample whose Mueller matrix, relative to the collinear beam and in Frame::scattering_plane, is m:
/// f = m / (solid_angle · cos θr). Throws std::invalid_argument unless solid_angle (sr) is positive and at most 2π, M11
/// positive, θr below 90 degrees and the geometry valid.
Sample sample(const Mueller& m, double wavelength, const Geometry& geometry, double solid_angle);

}  // namespace mmbrdf
