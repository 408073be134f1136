// SPDX-License-Identifier: BSD-3-Clause
/// Calibration of a polarimeter with redundant references: the eigenvalue calibration method (Compain, Poirier and
/// Drevillon, Appl. Opt. 38, 3490 (1999)), refined to maximum likelihood, with the covariance of the instrument.
///
/// References are measured with nothing between the arms, with a polarizer at several dial angles, and with a coated
/// wafer in specular reflection at several angles of incidence. None of their properties need be known, but for three
/// facts: eight instruments explain the same readings exactly, apart by independent signs of S2, S3 and S4. Which one
/// it is follows from (1) the sense of the polarizer's dial, (2) which of the wafer's two reflectances is that of s and
/// (3) the sign of its Δ: the last two come from a film model, or are stated with the reference.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/polarimetry/polarimeter.hpp"
#include "mmbrdf/polarimetry/rotating_retarders.hpp"
#include "mmbrdf/polarization/elements.hpp"

namespace mmbrdf {

enum class ReferenceKind {
  empty,      ///< the arms aligned, nothing between them: M = 1
  polarizer,  ///< in transmission, the arms aligned
  wafer,      ///< in specular reflection
  retarder,   ///< in transmission, the arms aligned, its fast axis at a known azimuth
};

/// "empty", "polarizer", "wafer", "retarder"; the opposite throws std::invalid_argument for another name.
std::string to_string(ReferenceKind kind);
ReferenceKind reference_kind_from(const std::string& name);

struct Reference {
  ReferenceKind kind = ReferenceKind::empty;
  /// Radians: the polarizer's dial, the angle of incidence on the wafer, or the azimuth of the retarder's fast axis.
  double angle = 0;
  std::vector<double> readings;  ///< in the order of polarimeter.hpp
  int s_exceeds_p = 0;           ///< wafer: +1 if |rs| > |rp|, −1 if not, 0 if the film model shall tell
  /// Of Δ in (−π, π]. Wafer: 0 if the film model shall tell. Retarder: 0 is +1, a retardance below 180 degrees.
  int delta_sign = 0;
};

/// An instrument of two turning retarders, and what of it is fitted besides retardances, offsets, the second polarizer
/// and the responsivity. The azimuth of the first polarizer is a gauge that air does not show: it is as given, or fitted
/// if there is a wafer or a retarder among the references.
struct RetarderOptions {
  RotatingRetarders nominal;
  std::vector<DialAngles> dials;  ///< of each reading
  bool fit_diattenuation = true;
  bool fit_extinction = true;  ///< of both polarizers
  bool fit_drift = true;       ///< of the source, linear over the frames of each reference
};

struct CalibrationOptions {
  /// Given: the instrument is of that kind. The numbers of states, what is known of the polarizer's azimuth and whether to
  /// refine are then not asked.
  std::optional<RetarderOptions> retarders = {};
  std::size_t generator_states = 4;
  std::size_t analyzer_states = 4;
  double wavelength = 0;  ///< micrometres
  int dial_sense = 1;     ///< +1: the azimuth of the polarizer grows with its dial, from e1 towards e2; −1: it falls
  double extinction = 0;  ///< of the polarizer, for the linear solution
  /// Azimuth of the polarizer at dial 0, to some 30 degrees (radians): for references without a wafer, which leave it or
  /// 90 degrees more.
  std::optional<double> polarizer_near = {};
  std::optional<Film> film;          ///< the wafer; its thickness is fitted, within film_range of this one
  bool refine = true;                ///< maximum likelihood behind the linear solution
  bool fit_polarizer_phase = false;  ///< besides its extinction, in the refinement
  ReadingNoise noise{.dark = 0, .shot = 0, .relative = 1e-3};  ///< weights of the refinement: proportions count
};

/// What a reference turned out to be.
struct FittedReference {
  ReferenceKind kind = ReferenceKind::empty;
  double angle = 0;
  double gain = 1;                 ///< empty: of all its readings, with mean 1 over the empty ones
  double drift = 0;                ///< rotating retarders: of the source, from the first frame to the last, relative
  DiattenuatorRetarder element;    ///< polarizer, wafer, retarder: tau, psi and delta
  Mueller expected;                ///< its matrix divided by element 11
  Mueller measured;                ///< the matrix of the reference from its readings
  double eigenvalue_mismatch = 0;  ///< wafer: |λ1 λ2 − |λ3|²| / τ², 0 for one that does not depolarize
};

/// Root mean square of the differences between the measured and the expected matrices of references, each divided by
/// element 11, over the fifteen other elements.
struct FigureOfMerit {
  double total = 0;
  double corrected = 0;                                      ///< total × √(readings / degrees of freedom)
  double empty = 0, polarizer = 0, wafer = 0, retarder = 0;  ///< by kind; 0: none
  Mueller elements;                                          ///< element by element
};

/// What rotating retarders were found to be.
struct CalibratedRetarders {
  RotatingRetarders values;
  std::vector<DialAngles> dials;
  std::vector<double> covariance;  ///< of parameters(values), row-major, scaled by the misfit; 0 for what is not fitted
};

/// A calibrated instrument at one wavelength, and what it was calibrated from.
struct Calibration {
  double wavelength = 0;  ///< micrometres
  Polarimeter polarimeter;
  std::optional<CalibratedRetarders> retarders = {};  ///< of which the states and their covariance are made
  /// Of the components of w_1, …, a_1, … (see Reduction), scaled by the misfit; empty without refinement. How A and W
  /// share their scale is fixed: the first components of w have mean 1. What scale they have together is that of the
  /// empty references, and as uncertain as scale_uncertainty.
  std::vector<double> covariance;
  double scale_uncertainty = 0;  ///< relative: of the mean of the empty references, from their scatter; 0 for only one
  double polarizer_offset = 0;   ///< azimuth of the polarizer at dial 0, radians, in [0, π)
  double extinction = 0;         ///< of the polarizer
  double polarizer_phase = 0;
  double film_thickness = 0;  ///< micrometres; 0 without a film
  double film_misfit = 0;     ///< of the film to ψ and Δ of the wafers, radians, root mean square; 0 without a film
  std::vector<FittedReference> references;
  FigureOfMerit figure_of_merit;
  double singular_ratio = 0;  ///< s16/s15 of the stacked equations: misfit of the linear solution
  /// s15/s1: how far the references are from leaving a second solution. Of rotating retarders the smallest singular
  /// value over the largest of the slopes of all readings, each column scaled to 1.
  double identifiability = 0;
  double generator_condition = 0, analyzer_condition = 0;
  double chi_squared = 0;                         ///< of the refinement, in units of the given noise; 0 without it
  long degrees_of_freedom = 0;                    ///< readings less unknowns, 0 if there are more of these
  std::map<std::string, std::string> provenance;  ///< as in Model
};

/// How far the thickness of a film may be from the given one, relative.
inline constexpr double film_range = 0.2;

/// Root mean square of what a film's ψ and Δ may be off those of the wafers, radians. A film of another order of
/// interference than 18 wafers have is off by more.
inline constexpr double film_tolerance = 0.05;

/// The film tells the signs if no other signs fit it, at any thickness, unless with a misfit of this many times its
/// own. A misfit counts as at least least_film_misfit: angles and indices are not known better.
inline constexpr double film_distinction = 3, least_film_misfit = 0.01;

/// Above this condition number of the generator or analyzer the noise of the readings is all that is left of a matrix.
inline constexpr double worst_condition = 100;

/// Above this figure of merit references and instrument hardly belong together.
inline constexpr double doubtful_merit = 0.05;

/// Below this identifiability there is more than one solution for what can be measured.
inline constexpr double least_identifiability = 1e-4;

/// An instrument of two turning retarders is found from empty references alone, or with any others, by maximum likelihood
/// of its few numbers, from the nominal ones; where that ends in no fit, from a hundred others. Of the two instruments that
/// explain air alike, with the fast axes of both retarders exchanged for the slow ones, it is the one that has the signs
/// of the wafers and retarders, and without these the one whose azimuths are nearer to the nominal ones. Its condition
/// numbers are not limited: judged() has them.
///
/// Throws std::invalid_argument, naming the reference by its number from 1, for a wrong number of readings, or one that
/// is not finite; and, saying what is missing, for references that cannot determine the instrument: no empty one, no
/// polarizer, no wafer, one dial angle only, an identifiability below least_identifiability, fewer than four
/// independent states, or a wafer whose signs nothing tells; for a film that is more than film_tolerance from the
/// wafers, or whose thickness comes out at an end of film_range; for wafers whose signs the film leaves open
/// (film_distinction); for stated signs that contradict each other, the readings or the film; for a condition number
/// above worst_condition; and for readings and noise so far apart that no finite numbers are left.
Calibration calibrate(std::span<const Reference> references, const CalibrationOptions& options);

/// The eight instruments that explain the same readings: the signs of the components 2, 3 and 4 of all
/// states, W → D W, A → A D.
Polarimeter with_signs(const Polarimeter& polarimeter, int s2, int s3, int s4);

}  // namespace mmbrdf
