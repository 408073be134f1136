// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/fitting/diagnostics.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/polarization/analysis.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"
#include "numerics/eigen_index.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Table = std::array<double, zernike_count(max_order)>;

std::size_t size(int n) { return static_cast<std::size_t>(n); }

/// Samples of a pair, the one with sin δ > 0 first.
std::vector<std::pair<std::size_t, std::size_t>> paired(std::span<const Sample> samples) {
  std::array<std::vector<double>, 5> keys;  // wavelength, θi, φi, θr, |δ|
  std::vector<double> sides;
  for (const Sample& sample : samples) {
    const auto& [i, r] = sample.geometry;
    const double delta = std::remainder(r.phi - i.phi, 2 * std::numbers::pi);
    sides.push_back(std::sin(delta) * std::sin(r.theta));
    const double phi_i = std::remainder(i.phi, 2 * std::numbers::pi);
    const bool is_minus_pi = phi_i < -std::numbers::pi + pair_tolerance;  // which is π
    const std::array values{sample.wavelength, i.theta, is_minus_pi ? phi_i + 2 * std::numbers::pi : phi_i, r.theta,
                            std::abs(delta)};
    for (std::size_t k = 0; k < 5; ++k) keys[k].push_back(values[k]);
  }
  std::array<std::vector<std::size_t>, 5> cells;
  for (std::size_t k = 0; k < 5; ++k) cells[k] = grouped(keys[k], k == 0 ? wavelength_resolution : pair_tolerance);
  std::map<std::array<std::size_t, 5>, std::array<std::vector<std::size_t>, 2>> found;
  for (std::size_t s = 0; s < samples.size(); ++s)
    if (keys[1][s] >= pair_tolerance && std::abs(sides[s]) > pair_tolerance)
      found[{cells[0][s], cells[1][s], cells[2][s], cells[3][s], cells[4][s]}][sides[s] > 0 ? 0 : 1].push_back(s);
  // Of many random values close to each other a cell has a whole range: the nearest one is the mirror image.
  const auto distance = [&](std::size_t a, std::size_t b) {
    double result = 0;
    for (std::size_t k = 1; k < 5; ++k) result = std::max(result, std::abs(keys[k][a] - keys[k][b]));
    return result;
  };
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (auto& [cell, both] : found)
    for (const std::size_t first : both[0]) {
      const auto nearest = std::ranges::min_element(both[1], {}, [&](std::size_t s) { return distance(first, s); });
      if (nearest == both[1].end() || distance(first, *nearest) > pair_tolerance) continue;
      pairs.emplace_back(first, *nearest);
      both[1].erase(nearest);
    }
  return pairs;
}

}  // namespace

MirrorPairs mirror_pairs(std::span<const Sample> samples) {
  require_valid(samples);
  MirrorPairs result;
  for (const auto& [a, b] : paired(samples)) {
    const Sample first = at_zero_azimuth(samples[a]), second = at_zero_azimuth(samples[b]);
    Mueller difference = first.normalized - mirrored(second.normalized);
    const double mean = (first.f11 + second.f11) / 2;
    difference(0, 0) = mean != 0 ? (first.f11 - second.f11) / mean : 0;
    for (std::size_t e = 0; e < 16; ++e) {
      result.rms.elements[e] += difference.elements[e] * difference.elements[e] / 2;
      result.mean.elements[e] += difference.elements[e] / 2;
    }
    ++result.pairs;
  }
  for (std::size_t e = 0; e < 16 && result.pairs > 0; ++e) {
    result.rms.elements[e] = std::sqrt(result.rms.elements[e] / static_cast<double>(result.pairs));
    result.mean.elements[e] /= static_cast<double>(result.pairs);
  }
  return result;
}

namespace {

/// A block of a fitted model, and what its rows are made of.
struct FittedRows {
  const FittedBlock& fitted;
  const Solution& solution;
  std::array<std::vector<std::pair<std::size_t, Term>>, 16> terms;  // of each element, with the mode's place

  FittedRows(const FittedBlock& block, const Solution& s, Family family) : fitted(block), solution(s) {
    for (std::size_t q = 0; q < block.block.modes.size(); ++q)
      for (const Term& term : mmbrdf::terms(block.block.modes[q], family))
        terms[size(4 * term.row + term.column)].emplace_back(q, term);
  }

