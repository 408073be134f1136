// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarimetry/polarimeter.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "mmbrdf/polarization/elements.hpp"
#include "numerics/dense.hpp"
#include "numerics/eigen_index.hpp"
#include "numerics/random.hpp"
#include "polarimetry/columns.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Stokes transposed(const Mueller& m, const Stokes& row) { return transpose(m) * row; }

std::vector<double> mirrored(std::span<const double> positive, int states) {
  std::vector<double> azimuths(states % 2 == 1 ? 1 : 0);
  for (const double a : positive)
    azimuths.insert(azimuths.end(), {std::remainder(a, std::numbers::pi), -std::remainder(a, std::numbers::pi)});
  std::sort(azimuths.begin(), azimuths.end());
  return azimuths;
}

using Corner = std::pair<double, VectorXd>;  // the value of a function, and where it has it

/// The corners of a simplex with their smallest first: is it within 1e-10 of all others?
bool is_point(const std::vector<Corner>& simplex) {
  return std::all_of(simplex.begin(), simplex.end(),
                     [&](const Corner& c) { return (c.second - simplex.front().second).norm() < 1e-10; });
}

/// A move of Nelder and Mead: the worst corner reflected, further, nearer, or else all drawn to the best.
template <class F>
void move(std::vector<Corner>& simplex, const F& function) {
  const std::size_t n = simplex.size() - 1;
  VectorXd centre = VectorXd::Zero(index(n));
  for (std::size_t k = 0; k < n; ++k) centre += simplex[k].second / static_cast<double>(n);
  Corner& worst = simplex.back();
  const VectorXd away = centre - worst.second;
  const auto at = [&](double distance) {
    const VectorXd corner = centre + distance * away;
    return Corner{function(corner), corner};
  };
  const Corner moved = at(1);
  if (moved.first < simplex.front().first) {
    const Corner further = at(2);
    worst = further.first < moved.first ? further : moved;
  } else if (moved.first < simplex[n - 1].first) {
    worst = moved;
  } else if (const Corner nearer = at(moved.first < worst.first ? 0.5 : -0.5);
             nearer.first < std::min(moved.first, worst.first)) {
    worst = nearer;
  } else {
    const VectorXd best = simplex.front().second;
    for (auto& [value, corner] : simplex) {
      corner = (corner + best) / 2;
      value = function(corner);
    }
  }
}

/// Nelder and Mead: the corner of a simplex where the function is smallest, once all corners are within 1e-10 of it.
template <class F>
VectorXd smallest_of(const F& function, const VectorXd& start, double step) {
  std::vector<Corner> simplex{{function(start), start}};
  for (Index k = 0; k < start.size(); ++k) {
    VectorXd corner = start;
    corner(k) += step;
    simplex.emplace_back(function(corner), corner);
  }
  const auto sort = [&] {
    std::sort(simplex.begin(), simplex.end(), [](const Corner& a, const Corner& b) { return a.first < b.first; });
  };
  sort();
  for (int moves = 0; moves < 2000 && !is_point(simplex); ++moves) {
    move(simplex, function);
    sort();
  }
  return simplex.front().second;
}

}  // namespace

Polarimeter ideal_polarimeter(double retardance, std::span<const double> azimuths) {
  Polarimeter result;
  for (const double azimuth : azimuths) {
    const Mueller plate = retarder(retardance, azimuth);
    result.generator.push_back(plate * Stokes{1, 1, 0, 0});
    result.analyzer.push_back(transposed(plate, {0.5, 0.5, 0, 0}));
  }
  return result;
}

Stokes named_state(const std::string& name) {
  constexpr std::array<std::pair<const char*, Stokes>, 7> all{{{"s", {1, 1, 0, 0}},
                                                               {"p", {1, -1, 0, 0}},
                                                               {"+45", {1, 0, 1, 0}},
                                                               {"-45", {1, 0, -1, 0}},
                                                               {"L", {1, 0, 0, 1}},
                                                               {"R", {1, 0, 0, -1}},
                                                               {"u", {1, 0, 0, 0}}}};
  for (const auto& [known, state] : all)
    if (known == name) return state;
  throw std::invalid_argument("state " + in_quotes(name) + ": must be s, p, +45, -45, L, R or u");
}

