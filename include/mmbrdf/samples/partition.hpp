// SPDX-License-Identifier: BSD-3-Clause
/// Partitions of samples: folds that are left out in turn, or subsets that are fitted apart.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf {

/// Every sample belongs to one fold.
struct Partition {
  enum class Kind { rows, random, angle, wavelength };
  Kind kind = Kind::rows;
  std::vector<std::size_t> fold;   ///< of each sample, counted from 0
  std::vector<std::string> names;  ///< of the folds: "fold 1", "30 degrees", "532 nm"
};
/// "rows", "random", "angle", "wavelength"
std::string to_string(Partition::Kind kind);

/// Sample number modulo `folds`. Throws std::invalid_argument unless 2 ≤ folds ≤ max_folds and folds ≤ samples.
Partition folds_by_row(std::size_t samples, int folds);

/// As even as can be, by the seed, the same on every machine. Throws as folds_by_row does.
Partition random_folds(std::size_t samples, int folds, unsigned long seed);

/// The direction of each sample, numbered in the order in which they first come: theta_i, theta_r and phi_r − phi_i to a
/// tenth of a degree. At another wavelength, or of the sample turned about its normal, it is the same.
std::vector<std::size_t> directions(std::span<const Sample> samples);

/// The directions dealt as folds_by_row() or, with a seed, random_folds() deal samples. Samples of one direction stay
/// together: else what is left out is known from its repeats. Throws as these do.
Partition folds_by_direction(std::span<const Sample> samples, int folds, std::optional<unsigned long> seed = {});

/// One fold for each polar angle of incidence. Angles are one if no gap between them exceeds the tolerance (radians):
/// files round, and the published grid has 0.001 degrees for 0. Throws std::invalid_argument for fewer than 2 or more
/// than max_folds angles, for so many that they cannot be told apart, or a negative tolerance.
Partition folds_by_incident_angle(std::span<const Sample> samples, double tolerance = radians(0.1));

/// One fold for each wavelength. Throws std::invalid_argument for fewer than 2 or more than max_folds wavelengths.
Partition folds_by_wavelength(std::span<const Sample> samples);

/// What cross-validation leaves out in turn beside folds of samples: whole incident angles, wavelengths, both, nothing,
/// or what the data allow: angles if they can be told apart, wavelengths if there are three or more, since without one
/// of two no power of the wavelength could be tested.
enum class LeaveOut { what_can_be, angle, wavelength, both, none };
/// "angle", "wavelength", "angle,wavelength", "none". Throws std::invalid_argument for another name.
LeaveOut leave_out_from(const std::string& name);

struct FoldOptions {
  int folds = 3;           ///< of samples: folds_by_direction
  bool random = false;     ///< by lot
  unsigned long seed = 1;  ///< of these
  LeaveOut leave_out = LeaveOut::what_can_be;
};
struct Folds {
  std::vector<Partition> partitions;
  std::string note;  ///< why angles cannot be left out, and what that means; empty if they can, or need not
};
/// Throws std::invalid_argument as the functions above do, for what was asked for by name.
Folds folds(std::span<const Sample> samples, const FoldOptions& options);

/// The samples of each fold, in the order they had. Throws std::invalid_argument if the partition is of another number
/// of samples.
std::vector<std::vector<Sample>> parts(std::span<const Sample> samples, const Partition& partition);

inline constexpr int max_folds = 100;  ///< each holds a triangle for each element and wavelength

}  // namespace mmbrdf
