// SPDX-License-Identifier: BSD-3-Clause
#include "polarimetry/retarder_problem.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mmbrdf::calibration {

using Eigen::Index;
using Eigen::Map;
using Eigen::MatrixXd;
using Eigen::Vector4d;
using Eigen::VectorXd;

RetarderProblem::RetarderProblem(std::vector<Reference> some, const CalibrationOptions& given)
    : references(std::move(some)), options(given), dials(given.retarders->dials) {
  const auto has = [&](ReferenceKind kind) {
    return std::any_of(references.begin(), references.end(), [&](const Reference& r) { return r.kind == kind; });
  };
  free = {0, 1, 4, 5, 6, 9};
  if (has(ReferenceKind::wafer) || has(ReferenceKind::retarder)) free.push_back(2);
  if (options.retarders->fit_diattenuation) free.insert(free.end(), {3, 7});
  if (options.retarders->fit_extinction) free.push_back(8);
  size = index(free.size());
  if (has(ReferenceKind::polarizer)) {
    polarizer = {size, size + 1, options.fit_polarizer_phase ? size + 2 : -1};
    size += options.fit_polarizer_phase ? 3 : 2;
  }
  for (const Reference& reference : references) {
    first.push_back(size);
    size += unknowns_of(reference.kind) + (options.retarders->fit_drift ? 1 : 0);
  }
}

namespace {

void take_step(RetarderState& x, const RetarderProblem& problem, const VectorXd& step) {
  const auto places = parameters(x.instrument);
  for (std::size_t k = 0; k < problem.free.size(); ++k) *places[problem.free[k]] += step(index(k));
  double& extinction = x.instrument.extinction;
  extinction = std::clamp(extinction, 0., 1.);
  for (RetarderArm* arm : {&x.instrument.generator, &x.instrument.analyzer})
    arm->diattenuation = std::clamp(arm->diattenuation, -0.999, 0.999);
  move_references(x.references, problem.references, step, problem.first, problem.polarizer);
  for (std::size_t i = 0; i < x.drifts.size() && problem.options.retarders->fit_drift; ++i)
    x.drifts[i] += step(problem.first[i] + unknowns_of(problem.references[i].kind));
}

}  // namespace

VectorXd predicted(const RetarderState& x, const RetarderProblem& problem, MatrixXd* jacobian) {
  const Polarimeter p = polarimeter(x.instrument, problem.dials);
  const std::vector<double> all = slopes(x.instrument, problem.dials);
  const Index frames = index(problem.dials.size()), parameters = index(retarder_parameters);
  const Map<const RowMajor> slope(all.data(), 8 * frames, parameters);
  VectorXd result(problem.readings());
  for (std::size_t i = 0; i < problem.references.size(); ++i) {
    const auto [m, derivatives] =
        reference_slopes(x.references, problem.references, i, problem.options, problem.first[i], problem.polarizer);
    for (Index j = 0; j < frames; ++j) {
      const auto s = static_cast<std::size_t>(j);
      const Map<const Vector4d> w(p.generator[s].data()), a(p.analyzer[s].data());
      const double drifted = 1 + x.drifts[i] * problem.time(j), value = a.dot(m * w);
      const Index row = index(i) * frames + j;
      result(row) = drifted * value;
      if (!jacobian) continue;
      const VectorXd of_instrument = slope.middleRows<4>(4 * j).transpose() * (m.transpose() * a) +
                                     slope.middleRows<4>(4 * (frames + j)).transpose() * (m * w);
      for (std::size_t k = 0; k < problem.free.size(); ++k)
        (*jacobian)(row, index(k)) = drifted * of_instrument(index(problem.free[k]));
      for (const auto& [place, d] : derivatives) (*jacobian)(row, place) = drifted * a.dot(d * w);
      if (problem.options.retarders->fit_drift)
        (*jacobian)(row, problem.first[i] + unknowns_of(problem.references[i].kind)) = problem.time(j) * value;
    }
  }
  return result;
}

VectorXd measured(const RetarderProblem& problem) {
  VectorXd result(problem.readings());
  Index next = 0;
  for (const Reference& reference : problem.references)
    for (const double reading : reference.readings) result(next++) = reading;
  return result;
}

Linearised linearised(const RetarderState& x, const RetarderProblem& problem, const VectorXd& sigma) {
  Linearised rows{MatrixXd::Zero(problem.readings() + 1, problem.size), VectorXd::Zero(problem.readings() + 1)};
  rows.residuals.head(problem.readings()) =
      (measured(problem) - predicted(x, problem, &rows.jacobian)).cwiseQuotient(sigma);
  rows.jacobian.topRows(problem.readings()) =
      sigma.cwiseInverse().asDiagonal() * rows.jacobian.topRows(problem.readings());
  const double firm = firmness * rows.jacobian.colwise().norm().maxCoeff();
  for (std::size_t i = 0; i < problem.references.size(); ++i) {
    if (problem.references[i].kind != ReferenceKind::empty) continue;
    rows.jacobian(problem.readings(), problem.first[i]) = firm;
    rows.residuals(problem.readings()) += firm * (1 - x.references.gains[i]);
  }
  return rows;
}

VectorXd deviations(const RetarderState& x, const RetarderProblem& problem) {
  VectorXd result = predicted(x, problem);
  const double largest = result.cwiseAbs().maxCoeff();
  for (double& value : result) value = std::sqrt(variance(problem.options.noise, value));
  return result.cwiseMax(least_sigma * largest);
}

void minimise(RetarderState& x, const RetarderProblem& problem) {
  for (int pass = 0; pass < 3; ++pass) {  // the weights follow what is predicted
    const VectorXd sigma = deviations(x, problem);
    levenberg_marquardt(
        x, [&](const RetarderState& at) { return linearised(at, problem, sigma); },
        [&](RetarderState& at, const VectorXd& step) { take_step(at, problem, step); });
  }
}

}  // namespace mmbrdf::calibration
