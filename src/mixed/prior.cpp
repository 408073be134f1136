// SPDX-License-Identifier: BSD-3-Clause
#include "mixed/prior.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mmbrdf/mixed/posterior.hpp"

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

struct Hyperprior {
  const char* name;
  double mean, deviation;
};
enum Position : Index { iso, slope, harmonic, free_slope = harmonic + highest_harmonic, odd, last };
constexpr std::array<Hyperprior, last> common = {{{"iso", -10, 3},
                                                  {"slope", 3, 1},
                                                  {"q1", -13, 2},
                                                  {"q2", -13, 2},
                                                  {"q3", -13, 2},
                                                  {"free_slope", 2, 0.7},
                                                  {"odd", -13, 2}}};
constexpr Hyperprior nonreciprocal{"nonreciprocal", -13, 2}, calibration{"calibration", -13, 1.5};

constexpr int flat_order = 2;
constexpr double flat_variance = 100;
constexpr double least_logarithm = -40, largest_logarithm = 10;

std::vector<Hyperprior> hyperpriors_of(const Block& block) {
  std::vector<Hyperprior> result(common.begin(), common.end());
  result.push_back(feeds_f11(block) ? nonreciprocal : calibration);  // both are the last
  return result;
}

Index position(const FreeMode& mode) {
  if (mode.kind == FreeMode::Kind::harmonic) return harmonic + mode.harmonic - 1;
  return mode.kind == FreeMode::Kind::odd ? odd : last;
}

}  // namespace

std::vector<std::string> hyperparameter_names(const Block& block) {
  std::vector<std::string> result;
  for (const Hyperprior& one : hyperpriors_of(block)) result.emplace_back(one.name);
  return result;
}

VectorXd Prior::variances(const VectorXd& hyperparameters) const {
  return (constant + design * hyperparameters)
      .cwiseMax(least_logarithm)
      .cwiseMin(largest_logarithm)
      .array()
      .exp()
      .matrix();
}

Prior prior_of(const MixedColumns& columns) {
  const std::vector<Hyperprior> list = hyperpriors_of(columns.isotropic());
  const auto count = static_cast<Index>(list.size());
  Prior prior{Eigen::MatrixXd::Zero(columns.size(), count), VectorXd::Zero(columns.size()), VectorXd(count),
              VectorXd(count)};
  for (Index h = 0; h < count; ++h) {
    prior.mean(h) = list[static_cast<std::size_t>(h)].mean;
    prior.deviation(h) = list[static_cast<std::size_t>(h)].deviation;
  }
  Index j = 0;
  for (const Mode& mode : columns.isotropic().modes) {
    if (std::max(mode.n, mode.m) <= flat_order) {
      prior.constant(j) = std::log(flat_variance);
    } else {
      prior.design(j, iso) = 1;
      prior.design(j, slope) = -2 * std::log((1 + mode.n + mode.m) / 6.0);
    }
    ++j;
  }
  for (const FreeMode& mode : columns.free()) {
    prior.design(j, position(mode)) = 1;
    prior.design(j, free_slope) = -std::log1p(mode.degree * mode.degree / 9.0);
    ++j;
  }
  prior.design.bottomRows(columns.calibration_count()).col(last).setOnes();
  return prior;
}

}  // namespace mmbrdf
