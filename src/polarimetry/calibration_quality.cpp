// SPDX-License-Identifier: BSD-3-Clause
#include "polarimetry/calibration_quality.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "polarimetry/wafer_signs.hpp"

namespace mmbrdf::calibration {

FittedReference fitted(const Unknowns& unknowns, std::span<const Reference> references, std::size_t i,
                       const Mueller& measured, const CalibrationOptions& options) {
  const Reference& reference = references[i];
  FittedReference result;
  result.kind = reference.kind;
  result.angle = reference.angle;
  result.expected = normalized(reference_matrix(unknowns, references, i, options));
  result.measured = measured;
  if (!std::isnan(measured(0, 0))) result.measured = normalized(measured);
  if (reference.kind == ReferenceKind::empty) result.gain = unknowns.gains[i];
  if (reference.kind == ReferenceKind::wafer) {
    result.element = element_of(result.expected);
    result.element.tau = unknowns.elements[i].tau;
    // Of a matrix that keeps s and p apart: λ1 λ2 = m11² − m12², |λ3|² the determinant of the other block.
    const Mueller& m = result.measured;
    const double first = m(0, 0) * m(1, 1) - m(0, 1) * m(1, 0), second = m(2, 2) * m(3, 3) - m(2, 3) * m(3, 2);
    result.eigenvalue_mismatch = std::abs(first - second);
  }
  if (reference.kind == ReferenceKind::retarder) {
    result.element = element_of(normalized(mueller(unknowns.elements[i])));
    result.element.tau = unknowns.elements[i].tau;
  }
  if (reference.kind == ReferenceKind::polarizer) {
    const double real = unknowns.leak_real, imaginary = unknowns.leak_imaginary;
    result.element = {unknowns.gains[i] * (1 + real * real + imaginary * imaginary) / 2,
                      std::atan(std::hypot(real, imaginary)), std::atan2(imaginary, real)};
  }
  return result;
}

FigureOfMerit figure_of_merit(std::span<const FittedReference> references, double correction) {
  FigureOfMerit result;
  std::array<double, 4> sums{}, counts{};  // of each kind
  std::array<double, 16> of_element{};
  for (const FittedReference& reference : references) {
    const auto kind = static_cast<std::size_t>(reference.kind);
    for (std::size_t e = 1; e < 16; ++e) {
      const double d = reference.measured.elements[e] - reference.expected.elements[e];
      if (std::isnan(d)) continue;  // not measured
      sums[kind] += d * d;
      ++counts[kind];
      result.elements.elements[e] += d * d;
      ++of_element[e];
    }
  }
  const auto rms = [](double sum, double count) { return count > 0 ? std::sqrt(sum / count) : 0; };
  for (std::size_t e = 1; e < 16; ++e) result.elements.elements[e] = rms(result.elements.elements[e], of_element[e]);
  result.total = rms(sums[0] + sums[1] + sums[2] + sums[3], counts[0] + counts[1] + counts[2] + counts[3]);
  result.corrected = result.total * correction;
  result.empty = rms(sums[0], counts[0]);
  result.polarizer = rms(sums[1], counts[1]);
  result.wafer = rms(sums[2], counts[2]);
  result.retarder = rms(sums[3], counts[3]);
  return result;
}

double scale_uncertainty(const Unknowns& unknowns, std::span<const Reference> references) {
  double squares = 0, count = 0;
  for (std::size_t i = 0; i < references.size(); ++i) {
    if (references[i].kind != ReferenceKind::empty) continue;
    squares += (unknowns.gains[i] - 1) * (unknowns.gains[i] - 1);  // the mean is 1
    ++count;
  }
  return count > 1 ? std::sqrt(squares / (count * (count - 1))) : 0;
}

void set_polarizer(Calibration& calibration, const Unknowns& unknowns) {
  calibration.polarizer_offset = unknowns.offset - std::numbers::pi * std::floor(unknowns.offset / std::numbers::pi);
  calibration.extinction = unknowns.leak_real * unknowns.leak_real + unknowns.leak_imaginary * unknowns.leak_imaginary;
  calibration.polarizer_phase = std::atan2(unknowns.leak_imaginary, unknowns.leak_real);
}

}  // namespace mmbrdf::calibration
