// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarimetry/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "mmbrdf/polarimetry/reduction.hpp"
#include "polarimetry/calibration_quality.hpp"
#include "polarimetry/calibration_refinement.hpp"
#include "polarimetry/eigenvalue_calibration.hpp"
#include "polarimetry/retarder_calibration.hpp"
#include "polarimetry/wafer_signs.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace calibration {

Mueller leaky_polarizer(double azimuth, double leak_real, double leak_imaginary) {
  const double extinction = leak_real * leak_real + leak_imaginary * leak_imaginary;
  Mueller m = diagonal((1 + extinction) / 2, (1 + extinction) / 2, leak_real, leak_real);
  m(0, 1) = m(1, 0) = (1 - extinction) / 2;
  m(3, 2) = leak_imaginary;
  m(2, 3) = -leak_imaginary;
  return rotated(m, azimuth);
}

Mueller reference_matrix(const Unknowns& unknowns, std::span<const Reference> references, std::size_t i,
                         const CalibrationOptions& options) {
  if (references[i].kind == ReferenceKind::empty) return identity();
  if (references[i].kind == ReferenceKind::wafer || references[i].kind == ReferenceKind::retarder)
    return rotated(mueller(unknowns.elements[i]), azimuth_of(references[i]));
  return leaky_polarizer(unknowns.offset + options.dial_sense * references[i].angle, unknowns.leak_real,
                         unknowns.leak_imaginary);
}

}  // namespace calibration

namespace {

using calibration::Unknowns;

constexpr std::array<const char*, 4> kind_names{"empty", "polarizer", "wafer", "retarder"};

void require_valid(const CalibrationOptions& options) {
  if (options.retarders) polarimeter(options.retarders->nominal, options.retarders->dials);
  if (options.polarizer_near && !std::isfinite(*options.polarizer_near))
    throw std::invalid_argument("the polarizer's rough azimuth is not finite");
  for (const auto& [arm, states] :
       {std::pair("generator", options.generator_states), {"analyzer", options.analyzer_states}})
    if (!options.retarders && (states < 4 || states > most_states))
      throw std::invalid_argument(std::to_string(states) + " states of the " + arm +
                                  (states < 4 ? ", four are needed" : ", more than " + std::to_string(most_states)));
  if (options.dial_sense != 1 && options.dial_sense != -1)
    throw std::invalid_argument("a dial sense of " + std::to_string(options.dial_sense) + ", not 1 or -1");
  if (!(options.extinction >= 0 && options.extinction < 1))
    throw std::invalid_argument("extinction " + shortest(options.extinction) + " is not in [0, 1)");
  const auto& [dark, shot, relative] = options.noise;
  if (!(dark >= 0 && shot >= 0 && relative >= 0 && dark + shot + relative > 0 && std::isfinite(dark + shot + relative)))
    throw std::invalid_argument("the noise of the readings must be finite, and positive somewhere");
  if (options.film) reflection(*options.film, options.wavelength, 0);
}

void require_valid(const Reference& reference, std::size_t number, const CalibrationOptions& options) {
  const std::string which = "reference " + std::to_string(number) + ": ";
  if (!options.retarders && reference.readings.size() != options.generator_states * options.analyzer_states)
    throw std::invalid_argument(which + std::to_string(reference.readings.size()) + " readings, expected " +
                                std::to_string(options.generator_states * options.analyzer_states));
  for (const double reading : reference.readings)
    if (!std::isfinite(reading)) throw std::invalid_argument(which + "a reading is not finite");
  if (!std::isfinite(reference.angle)) throw std::invalid_argument(which + "its angle is not finite");
  if (reference.kind != ReferenceKind::wafer) return;
  if (!(reference.angle >= 0 && reference.angle < std::numbers::pi / 2))
    throw std::invalid_argument(which + "an angle of incidence of " + shortest(degrees(reference.angle)) + " degrees");
  if (!options.film && (reference.s_exceeds_p == 0 || reference.delta_sign == 0))
    throw std::invalid_argument(
        which + "a wafer without signs: give a film, or state whether s exceeds p and the sign of delta");
}

/// Turning the dial the other way leaves directions that are 90 degrees apart as they are.
bool tells_sense(std::span<const Reference> references) {
  const auto polarizer = [](const Reference& r) { return r.kind == ReferenceKind::polarizer; };
  const auto first = std::find_if(references.begin(), references.end(), polarizer);
  return std::any_of(first, references.end(), [&](const Reference& r) {
    return polarizer(r) && std::abs(std::remainder(r.angle - first->angle, std::numbers::pi / 2)) > radians(1);
  });
}

/// Says what is missing.
void require_enough(std::span<const Reference> references) {
  const auto count = [&](ReferenceKind kind) {
    return std::count_if(references.begin(), references.end(), [&](const Reference& r) { return r.kind == kind; });
  };
  if (count(ReferenceKind::empty) == 0)
    throw std::invalid_argument("no empty reference: the arms aligned, nothing between");
  if (count(ReferenceKind::polarizer) == 0)
    throw std::invalid_argument("no reference with a polarizer: the others alone leave solutions mixed");
  if (count(ReferenceKind::wafer) + count(ReferenceKind::retarder) == 0)
    throw std::invalid_argument(
        "no reference with a wafer or a retarder: polarizers alone leave the scale and sign of S4 open");
  if (!tells_sense(references))
    throw std::invalid_argument(
        "all dial angles of the polarizer are 0 or 90 degrees apart: that leaves its sense open");
}

std::vector<Stokes> states(const Eigen::MatrixXd& columns) {
  std::vector<Stokes> result(static_cast<std::size_t>(columns.cols()));
  for (Eigen::Index s = 0; s < columns.cols(); ++s)
    for (Eigen::Index k = 0; k < 4; ++k)
      result[static_cast<std::size_t>(s)][static_cast<std::size_t>(k)] = columns(k, s);
  return result;
}

/// All matrices are wrong by one factor: A → (1 + ε) A.
void add_scale(std::vector<double>& covariance, const Eigen::MatrixXd& analyzer, Eigen::Index generator_components,
               double uncertainty) {
  const Eigen::Map<const Eigen::VectorXd> a(analyzer.data(), analyzer.size());
  const Eigen::Index size = generator_components + analyzer.size();
  const Eigen::MatrixXd added = uncertainty * uncertainty * a * a.transpose();
  Eigen::Map<Eigen::MatrixXd>(covariance.data(), size, size).bottomRightCorner(analyzer.size(), analyzer.size()) +=
      (added + added.transpose()) / 2;
}

}  // namespace

