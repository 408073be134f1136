// SPDX-License-Identifier: BSD-3-Clause
#include "polarimetry/reference_slopes.hpp"

#include <numbers>

namespace mmbrdf::calibration {
namespace {

using Eigen::Index;
using Eigen::Matrix4d;

/// Of a wafer or a retarder, in its own axes.
void element_derivatives(std::vector<Derivative>& result, const DiattenuatorRetarder& element, double azimuth,
                         Index at) {
  const auto& [tau, psi, delta] = element;
  const auto add = [&](Index place, double factor, const Mueller& m) {
    result.push_back({place, factor * matrix(rotated(m, azimuth))});
  };
  add(at, 1, mueller({1, psi, delta}));
  // d/dψ: c → −2S, S → 2c, the sum that is on the diagonal of the first block does not change.
  Mueller over_psi = mueller({tau, psi + std::numbers::pi / 4, delta});  // c(ψ + 45°) = −S, S(ψ + 45°) = c
  over_psi(0, 0) = over_psi(1, 1) = 0;
  add(at + 1, 2, over_psi);
  Mueller over_delta = mueller({tau, psi, delta + std::numbers::pi / 2});
  over_delta(0, 0) = over_delta(1, 1) = over_delta(0, 1) = over_delta(1, 0) = 0;
  add(at + 2, 1, over_delta);
}

void polarizer_derivatives(std::vector<Derivative>& result, const Unknowns& x, double azimuth, double gain, Index at,
                           const PolarizerPlaces& places) {
  const double a = x.leak_real, b = x.leak_imaginary;
  const Mueller m = leaky_polarizer(azimuth, a, b);
  result.push_back({at, matrix(m)});
  // d R(α) / dα = 2 R(α) G with G the generator of turns: M turns as R(−α) M R(α).
  Matrix4d turn = Matrix4d::Zero();
  turn(1, 2) = 1;
  turn(2, 1) = -1;
  result.push_back({places.offset, gain * 2 * (matrix(m) * turn - turn * matrix(m))});
  const auto leak = [&](double slope, double real, double imaginary) {
    Mueller d = diagonal(slope, slope, real, real);
    d(0, 1) = d(1, 0) = -slope;
    d(3, 2) = imaginary;
    d(2, 3) = -imaginary;
    return Matrix4d(gain * matrix(rotated(d, azimuth)));
  };
  result.push_back({places.leak_real, leak(a, 1, 0)});
  if (places.leak_imaginary >= 0) result.push_back({places.leak_imaginary, leak(b, 0, 1)});
}

bool keeps_axes_apart(ReferenceKind kind) { return unknowns_of(kind) == 3; }

}  // namespace

Index unknowns_of(ReferenceKind kind) {
  return kind == ReferenceKind::wafer || kind == ReferenceKind::retarder ? 3 : 1;
}

Matrix4d expected(const Unknowns& x, std::span<const Reference> references, std::size_t i,
                  const CalibrationOptions& options) {
  const double gain = keeps_axes_apart(references[i].kind) ? 1 : x.gains[i];
  return gain * matrix(reference_matrix(x, references, i, options));
}

ReferenceSlopes reference_slopes(const Unknowns& x, std::span<const Reference> references, std::size_t i,
                                 const CalibrationOptions& options, Index first, const PolarizerPlaces& polarizer) {
  const Reference& reference = references[i];
  ReferenceSlopes result{expected(x, references, i, options), {}};
  if (keeps_axes_apart(reference.kind))
    element_derivatives(result.derivatives, x.elements[i], azimuth_of(reference), first);
  if (reference.kind == ReferenceKind::empty) result.derivatives.push_back({first, Matrix4d::Identity()});
  if (reference.kind == ReferenceKind::polarizer)
    polarizer_derivatives(result.derivatives, x, x.offset + options.dial_sense * reference.angle, x.gains[i], first,
                          polarizer);
  return result;
}

void move_references(Unknowns& x, std::span<const Reference> references, const Eigen::VectorXd& step,
                     std::span<const Index> first, const PolarizerPlaces& polarizer) {
  if (polarizer.offset >= 0) {
    x.offset += step(polarizer.offset);
    x.leak_real += step(polarizer.leak_real);
    if (polarizer.leak_imaginary >= 0) x.leak_imaginary += step(polarizer.leak_imaginary);
  }
  for (std::size_t i = 0; i < references.size(); ++i) {
    const Index at = first[i];
    if (!keeps_axes_apart(references[i].kind)) {
      x.gains[i] += step(at);
      continue;
    }
    x.elements[i].tau += step(at);
    x.elements[i].psi += step(at + 1);
    x.elements[i].delta += step(at + 2);
  }
}

}  // namespace mmbrdf::calibration