  VectorXd row(std::size_t element, const Table& k_i, const Table& k_r, double wavelength, int powers) const {
    const std::size_t modes = fitted.block.modes.size();
    VectorXd x = VectorXd::Zero(index(fitted.coefficients.size()));
    for (const auto& [q, term] : terms[element])
      x(index(q)) += term.weight * k_i[size(term.incident)] * k_r[size(term.reflected)];
    for (int p = 1; p <= powers; ++p)
      x.segment(index(size(p) * modes), index(modes)) =
          wavelength * x.segment(index(size(p - 1) * modes), index(modes));
    return x;
  }
};

/// r √w / (s √(1 − h)).
double studentized(double residual, double weight, double deviation, double leverage) {
  const double left = 1 - leverage;
  return deviation > 0 && left > 1e-10 ? residual * std::sqrt(weight / left) / deviation : 0;
}

void require_matching(std::span<const Sample> samples, const FitResult& result, std::span<const Mueller> weights) {
  require_valid(samples);
  if (!weights.empty() && weights.size() != samples.size())
    throw std::invalid_argument(std::to_string(weights.size()) + " weights for " + std::to_string(samples.size()) +
                                " samples");
  const auto weighs = [&](std::size_t s) { return weights.empty() || weights[s](0, 0) > 0; };
  long rows = 0;  // an accumulator does not count rows of weight 0
  for (std::size_t s = 0; s < samples.size(); ++s) rows += weighs(s) ? 1 : 0;
  if (result.elements[0].rows != rows || result.solutions.size() != result.model.blocks.size())
    throw std::invalid_argument(std::to_string(samples.size()) + " samples, the model was fitted to " +
                                std::to_string(result.elements[0].rows));
}

/// Fills in the residuals of the block's elements, and returns the leverage of the sample.
double leverage_and_residuals(const FittedRows& block, const Model& model, const Sample& sample, const Mueller& weights,
                              const Table& k_i, const Table& k_r, Mueller& residuals) {
  const Index n = index(block.fitted.coefficients.size());
  const Eigen::Map<const MatrixXd> inverse(block.solution.inverse.data(), n, n);
  const Eigen::Map<const VectorXd> a(block.fitted.coefficients.data(), n);
  double sum = 0;
  for (const auto& [i, j] : block.fitted.block.elements) {
    const std::size_t e = size(4 * i + j);
    const VectorXd x = block.row(e, k_i, k_r, sample.wavelength, model.powers);
    const double leverage = weights.elements[e] * x.dot(inverse * x);
    const double y = e == 0 ? sample.f11 / model.reflectance.at(sample.wavelength) : sample.normalized.elements[e];
    residuals.elements[e] =
        studentized(y - x.dot(a), weights.elements[e], std::sqrt(block.solution.variance()), leverage);
    sum += leverage;
  }
  return sum;
}

}  // namespace

SampleDiagnostics sample_diagnostics(std::span<const Sample> samples, const FitResult& result,
                                     std::span<const Mueller> weights) {
  require_matching(samples, result, weights);
  const Model& model = result.model;
  const int order = std::max(orders(model).f11, orders(model).other);
  SampleDiagnostics diagnostics;
  diagnostics.studentized.resize(samples.size());
  std::vector<FittedRows> blocks;
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    blocks.emplace_back(model.blocks[b], result.solutions[b], model.family);
    diagnostics.leverage.push_back({model.blocks[b].block.name, result.solutions[b].rank, {}, 0});
  }
  Mueller ones;
  ones.elements.fill(1);
  Table k_i, k_r;
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const Sample sample = turns(model) ? at_zero_azimuth(samples[s]) : samples[s];
    zernike_table(order, disc_point(sample.geometry.incident, model.mapping), k_i.data());
    zernike_table(order, disc_point(sample.geometry.reflected, model.mapping), k_r.data());
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      SampleDiagnostics::Leverage& of_block = diagnostics.leverage[b];
      of_block.values.push_back(leverage_and_residuals(blocks[b], model, sample, weights.empty() ? ones : weights[s],
                                                       k_i, k_r, diagnostics.studentized[s]));
      if (of_block.values[s] > of_block.values[of_block.largest]) of_block.largest = s;
    }
  }
  return diagnostics;
}

std::vector<Outlier> outliers(const SampleDiagnostics& diagnostics, double threshold) {
  if (!(threshold >= 0)) throw std::invalid_argument("threshold " + shortest(threshold) + " is negative");
  std::vector<Outlier> result;
  for (std::size_t s = 0; s < diagnostics.studentized.size(); ++s)
    for (std::size_t e = 0; e < 16; ++e)
      if (const double t = diagnostics.studentized[s].elements[e]; std::abs(t) > threshold) result.push_back({s, e, t});
  std::stable_sort(result.begin(), result.end(), [](const Outlier& a, const Outlier& b) {
    return std::abs(a.studentized) > std::abs(b.studentized);
  });
  return result;
}

namespace {

void take_in(ModelDiagnostics& result, const Geometry& geometry, const PreparedModel& prepared) {
  const Mueller f = prepared.evaluate(geometry);
  ++result.geometries;
  if (!(f(0, 0) > 0)) ++result.not_positive_f11;
  if (f(0, 0) < result.f11.value) result.f11 = {f(0, 0), geometry};
  if (f(0, 0) == 0) return;
  const double margin = realizability_margin(normalized(f));
  if (margin < 0) ++result.unrealizable;
  if (margin < result.margin.value) result.margin = {margin, geometry};
}

}  // namespace

ModelDiagnostics model_diagnostics(const Model& model, double wavelength, double theta_max) {
  if (!(theta_max >= 0 && theta_max <= radians(90) * (1 + 1e-12)))
    throw std::invalid_argument("largest polar angle " + shortest(degrees(theta_max)) + " degrees is not in [0, 90]");
  const PreparedModel prepared = prepare(model, wavelength);
  ModelDiagnostics result;
  result.wavelength = wavelength;
  result.theta_max = theta_max;
  result.margin.value = result.f11.value = std::numeric_limits<double>::max();
  const auto steps = static_cast<int>(degrees(theta_max) / 2.5 + 1e-9);
  for (int i = 0; i <= steps; ++i)
    for (int r = 0; r <= steps; ++r)
      for (int d = 0; d <= 24; ++d)
        take_in(result, {{radians(2.5 * i), 0}, {radians(2.5 * r), radians(7.5 * d)}}, prepared);
  if (result.margin.value == std::numeric_limits<double>::max()) result.margin = {};  // f11 is 0 everywhere
  for (int i = 0; i <= 5 * steps; ++i) {
    const double theta = radians(0.5 * i), dhr = directional_hemispherical_reflectance(model, wavelength, {theta, 0});
    if (i == 0 || dhr > result.dhr) {
      result.dhr = dhr;
      result.dhr_theta_i = theta;
    }
  }
  return result;
}

}  // namespace mmbrdf
