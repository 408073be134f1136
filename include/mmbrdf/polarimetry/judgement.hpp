// SPDX-License-Identifier: BSD-3-Clause
/// What to make of an instrument, and of what it measured: the limits beyond which program and Python package refuse
/// it, or warn. calibrate() and Reduction themselves go on to where no numbers are left.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/polarimetry/calibration.hpp"
#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf {

/// Condition number of the generator or analyzer states above which an instrument is doubtful; the best is √3. Above
/// worst_condition it is refused.
inline constexpr double doubtful_condition = 10;

/// Figure of merit above which references and instrument do not belong together: refused. Above doubtful_merit it is
/// doubtful.
inline constexpr double worst_merit = 0.5;

/// Change of a film's thickness from the given one, relative, above which it is doubtful: the range of the fit ends soon
/// behind it, and another film may be in it by chance.
inline constexpr double doubtful_film_change = film_range / 2;

/// Distance of a fast axis from its nominal azimuth (radians) above which air may have told it wrongly: that is at 45
/// degrees.
inline constexpr double doubtful_offset = radians(30);

/// Chi squared over degrees of freedom above which turning retarders are doubtful: of a noise law that is half as large as
/// the noise.
inline constexpr double doubtful_misfit = 4;

/// Smallest coherency eigenvalue over f11 below which a matrix cannot be physical: noise seldom gets there.
inline constexpr double impossible_eigenvalue = -0.05;

/// Sentences that begin with what is wrong, in lower case: to go behind the name of a file.
struct [[nodiscard]] Verdict {
  std::vector<std::string> doubts;  ///< to warn of; empty if there is nothing to say
  std::string refusal;              ///< why it must not be used; empty if it may be
};

/// Of an instrument: its condition numbers, then its figure of merit, then what pairs of states leave unknown. The first
/// that is refused ends the list. With what was given to calibrate(), also of the film's thickness that came out, and of
/// the retarders' axes.
Verdict judged(const Calibration& calibration, const std::optional<Film>& film = std::nullopt,
               const std::optional<RetarderOptions>& retarders = std::nullopt);

/// Of the samples that an instrument measured: doubts, and one only, if some whole matrices cannot be physical. Exchanged states of a
/// sample that depolarizes nearly all light do not show.
Verdict judged(std::span<const Sample> samples);

}  // namespace mmbrdf