Polarimeter ideal_polarimeter(std::span<const std::string> generator, std::span<const std::string> analyzer) {
  Polarimeter result;
  for (const std::string& name : generator) result.generator.push_back(named_state(name));
  for (const std::string& name : analyzer) {
    Stokes state = named_state(name);
    for (double& component : state) component /= 2;
    result.analyzer.push_back(state);
  }
  return result;
}

double condition_number(std::span<const Stokes> states) {
  const MatrixXd matrix = columns(states);
  if (states.size() < 4 || !matrix.allFinite()) return std::numeric_limits<double>::infinity();
  const VectorXd s = dense::singular_values(matrix);
  constexpr double least_singular = 1e-12;  // relative to the largest: below, rounding alone could have made it
  return s(3) > least_singular * s(0) ? s(0) / s(3) : std::numeric_limits<double>::infinity();
}

std::vector<double> optimal_angles(double retardance, int states) {
  if (states < 4 || states > 16) throw std::invalid_argument(std::to_string(states) + " states are not in 4...16");
  if (!std::isfinite(retardance) || std::abs(std::sin(retardance)) < 1e-6)
    throw std::invalid_argument("a retardance of " + shortest(degrees(retardance)) +
                                " degrees makes no four independent states");
  const auto condition = [&](const VectorXd& positive) {
    const std::vector<double> azimuths = mirrored({positive.data(), static_cast<std::size_t>(positive.size())}, states);
    const double value = condition_number(ideal_polarimeter(retardance, azimuths).generator);
    return std::isfinite(value) ? value : 1e300;
  };
  std::mt19937_64 engine(1);
  VectorXd best;
  double least = std::numeric_limits<double>::infinity();
  for (int start = 0; start < 40; ++start) {
    VectorXd from(states / 2);
    for (double& angle : from) angle = uniform(engine) * std::numbers::pi / 2;
    const VectorXd end = smallest_of(condition, from, 0.2);
    if (const double value = condition(end); value < least - 1e-9) {
      least = value;
      best = end;
    }
  }
  return mirrored({best.data(), static_cast<std::size_t>(best.size())}, states);
}

Polarimeter reading(const Polarimeter& polarimeter, std::vector<StatePair> pairs) {
  for (const StatePair& pair : pairs)
    if (pair.generator >= polarimeter.generator.size() || pair.analyzer >= polarimeter.analyzer.size())
      throw std::invalid_argument(to_string(pair) + ": the instrument has " +
                                  std::to_string(polarimeter.generator.size()) + " generator and " +
                                  std::to_string(polarimeter.analyzer.size()) + " analyzer states");
  return {polarimeter.generator, polarimeter.analyzer, std::move(pairs)};
}

std::string to_string(const StatePair& pair) {
  return "generator state " + std::to_string(pair.generator + 1) + ", analyzer state " +
         std::to_string(pair.analyzer + 1);
}

std::vector<double> readings(const Polarimeter& polarimeter, const Mueller& m) {
  std::vector<double> result;
  for (std::size_t j = 0; j < polarimeter.readings(); ++j) {
    const auto [p, q] = polarimeter.pair(j);
    const Stokes out = m * polarimeter.generator[p], &a = polarimeter.analyzer[q];
    result.push_back(a[0] * out[0] + a[1] * out[1] + a[2] * out[2] + a[3] * out[3]);
  }
  return result;
}

double variance(const ReadingNoise& noise, double reading) {
  const double relative = noise.relative * reading;
  return noise.dark * noise.dark + noise.shot * std::abs(reading) + relative * relative;
}

Sample sample(const Mueller& m, double wavelength, const Geometry& geometry, double solid_angle) {
  require_valid(geometry);
  if (!(solid_angle > 0 && solid_angle <= 2 * std::numbers::pi))
    throw std::invalid_argument("a solid angle of " + shortest(solid_angle) + " sr, must be above 0 and at most 2 pi");
  if (!(m(0, 0) > 0)) throw std::invalid_argument("M11 = " + shortest(m(0, 0)) + ", must be positive");
  const double cosine = std::cos(geometry.reflected.theta);
  if (!(cosine > 1e-9)) throw std::invalid_argument("theta_r is 90 degrees");
  return {wavelength,
          geometry,
          m(0, 0) / (solid_angle * cosine),
          change_frame(normalized(m), geometry, Frame::scattering_plane, Frame::xy),
          {},
          {},
          Frame::scattering_plane};
}

}  // namespace mmbrdf
