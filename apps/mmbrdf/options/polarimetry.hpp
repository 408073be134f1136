// SPDX-License-Identifier: BSD-3-Clause
// What the commands of a polarimeter share: options, what is made of a judgement, and what is printed of it.
#pragma once

#include <optional>
#include <string>

#include "mmbrdf/model/model.hpp"
#include "mmbrdf/polarimetry/judgement.hpp"
#include "options/option.hpp"

namespace mmbrdf::program {

/// N,THICKNESS_UM,N_SUBSTRATE,K_SUBSTRATE
Film film_from(const std::string& text);

/// dark:X,shot:Y,relative:Z in any order; what is not named is 0.
ReadingNoise noise_from(const std::string& text);

/// --saturation and --noise
void add_reading_options(CLI::App& app, double& saturation, ReadingNoise& noise);

/// RATIO,STEP[,RETARDANCE]: two turning retarders, in radians.
struct TurningRetarders {
  double ratio = 5, step = radians(6), retardance = radians(90);
  RetarderOptions options(std::size_t frames) const;
};
TurningRetarders retarders_from(const std::string& text);

/// --retarders
Option add_retarders(CLI::App& app, std::optional<TurningRetarders>& retarders, const std::string& description);

/// Warns of the doubts about what is called `name`, and throws std::runtime_error if it is refused.
void heed(const Verdict& verdict, const std::string& name);

/// On standard output.
void print_instrument(const Calibration& calibration);

/// simulate --raw
struct RawSimulation {
  std::string folder;
  double reading_noise = 1e-3;  ///< relative
  double speckle = 0;
  unsigned long seed = 0;
  std::optional<TurningRetarders> retarders = {};
  std::size_t frames = 61;  ///< of these
};

/// Throws std::invalid_argument if it would overwrite the model.
void require_kept(const std::string& model, const RawSimulation& options);

/// Writes references.csv and raw.csv, and says what to do with them.
void simulate_raw(const Model& model, double wavelength, std::span<const Geometry> geometries,
                  const RawSimulation& options);

}  // namespace mmbrdf::program
