// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarimetry/rotating_retarders.hpp"

#include <Eigen/Core>
#include <cmath>
#include <stdexcept>

#include "numerics/eigen_index.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::Matrix4d;
using Eigen::Vector4d;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Matrix4d matrix(const Mueller& m) {
  return Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(m.elements.data());
}

/// d rotator(a) / da = 2 turn() rotator(a).
Matrix4d turn() {
  Matrix4d result = Matrix4d::Zero();
  result(1, 2) = 1;
  result(2, 1) = -1;
  return result;
}

/// The light of an arm, and its slopes over retardance, offset, polarizer, diattenuation and extinction.
struct ArmState {
  Vector4d state;
  Eigen::Matrix<double, 4, 5> slopes;
};

/// With c = D, S² = 1 − D² in the matrix of a diattenuator-retarder.
ArmState arm_state(const RetarderArm& arm, double extinction, double dial) {
  const double d = arm.diattenuation, s = std::sqrt(1 - d * d), azimuth = arm.offset + dial;
  const double cos_delta = std::cos(arm.retardance), sin_delta = std::sin(arm.retardance);
  const auto element = [&](double c, double first, double third, double cosine, double sine) {
    Matrix4d e = Matrix4d::Zero();
    e(0, 0) = e(1, 1) = first;
    e(0, 1) = e(1, 0) = c;
    e(2, 2) = e(3, 3) = third * cosine;
    e(3, 2) = third * sine;
    e(2, 3) = -third * sine;
    return e;
  };
  const Matrix4d in = matrix(rotator(azimuth)), out = matrix(rotator(-azimuth));
  const Matrix4d retarder = out * element(d, 1, s, cos_delta, sin_delta) * in;
  const double cosine = std::cos(2 * arm.polarizer), sine = std::sin(2 * arm.polarizer);
  const Vector4d light(1 + extinction, (1 - extinction) * cosine, (1 - extinction) * sine, 0);
  ArmState result;
  result.state = retarder * light;
  result.slopes.col(0) = out * element(0, 0, s, -sin_delta, cos_delta) * in * light;
  result.slopes.col(1) = 2 * (retarder * turn() - turn() * retarder) * light;
  result.slopes.col(2) = retarder * Vector4d(0, -2 * (1 - extinction) * sine, 2 * (1 - extinction) * cosine, 0);
  result.slopes.col(3) = out * element(1, 0, s > 0 ? -d / s : 0, cos_delta, sin_delta) * in * light;
  result.slopes.col(4) = retarder * Vector4d(1, -cosine, -sine, 0);
  return result;
}

/// What the analyzer responds to is what its mirror image would make: its retarder seen from behind.
ArmState analyzer_state(const RotatingRetarders& r, double dial) {
  RetarderArm seen = r.analyzer;
  seen.retardance = -seen.retardance;
  ArmState result = arm_state(seen, r.extinction, dial);
  result.slopes.col(0) = -result.slopes.col(0);
  result.slopes *= r.responsivity / 2;
  result.state /= 2;  // without the responsivity: its own slope
  return result;
}

void require_valid(const RotatingRetarders& r) {
  for (const double value : parameters(r))
    if (!std::isfinite(value)) throw std::invalid_argument("a number of the rotating retarders is not finite");
  for (const RetarderArm& arm : {r.generator, r.analyzer})
    if (!(std::abs(arm.diattenuation) <= 1))
      throw std::invalid_argument("a diattenuation of " + shortest(arm.diattenuation) + ", must be within -1 ... 1");
  if (!(r.extinction >= 0 && r.extinction <= 1))
    throw std::invalid_argument("extinction " + shortest(r.extinction) + " is not in [0, 1]");
}

Stokes stokes(const Vector4d& v) { return {v[0], v[1], v[2], v[3]}; }

}  // namespace