std::string to_string(ReferenceKind kind) { return kind_names[static_cast<std::size_t>(kind)]; }

ReferenceKind reference_kind_from(const std::string& name) {
  const auto found = std::find(kind_names.begin(), kind_names.end(), name);
  if (found == kind_names.end())
    throw std::invalid_argument("reference " + in_quotes(name) + ": must be empty, polarizer, wafer or retarder");
  return static_cast<ReferenceKind>(found - kind_names.begin());
}

namespace {

void refine(Calibration& result, Unknowns& unknowns, std::span<const Reference> references,
            const CalibrationOptions& options) {
  calibration::Refinement refinement = calibration::refine(unknowns, references, options);
  result.covariance = std::move(refinement.covariance);
  result.scale_uncertainty = calibration::scale_uncertainty(unknowns, references);
  add_scale(result.covariance, unknowns.analyzer, unknowns.generator.size(), result.scale_uncertainty);
  result.chi_squared = refinement.chi_squared;
  if (!std::isfinite(refinement.chi_squared) ||
      !std::all_of(result.covariance.begin(), result.covariance.end(), [](double c) { return std::isfinite(c); }))
    throw std::invalid_argument("the refinement leaves no finite numbers: are readings and noise of one scale?");
}

}  // namespace

Calibration calibrate(std::span<const Reference> references, const CalibrationOptions& options) {
  require_valid(options);
  for (std::size_t i = 0; i < references.size(); ++i) require_valid(references[i], i + 1, options);
  if (options.retarders) return calibration::calibrate_retarders(references, options);
  require_enough(references);
  const long freedom = calibration::degrees_of_freedom(references, options);
  if (options.refine && freedom < 1)
    throw std::invalid_argument("fewer readings than unknowns: add references, or do without the refinement");
  Unknowns unknowns = calibration::solve_linear(references, options);
  if (std::none_of(references.begin(), references.end(),
                   [](const Reference& r) { return r.kind == ReferenceKind::wafer; }))
    calibration::give_orientation(unknowns, options);
  Calibration result;
  result.wavelength = options.wavelength;
  result.degrees_of_freedom = std::max(freedom, 0L);
  if (options.refine) refine(result, unknowns, references, options);
  result.polarimeter = {states(unknowns.generator), states(unknowns.analyzer)};
  calibration::set_polarizer(result, unknowns);
  result.singular_ratio = unknowns.singular_ratio;
  result.identifiability = unknowns.identifiability;
  result.generator_condition = condition_number(result.polarimeter.generator);
  result.analyzer_condition = condition_number(result.polarimeter.analyzer);
  for (const auto& [arm, condition] :
       {std::pair("generator", result.generator_condition), {"analyzer", result.analyzer_condition}})
    if (!(condition <= worst_condition))
      throw std::invalid_argument(std::string("the condition number of the ") + arm + " is " +
                                  shortest(std::round(10 * condition) / 10) + ", more than " +
                                  shortest(worst_condition) +
                                  ": its states are nearly dependent, or the references do not determine them");
  const Reduction reduction(result.polarimeter);
  for (std::size_t i = 0; i < references.size(); ++i)
    result.references.push_back(
        calibration::fitted(unknowns, references, i, reduction.mueller(references[i].readings), options));
  const auto readings = static_cast<double>(references.size() * result.polarimeter.readings());
  const double correction = freedom > 0 ? std::sqrt(readings / static_cast<double>(freedom)) : 0;
  result.figure_of_merit = calibration::figure_of_merit(result.references, correction);
  calibration::require_signs(result, references, options);
  return result;
}

Polarimeter with_signs(const Polarimeter& polarimeter, int s2, int s3, int s4) {
  Polarimeter result = polarimeter;
  for (std::vector<Stokes>* arm : {&result.generator, &result.analyzer})
    for (Stokes& state : *arm) state = diagonal(1, s2, s3, s4) * state;
  return result;
}

}  // namespace mmbrdf
