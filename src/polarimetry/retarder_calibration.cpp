// SPDX-License-Identifier: BSD-3-Clause
#include "polarimetry/retarder_calibration.hpp"

// Readings b_ij = g_i (1 + d_i x_j) a_j · M_i w_j, with x_j the place of a frame in time. First the empty references alone
// from the nominal numbers, or from other starts where that ends in no fit; then all references together.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "mmbrdf/polarimetry/reduction.hpp"
#include "polarimetry/calibration_quality.hpp"
#include "polarimetry/retarder_problem.hpp"
#include "polarimetry/wafer_signs.hpp"
#include "text/numbers.hpp"

namespace mmbrdf::calibration {
namespace {

using Eigen::Index;
using Eigen::Map;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double poor_fit = 0.02;  // rms of the residuals over that of the readings: another valley

double relative_misfit(const RetarderState& x, const RetarderProblem& problem) {
  const VectorXd readings = measured(problem);
  return (readings - predicted(x, problem)).norm() / readings.norm();
}

RetarderState start(const RotatingRetarders& nominal, const RetarderProblem& problem) {
  RetarderState x{nominal, {}, std::vector<double>(problem.references.size())};
  x.references.gains.assign(problem.references.size(), 1);
  x.references.elements.resize(problem.references.size());
  x.references.leak_real = std::sqrt(problem.options.extinction);
  return x;
}

/// The empty references alone, from one start. Gains of single measurements are in the means.
RetarderState fitted_to_air(const RotatingRetarders& nominal, const RetarderProblem& problem) {
  RetarderState x = start(nominal, problem);
  const VectorXd readings = measured(problem), model = predicted(x, problem);
  x.instrument.responsivity *= readings.sum() / model.sum();
  const Index frames = index(problem.dials.size());
  for (std::size_t i = 0; i < problem.references.size(); ++i)
    x.references.gains[i] = readings.segment(index(i) * frames, frames).mean() / readings.mean();
  minimise(x, problem);
  return x;
}

/// How far the azimuths are from the nominal ones: of solutions that explain air alike the nearest is taken.
double distance(const RotatingRetarders& found, const RotatingRetarders& nominal) {
  const auto a = parameters(found), b = parameters(nominal);
  double sum = 0;
  for (const std::size_t k : {1U, 5U, 6U}) sum += std::pow(std::remainder(a[k] - b[k], std::numbers::pi), 2);
  return std::sqrt(sum);
}

/// The other axis of a retarder: the same element for the opposite retardance, and one that air does not tell from it if
/// both arms do so.
void exchange_axes(RetarderArm& arm) {
  arm.offset += std::numbers::pi / 2;
  arm.diattenuation = -arm.diattenuation;
}

/// Retardances of the sign of the nominal ones, azimuths within 90 degrees of them.
void tidy(RotatingRetarders& found, const RotatingRetarders& nominal) {
  constexpr double turn = 2 * std::numbers::pi;
  for (const auto& [arm, given] :
       {std::pair(&found.generator, &nominal.generator), {&found.analyzer, &nominal.analyzer}}) {
    if (std::remainder(arm->retardance, turn) * std::remainder(given->retardance, turn) < 0) {
      arm->retardance = -arm->retardance;
      exchange_axes(*arm);
    }
    arm->retardance = given->retardance + std::remainder(arm->retardance - given->retardance, turn);
  }
  const auto values = parameters(found);
  const auto given = parameters(nominal);
  for (const std::size_t k : {1U, 2U, 5U, 6U})
    *values[k] = given[k] + std::remainder(*values[k] - given[k], std::numbers::pi);
}

RetarderState instrument_in_air(const RetarderProblem& problem) {
  const RotatingRetarders& nominal = problem.options.retarders->nominal;
  RetarderState best = fitted_to_air(nominal, problem);
  double least = relative_misfit(best, problem);
  for (const double first : {-60., -30., 0., 30., 60.})
    for (const double second : {-60., -30., 0., 30., 60.})
      for (const double polarizer : {-45., 0., 45., 90.}) {
        if (least <= poor_fit) break;
        RotatingRetarders other = nominal;
        other.generator.offset += radians(first);
        other.analyzer.offset += radians(second);
        other.analyzer.polarizer += radians(polarizer);
        RetarderState x = fitted_to_air(other, problem);
        const double misfit = relative_misfit(x, problem);
        if (!(misfit < least)) continue;
        best = std::move(x);
        least = misfit;
      }
  return best;
}

/// All empty references in one, their gains taken out.
Reference mean_of(std::span<const Reference> empty) {
  Reference result = empty.front();
  VectorXd shape = VectorXd::Zero(index(result.readings.size()));
  double sum = 0;
  for (const Reference& reference : empty) {
    const Map<const VectorXd> readings(reference.readings.data(), shape.size());
    shape += readings / readings.sum();
    sum += readings.sum();
  }
  const double count = static_cast<double>(empty.size());
  for (Index j = 0; j < shape.size(); ++j)
    result.readings[static_cast<std::size_t>(j)] = sum / count * shape(j) / count;
  return result;
}

/// The empty references, with the azimuths that are nearest to the nominal ones.
RetarderState fitted_to_empty(const RetarderProblem& problem) {
  const RotatingRetarders& nominal = problem.options.retarders->nominal;
  const RetarderProblem mean({mean_of(problem.references)}, problem.options);
  RetarderState x = fitted_to_air(instrument_in_air(mean).instrument, problem);
  tidy(x.instrument, nominal);
  RotatingRetarders twin = x.instrument;
  exchange_axes(twin.generator);
  exchange_axes(twin.analyzer);
  tidy(twin, nominal);
  if (distance(twin, nominal) < distance(x.instrument, nominal)) x.instrument = twin;
  return x;
}

/// The instrument in other axes: fast axes for slow ones, which air does not tell, and turned by 90 degrees.
RotatingRetarders other(RotatingRetarders instrument, bool exchanged, bool turned) {
  for (RetarderArm* arm : {&instrument.generator, &instrument.analyzer}) {
    if (exchanged) exchange_axes(*arm);
    arm->offset += turned ? std::numbers::pi / 2 : 0;
    arm->polarizer += turned ? std::numbers::pi / 2 : 0;
  }
  return instrument;
}

/// From what the instrument makes of the readings of each reference.
RetarderState with_references(const RetarderState& air, const RetarderProblem& problem) {
  RetarderState x = start(air.instrument, problem);
  const Reduction reduction(polarimeter(air.instrument, problem.dials));
  std::size_t empty = 0;
  bool polarizers = false;
  for (std::size_t i = 0; i < problem.references.size(); ++i) {
    const Reference& reference = problem.references[i];
    if (reference.kind == ReferenceKind::empty) {
      x.drifts[i] = air.drifts[empty];
      x.references.gains[i] = air.references.gains[empty++];
      continue;
    }
    const Mueller m = reduction.mueller(reference.readings);
    if (const Elements unknown = unknown_elements(m); unknown.any())
      throw std::invalid_argument("the frames do not determine " + element_names(unknown) +
                                  ", which a reference other than the empty one needs");
    if (!(m(0, 0) > 0)) throw std::invalid_argument("reference " + std::to_string(i + 1) + ": lets no light pass");
    if (reference.kind == ReferenceKind::polarizer) {
      x.references.gains[i] = 2 * m(0, 0);
      if (!polarizers)
        x.references.offset = std::atan2(m(0, 2), m(0, 1)) / 2 - problem.options.dial_sense * reference.angle;
      polarizers = true;
      continue;
    }
    x.references.elements[i] = element_of(normalized(rotated(m, -azimuth_of(reference))));
    x.references.elements[i].tau = m(0, 0);
  }
  return x;
}

void require_usable(std::span<const Reference> references, const CalibrationOptions& options) {
  const std::size_t frames = options.retarders->dials.size();
  if (frames < 1 || frames > most_states)
    throw std::invalid_argument(std::to_string(frames) + " frames, must be 1 to " + std::to_string(most_states));
  bool empty = false;
  for (std::size_t i = 0; i < references.size(); ++i) {
    if (references[i].readings.size() != frames)
      throw std::invalid_argument("reference " + std::to_string(i + 1) + ": " +
                                  std::to_string(references[i].readings.size()) + " readings, expected " +
                                  std::to_string(frames));
    empty = empty || references[i].kind == ReferenceKind::empty;
    if (references[i].kind == ReferenceKind::empty &&
        !(Map<const VectorXd>(references[i].readings.data(), index(frames)).sum() > 0))
      throw std::invalid_argument("reference " + std::to_string(i + 1) +
                                  ": the readings of the empty beam are not positive");
  }
  if (!empty) throw std::invalid_argument("no empty reference: the arms aligned, nothing between");
}

/// The number whose columns of the Jacobian others nearly make up, if there is one.
void require_identifiable(const dense::Svd& svd, const RetarderProblem& problem, double identifiability) {
  if (!std::isfinite(identifiability))
    throw std::invalid_argument("the refinement leaves no finite numbers: are readings and noise of one scale?");
  if (identifiability > least_identifiability) return;
  Index worst = 0;
  svd.v.col(svd.v.cols() - 1).head(index(problem.free.size())).cwiseAbs().maxCoeff(&worst);
  throw std::invalid_argument(
      "the references leave the " + parameter_name(problem.free[static_cast<std::size_t>(worst)]) +
      " open: the smallest singular value of what they determine is " + rounded(identifiability, 2) +
      " of the largest, must be above " + shortest(least_identifiability) + "; add frames or references");
}

std::vector<double> instrument_covariance(const MatrixXd& half, const RetarderProblem& problem, double variance) {
  std::vector<double> result(retarder_parameters * retarder_parameters);
  Map<RowMajor> all(result.data(), index(retarder_parameters), index(retarder_parameters));
  all.setZero();
  const MatrixXd fitted = variance * half * half.transpose();
  for (std::size_t k = 0; k < problem.free.size(); ++k)
    for (std::size_t l = 0; l < problem.free.size(); ++l)
      all(index(problem.free[k]), index(problem.free[l])) =
          (fitted(index(k), index(l)) + fitted(index(l), index(k))) / 2;
  return result;
}

/// Of slopes whose columns have unit length; the row that holds the gains no longer outweighs the readings.
dense::Svd unit_svd(MatrixXd jacobian) {
  jacobian.bottomRows(1) /= firmness;
  const VectorXd scales = jacobian.colwise().norm().transpose().cwiseMax(1e-300);
  return dense::right_svd(dense::triangle(jacobian * scales.cwiseInverse().asDiagonal()));
}

/// Uncertainties, identifiability and the misfit.
void judge(Calibration& result, const RetarderState& x, const RetarderProblem& problem) {
  const Linearised rows = linearised(x, problem, deviations(x, problem));
  result.chi_squared = rows.residuals.head(problem.readings()).squaredNorm();
  result.degrees_of_freedom = problem.degrees_of_freedom();
  const VectorXd scales = rows.jacobian.colwise().norm().transpose().cwiseMax(1e-300);
  const MatrixXd triangle = dense::triangle(rows.jacobian * scales.cwiseInverse().asDiagonal());
  const dense::Svd svd = unit_svd(rows.jacobian);
  result.identifiability = svd.s(problem.size - 1) / svd.s(0);
  require_identifiable(svd, problem, result.identifiability);
  const Index count = index(problem.free.size());
  const MatrixXd half =
      scales.head(count).cwiseInverse().asDiagonal() * dense::inverse_of_triangle(triangle).topRows(count);
  const double variance = result.chi_squared / static_cast<double>(result.degrees_of_freedom);
  result.retarders->covariance = instrument_covariance(half, problem, variance);
  result.scale_uncertainty = scale_uncertainty(x.references, problem.references);
  const double scale = result.scale_uncertainty * x.instrument.responsivity;
  result.retarders->covariance.back() += scale * scale;
  if (!std::isfinite(variance) ||
      !Map<const VectorXd>(result.retarders->covariance.data(), index(result.retarders->covariance.size())).allFinite())
    throw std::invalid_argument("the refinement leaves no finite numbers: are readings and noise of one scale?");
}

/// A reference as the calibrated instrument sees it, its drift taken out.
FittedReference seen(const RetarderState& x, const RetarderProblem& problem, std::size_t i,
                     const Reduction& reduction) {
  Reference steady = problem.references[i];
  for (std::size_t j = 0; j < steady.readings.size(); ++j)
    steady.readings[j] /= 1 + x.drifts[i] * problem.time(index(j));
  FittedReference result =
      fitted(x.references, problem.references, i, reduction.mueller(steady.readings), problem.options);
  result.drift = x.drifts[i];
  return result;
}

/// What the end of a fit says of the instrument.
Calibration calibration_of(const RetarderState& x, const RetarderProblem& problem) {
  Calibration result;
  result.wavelength = problem.options.wavelength;
  result.retarders = CalibratedRetarders{x.instrument, {problem.dials.begin(), problem.dials.end()}, {}};
  judge(result, x, problem);
  result.polarimeter = polarimeter(x.instrument, problem.dials);
  result.covariance = state_covariance(x.instrument, problem.dials, result.retarders->covariance);
  set_polarizer(result, x.references);
  result.generator_condition = condition_number(result.polarimeter.generator);
  result.analyzer_condition = condition_number(result.polarimeter.analyzer);
  const Reduction reduction(result.polarimeter);
  for (std::size_t i = 0; i < problem.references.size(); ++i)
    result.references.push_back(seen(x, problem, i, reduction));
  const double correction =
      std::sqrt(static_cast<double>(problem.readings()) / static_cast<double>(result.degrees_of_freedom));
  result.figure_of_merit = figure_of_merit(result.references, correction);
  return result;
}

/// The first of the instruments that explain air alike which has the signs of the references.
Calibration with_signs_of(const RetarderState& air, const RetarderProblem& problem) {
  const bool wafer = std::any_of(problem.references.begin(), problem.references.end(),
                                 [](const Reference& r) { return r.kind == ReferenceKind::wafer; });
  std::optional<std::invalid_argument> first;
  for (const bool turned : {false, true})
    for (const bool exchanged : {false, true}) {
      if (turned && !wafer) continue;  // a retarder does not tell
      RetarderState x = air;
      x.instrument = other(x.instrument, exchanged, turned);
      try {
        x = with_references(x, problem);
        minimise(x, problem);
        tidy(x.instrument, problem.options.retarders->nominal);
        Calibration result = calibration_of(x, problem);
        require_signs(result, problem.references, problem.options);
        return result;
      } catch (const std::invalid_argument& refusal) {
        if (!first) first = refusal;
      }
    }
  throw *first;
}

}  // namespace

Calibration calibrate_retarders(std::span<const Reference> references, const CalibrationOptions& options) {
  require_usable(references, options);
  std::vector<Reference> all(references.begin(), references.end()), air;
  std::copy_if(all.begin(), all.end(), std::back_inserter(air),
               [](const Reference& r) { return r.kind == ReferenceKind::empty; });
  const RetarderProblem problem(std::move(all), options), problem_in_air(std::move(air), options);
  if (problem_in_air.degrees_of_freedom() < 1)
    throw std::invalid_argument("fewer readings of the empty beam than unknowns: more frames are needed");
  const RetarderState x = fitted_to_empty(problem_in_air);
  if (problem.references.size() == problem_in_air.references.size()) return calibration_of(x, problem_in_air);
  return with_signs_of(x, problem);
}

}  // namespace mmbrdf::calibration
