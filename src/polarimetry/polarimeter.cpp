// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarimetry/polarimeter.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "mmbrdf/polarization/elements.hpp"
#include "numerics/dense.hpp"
#include "numerics/eigen_index.hpp"
#include "numerics/random.hpp"
#include "numerics/semidefinite.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::Matrix4d;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double least_singular = 1e-12;  // relative to the largest: below, rounding alone could have made it

/// 4 × states, a state in each column.
MatrixXd columns(std::span<const Stokes> states) {
  MatrixXd result(4, index(states.size()));
  for (std::size_t s = 0; s < states.size(); ++s)
    result.col(index(s)) = Eigen::Map<const Eigen::Vector4d>(states[s].data());
  return result;
}

/// Whether rows of a 4 × states matrix with these singular values are independent.
bool has_rank_four(const VectorXd& singular_values) { return singular_values(3) > least_singular * singular_values(0); }

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

double condition_number(std::span<const Stokes> states) {
  const MatrixXd matrix = columns(states);
  if (states.size() < 4 || !matrix.allFinite()) return std::numeric_limits<double>::infinity();
  const VectorXd s = dense::singular_values(matrix);
  return has_rank_four(s) ? s(0) / s(3) : std::numeric_limits<double>::infinity();
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

std::vector<double> readings(const Polarimeter& polarimeter, const Mueller& m) {
  std::vector<double> result;
  for (const Stokes& a : polarimeter.analyzer)
    for (const Stokes& w : polarimeter.generator) {
      const Stokes out = m * w;
      result.push_back(a[0] * out[0] + a[1] * out[1] + a[2] * out[2] + a[3] * out[3]);
    }
  return result;
}

double variance(const ReadingNoise& noise, double reading) {
  const double relative = noise.relative * reading;
  return noise.dark * noise.dark + noise.shot * std::abs(reading) + relative * relative;
}

struct Reduction::Inverses {
  MatrixXd generator;   ///< W⁺, states × 4
  MatrixXd analyzer;    ///< A⁺, 4 × states
  MatrixXd covariance;  ///< of the instrument; 0 × 0: none
  MatrixXd errors;      ///< its square root: an independent error in each column
};

namespace {

/// Of a 4 × states matrix.
MatrixXd pseudo_inverse(const MatrixXd& states, const char* of) {
  const auto refusal = [&](const std::string& what) { return std::invalid_argument(of + (": " + what)); };
  if (states.cols() > index(most_states))
    throw refusal(std::to_string(states.cols()) + " states, at most " + std::to_string(most_states) + " can be used");
  const std::string too_few = std::to_string(states.cols()) + " states, not four independent ones";
  if (!states.allFinite()) throw refusal("a state is not finite");
  if (states.cols() < 4) throw refusal(too_few);
  const auto [u, v, s] = dense::thin_svd(states);
  if (!has_rank_four(s)) throw refusal(too_few);
  return v * s.cwiseInverse().asDiagonal() * u.transpose();
}

MuellerCovariance covariance_of(const MatrixXd& matrix) {
  MuellerCovariance result;
  Eigen::Map<RowMajor>(result.values.data(), 16, 16) = (matrix + matrix.transpose()) / 2;
  return result;
}

}  // namespace

Reduction::Reduction(const Polarimeter& polarimeter, std::span<const double> covariance) {
  auto inverses = std::make_shared<Inverses>();
  inverses->generator = pseudo_inverse(columns(polarimeter.generator), "generator");
  inverses->analyzer = pseudo_inverse(columns(polarimeter.analyzer), "analyzer").transpose();
  const Index size = 4 * index(polarimeter.generator.size() + polarimeter.analyzer.size());
  if (!covariance.empty()) {
    if (index(covariance.size()) != size * size)
      throw std::invalid_argument("the covariance of the instrument has " + std::to_string(covariance.size()) +
                                  " numbers, expected " + std::to_string(size * size));
    inverses->covariance = Eigen::Map<const MatrixXd>(covariance.data(), size, size);
    if (!inverses->covariance.allFinite() || inverses->covariance != inverses->covariance.transpose())
      throw std::invalid_argument("the covariance of the instrument is not symmetric and finite");
    const auto [vectors, values] = dense::eigensystem(inverses->covariance);
    require_semidefinite(values, "the instrument", covariance_tolerance);
    const Index none = (values.array() <= 1e-14 * values(size - 1)).count();
    inverses->errors = vectors.rightCols(size - none) * values.tail(size - none).cwiseSqrt().asDiagonal();
  }
  inverses_ = std::move(inverses);
}

Mueller Reduction::mueller(std::span<const double> readings) const {
  const Index analyzers = inverses_->analyzer.cols(), generators = inverses_->generator.rows();
  if (index(readings.size()) != analyzers * generators)
    throw std::invalid_argument(std::to_string(readings.size()) + " readings, the instrument has " +
                                std::to_string(analyzers * generators));
  const Eigen::Map<const RowMajor> b(readings.data(), analyzers, generators);
  if (!b.allFinite()) throw std::invalid_argument("a reading is not finite");
  Mueller m;
  Eigen::Map<RowMajor>(m.elements.data(), 4, 4) = inverses_->analyzer * b * inverses_->generator;
  return m;
}

MuellerCovariance Reduction::from_readings(std::span<const double> variances) const {
  const Index analyzers = inverses_->analyzer.cols(), generators = inverses_->generator.rows();
  if (index(variances.size()) != analyzers * generators)
    throw std::invalid_argument(std::to_string(variances.size()) + " variances, the instrument has " +
                                std::to_string(analyzers * generators) + " readings");
  MatrixXd sum = MatrixXd::Zero(16, 16);
  for (Index q = 0; q < analyzers; ++q)
    for (Index p = 0; p < generators; ++p) {
      const double variance = variances[static_cast<std::size_t>(q * generators + p)];
      if (!(variance >= 0) || !std::isfinite(variance))
        throw std::invalid_argument("variance " + shortest(variance) + ", must be finite and not negative");
      VectorXd slope(16);
      for (Index e = 0; e < 16; ++e) slope(e) = inverses_->analyzer(e / 4, q) * inverses_->generator(p, e % 4);
      sum += variance * slope * slope.transpose();
    }
  return covariance_of(sum);
}

std::vector<double> Reduction::slopes(const Mueller& m) const {
  const Index analyzers = inverses_->analyzer.cols(), generators = inverses_->generator.rows();
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> matrix(m.elements.data());
  std::vector<double> result(static_cast<std::size_t>(16 * 4 * (analyzers + generators)));
  Eigen::Map<RowMajor> at(result.data(), 16, 4 * (analyzers + generators));
  for (Index e = 0; e < 16; ++e)
    for (Index k = 0; k < 4; ++k) {
      for (Index p = 0; p < generators; ++p) at(e, 4 * p + k) = -matrix(e / 4, k) * inverses_->generator(p, e % 4);
      for (Index q = 0; q < analyzers; ++q)
        at(e, 4 * (generators + q) + k) = -inverses_->analyzer(e / 4, q) * matrix(k, e % 4);
    }
  return result;
}

MuellerCovariance Reduction::from_instrument(const Mueller& m) const {
  if (inverses_->covariance.size() == 0) return {};
  const std::vector<double> slope = slopes(m);
  const Eigen::Map<const RowMajor> at(slope.data(), 16, inverses_->covariance.rows());
  return covariance_of(at * inverses_->covariance * at.transpose());
}

std::vector<Mueller> Reduction::errors(const Mueller& m) const {
  std::vector<Mueller> result(static_cast<std::size_t>(inverses_->errors.cols()));
  if (result.empty()) return result;
  const std::vector<double> slope = slopes(m);
  const MatrixXd all = Eigen::Map<const RowMajor>(slope.data(), 16, inverses_->errors.rows()) * inverses_->errors;
  for (std::size_t k = 0; k < result.size(); ++k)
    Eigen::Map<Eigen::Matrix<double, 16, 1>>(result[k].elements.data()) = all.col(index(k));
  return result;
}

Sample sample(const Mueller& m, double wavelength, const Geometry& geometry, double solid_angle) {
  require_valid(geometry);
  if (!(solid_angle > 0 && solid_angle <= 2 * std::numbers::pi))
    throw std::invalid_argument("a solid angle of " + shortest(solid_angle) + " sr, must be above 0 and at most 2 pi");
  if (!(m(0, 0) > 0)) throw std::invalid_argument("M11 = " + shortest(m(0, 0)) + ", must be positive");
  const double cosine = std::cos(geometry.reflected.theta);
  if (!(cosine > 1e-9)) throw std::invalid_argument("theta_r is 90 degrees");
  return {wavelength, geometry, m(0, 0) / (solid_angle * cosine),
          change_frame(normalized(m), geometry, Frame::scattering_plane, Frame::xy)};
}

}  // namespace mmbrdf