std::vector<DialAngles> dial_angles(double ratio, double step, std::size_t frames) {
  if (!std::isfinite(ratio) || ratio == 0) throw std::invalid_argument("a ratio of " + shortest(ratio));
  if (!std::isfinite(step) || step == 0)
    throw std::invalid_argument("steps of " + shortest(degrees(step)) + " degrees");
  if (frames < 1 || frames > most_states)
    throw std::invalid_argument(std::to_string(frames) + " frames, must be 1 to " + std::to_string(most_states));
  std::vector<DialAngles> result;
  for (std::size_t j = 0; j < frames; ++j) {
    const double angle = static_cast<double>(j) * step;
    result.push_back({angle, ratio * angle});
    if (!std::isfinite(ratio * angle)) throw std::invalid_argument("a step and a ratio that leave no finite angles");
  }
  return result;
}

Polarimeter polarimeter(const RotatingRetarders& retarders, std::span<const DialAngles> dials) {
  require_valid(retarders);
  Polarimeter result;
  for (const DialAngles& dial : dials) {
    if (!std::isfinite(dial.generator) || !std::isfinite(dial.analyzer))
      throw std::invalid_argument("an angle of a dial is not finite");
    result.pairs.push_back({result.generator.size(), result.analyzer.size()});
    result.generator.push_back(stokes(arm_state(retarders.generator, retarders.extinction, dial.generator).state));
    result.analyzer.push_back(stokes(retarders.responsivity * analyzer_state(retarders, dial.analyzer).state));
  }
  return result;
}

std::array<double*, retarder_parameters> parameters(RotatingRetarders& r) {
  RetarderArm &g = r.generator, &a = r.analyzer;
  return {&g.retardance, &g.offset,    &g.polarizer,     &g.diattenuation, &a.retardance,
          &a.offset,     &a.polarizer, &a.diattenuation, &r.extinction,    &r.responsivity};
}

std::array<double, retarder_parameters> parameters(const RotatingRetarders& retarders) {
  RotatingRetarders copy = retarders;
  std::array<double, retarder_parameters> result{};
  const auto places = parameters(copy);
  for (std::size_t k = 0; k < retarder_parameters; ++k) result[k] = *places[k];
  return result;
}

std::string parameter_name(std::size_t parameter) {
  constexpr std::array<const char*, 4> of_arm{"retardance", "offset", "polarizer", "diattenuation"};
  if (parameter < 8)
    return of_arm[parameter % 4] + std::string(parameter < 4 ? " of the generator" : " of the analyzer");
  return parameter == 8 ? "extinction" : "responsivity";
}

std::vector<double> slopes(const RotatingRetarders& retarders, std::span<const DialAngles> dials) {
  const Index frames = index(dials.size());
  std::vector<double> result(8 * dials.size() * retarder_parameters);
  Eigen::Map<RowMajor> all(result.data(), 8 * frames, index(retarder_parameters));
  all.setZero();
  for (Index j = 0; j < frames; ++j) {
    const DialAngles& dial = dials[static_cast<std::size_t>(j)];
    const ArmState w = arm_state(retarders.generator, retarders.extinction, dial.generator);
    const ArmState a = analyzer_state(retarders, dial.analyzer);
    auto of_w = all.middleRows<4>(4 * j);
    auto of_a = all.middleRows<4>(4 * (frames + j));
    of_w.leftCols<4>() = w.slopes.leftCols<4>();
    of_w.col(8) = w.slopes.col(4);
    of_a.middleCols<4>(4) = a.slopes.leftCols<4>();
    of_a.col(8) = a.slopes.col(4);
    of_a.col(9) = a.state;
  }
  return result;
}

std::vector<double> state_covariance(const RotatingRetarders& retarders, std::span<const DialAngles> dials,
                                     std::span<const double> covariance) {
  constexpr std::size_t size = retarder_parameters;
  if (covariance.size() != size * size)
    throw std::invalid_argument("the covariance of the retarders has " + std::to_string(covariance.size()) +
                                " numbers, expected " + std::to_string(size * size));
  const std::vector<double> slope = slopes(retarders, dials);
  const Index rows = index(8 * dials.size());
  const Eigen::Map<const RowMajor> j(slope.data(), rows, index(size)), v(covariance.data(), index(size), index(size));
  std::vector<double> result(static_cast<std::size_t>(rows * rows));
  Eigen::Map<RowMajor> all(result.data(), rows, rows);
  all = j * v * j.transpose();
  all = (all + all.transpose()).eval() / 2;
  return result;
}

}  // namespace mmbrdf
