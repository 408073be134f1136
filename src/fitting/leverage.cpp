// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/fitting/leverage.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "basis/rows.hpp"
#include "numerics/eigen_index.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A block of a fitted model, and its rows.
struct FittedRows {
  const FittedBlock& fitted;
  const Solution& solution;
  Rows rows;

  FittedRows(const FittedBlock& block, const Solution& s, Family family)
      : fitted(block), solution(s), rows(block.block.modes, family) {}

  /// Over all powers of the wavelength.
  VectorXd row(std::size_t element, const KTable& k_i, const KTable& k_r, double wavelength) const {
    VectorXd x = VectorXd::Zero(index(fitted.coefficients.size()));
    rows.add(element, k_i, k_r, x.data());
    const Index modes = index(rows.columns());
    for (Index first = modes; first < x.size(); first += modes)
      x.segment(first, modes) = wavelength * x.segment(first - modes, modes);
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
  const auto weighs = [&](std::size_t s) {
    return !std::isnan(samples[s].f11) && (weights.empty() || weights[s](0, 0) > 0);
  };
  long rows = 0;  // an accumulator does not count rows of weight 0
  for (std::size_t s = 0; s < samples.size(); ++s) rows += weighs(s) ? 1 : 0;
  if (result.elements[0].rows != rows || result.solutions.size() != result.model.blocks.size())
    throw std::invalid_argument(std::to_string(samples.size()) + " samples, the model was fitted to " +
                                std::to_string(result.elements[0].rows));
  for (std::size_t b = 0; b < result.solutions.size(); ++b) {
    const std::size_t size = result.model.blocks[b].coefficients.size();
    if (result.solutions[b].inverse.size() != size * size)
      throw std::invalid_argument("block " + result.model.blocks[b].block.name + ": the solution has no inverse of " +
                                  std::to_string(size) + " coefficients");
  }
}

/// Fills in the residuals of the block's elements, and returns the leverage of the sample.
double leverage_and_residuals(const FittedRows& block, const Model& model, const Sample& sample, const Mueller& weights,
                              const KTable& k_i, const KTable& k_r, Mueller& residuals) {
  const Index n = index(block.fitted.coefficients.size());
  const Eigen::Map<const MatrixXd> inverse(block.solution.inverse.data(), n, n);
  const Eigen::Map<const VectorXd> a(block.fitted.coefficients.data(), n);
  double sum = 0;
  for (const Element& element : block.fitted.block.elements) {
    const std::size_t e = element.index();
    const VectorXd x = block.row(e, k_i, k_r, sample.wavelength);
    const double leverage = weights.elements[e] * x.dot(inverse * x);
    if (not_measured(sample)[e]) {
      residuals.elements[e] = std::numeric_limits<double>::quiet_NaN();
      continue;
    }
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
  Mueller unknown;  // until a block tells
  unknown.elements.fill(std::numeric_limits<double>::quiet_NaN());
  diagnostics.studentized.resize(samples.size(), unknown);
  std::vector<FittedRows> blocks;
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    blocks.emplace_back(model.blocks[b], result.solutions[b], model.family);
    diagnostics.leverage.push_back({model.blocks[b].block.name, result.solutions[b].rank, {}, 0});
  }
  Mueller ones;
  ones.elements.fill(1);
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const Sample sample = turns(model) ? at_zero_azimuth(samples[s]) : samples[s];
    const KTable k_i = functions_at(sample.geometry.incident, order, model.mapping),
                 k_r = functions_at(sample.geometry.reflected, order, model.mapping);
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

}  // namespace mmbrdf
