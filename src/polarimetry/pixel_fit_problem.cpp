// SPDX-License-Identifier: BSD-3-Clause
// What the fits of pixels share. Part of pixel_fit.hpp.

#include <cmath>
#include <stdexcept>
#include <string>

#include "polarimetry/pixel_fit.hpp"

namespace mmbrdf::calibration {

using Eigen::Index;
using Eigen::Map;
using Eigen::Vector4d;

PixelProblem::PixelProblem(const Calibration& from, std::span<const Reference> given,
                           const CalibrationOptions& its_options)
    : references(given.begin(), given.end()),
      options(its_options),
      generators(from.polarimeter.generator.size()),
      analyzers(from.polarimeter.analyzer.size()),
      readings(from.polarimeter.readings()),
      degrees_of_freedom(from.degrees_of_freedom) {
  if (from.references.size() != given.size() || from.covariance.empty())
    throw std::invalid_argument("the start is not a refined calibration with these references");
  for (std::size_t i = 0; i < given.size(); ++i)
    if (from.references[i].kind != given[i].kind || from.references[i].angle != given[i].angle)
      throw std::invalid_argument("reference " + std::to_string(i + 1) + " is not that of the start");
  if (degrees_of_freedom < 1) throw std::invalid_argument("not more readings than unknowns: add references");
  const Index leaks = options.fit_polarizer_phase ? 2 : 1;
  if (options.retarders) {
    retarders.emplace(references, options);
    size = retarders->polarizer.offset < 0 ? index(retarders->free.size()) : retarders->polarizer.leak_real + leaks;
    polarizer = retarders->polarizer;
  } else {
    const Index offset = 4 * index(generators + analyzers);
    size = offset + 1 + leaks;
    polarizer = {offset, offset + 1, leaks == 2 ? offset + 2 : -1};
    start.references.generator.resize(4, index(generators));
    start.references.analyzer.resize(4, index(analyzers));
    for (std::size_t s = 0; s < generators; ++s)
      start.references.generator.col(index(s)) = Map<const Vector4d>(from.polarimeter.generator[s].data());
    for (std::size_t s = 0; s < analyzers; ++s)
      start.references.analyzer.col(index(s)) = Map<const Vector4d>(from.polarimeter.analyzer[s].data());
  }
  if (from.retarders) start.instrument = from.retarders->values;
  start.references.offset = from.polarizer_offset;
  start.references.leak_real = std::sqrt(from.extinction) * std::cos(from.polarizer_phase);
  start.references.leak_imaginary = std::sqrt(from.extinction) * std::sin(from.polarizer_phase);
  for (const FittedReference& reference : from.references) {
    start.references.gains.push_back(reference.kind == ReferenceKind::polarizer
                                         ? 2 * reference.element.tau / (1 + from.extinction)
                                         : reference.gain);
    start.references.elements.push_back(reference.element);
    start.drifts.push_back(reference.drift);
  }
}

Index PixelProblem::own(std::size_t reference) const {
  return unknowns_of(references[reference].kind) + (retarders && options.retarders->fit_drift ? 1 : 0);
}

}  // namespace mmbrdf::calibration
