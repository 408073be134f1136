// SPDX-License-Identifier: BSD-3-Clause
/// What the tests of a calibration share: simulated references, and how far an instrument is from the true one.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/polarimetry/calibration.hpp"
#include "mmbrdf/polarimetry/goniometer.hpp"
#include "mmbrdf/polarimetry/reduction.hpp"

namespace mmbrdf {

inline constexpr double wavelength = 0.532;

/// Imperfections as they are by default, all else perfect.
inline GoniometerOptions quiet() {
  GoniometerOptions options;
  options.extinction = 0;
  options.gain_change = 0;
  options.noise = {};
  return options;
}

inline CalibrationOptions with_film(bool refine = true) {
  CalibrationOptions options;
  options.wavelength = wavelength;
  options.film = GoniometerOptions{}.film;
  options.refine = refine;
  return options;
}

/// Twenty matrices: diattenuator-retarders in front of depolarizers, turned.
inline std::vector<Mueller> test_matrices() {
  std::vector<Mueller> result;
  for (int n = 0; n < 20; ++n) {
    const Mueller depolarizer = diagonal(1, 0.2 + 0.03 * n, 0.8 - 0.02 * n, 0.1 + 0.03 * n);
    const Mueller element = rotated(mueller({1, 0.5 + 0.01 * n, 0.3 * n}), 0.2 * n);
    result.push_back(normalized(element * rotator(0.1 * n) * depolarizer * rotator(-0.3 * n)));
  }
  return result;
}

/// Errors of the fifteen normalised elements of the test matrices.
inline std::vector<double> errors(const Polarimeter& found, const Polarimeter& truth) {
  const Reduction reduction(found);
  std::vector<double> result;
  for (const Mueller& m : test_matrices()) {
    const Mueller difference = normalized(reduction.mueller(readings(truth, m))) - m;
    result.insert(result.end(), difference.elements.begin() + 1, difference.elements.end());
  }
  return result;
}

/// Their root mean square.
inline double error(const Polarimeter& found, const Polarimeter& truth) {
  double sum = 0;
  const std::vector<double> all = errors(found, truth);
  for (const double e : all) sum += e * e;
  return std::sqrt(sum / static_cast<double>(all.size()));
}

inline double largest_error(const Polarimeter& found, const Polarimeter& truth) {
  double largest = 0;
  for (const double e : errors(found, truth)) largest = std::max(largest, std::abs(e));
  return largest;
}

inline double largest_difference(const Polarimeter& a, const Polarimeter& b) {
  double largest = 0;
  for (std::size_t s = 0; s < a.generator.size(); ++s)
    for (std::size_t k = 0; k < 4; ++k)
      largest = std::max(
          {largest, std::abs(a.generator[s][k] - b.generator[s][k]), std::abs(a.analyzer[s][k] - b.analyzer[s][k])});
  return largest;
}

/// With first components of w of mean 1, as calibrations have them.
inline Polarimeter scaled(Polarimeter p) {
  double mean = 0;
  for (const Stokes& w : p.generator) mean += w[0] / static_cast<double>(p.generator.size());
  for (Stokes& w : p.generator)
    for (double& x : w) x /= mean;
  for (Stokes& a : p.analyzer)
    for (double& x : a) x *= mean;
  return p;
}

inline std::string refusal(std::span<const Reference> references, const CalibrationOptions& options) {
  try {
    calibrate(references, options);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "nothing was thrown";
}

/// With the signs that the true film has at each angle stated.
inline std::vector<Reference> with_stated_signs(std::vector<Reference> references) {
  for (Reference& r : references) {
    if (r.kind != ReferenceKind::wafer) continue;
    const DiattenuatorRetarder wafer = reflection(GoniometerOptions{}.film, wavelength, r.angle);
    r.s_exceeds_p = wafer.psi < std::numbers::pi / 4 ? 1 : -1;
    r.delta_sign = wafer.delta > 0 ? 1 : -1;
  }
  return references;
}

inline CalibrationOptions without_film(bool refine = true) {
  CalibrationOptions options = with_film(refine);
  options.film.reset();
  return options;
}

/// All but the wafers with these numbers, from 0, are left out.
inline std::vector<Reference> with_wafers(std::vector<Reference> references, std::initializer_list<int> numbers) {
  int wafer = 0;
  std::erase_if(references, [&](const Reference& r) {
    return r.kind == ReferenceKind::wafer && std::find(numbers.begin(), numbers.end(), wafer++) == numbers.end();
  });
  return references;
}

inline std::vector<Reference> only(std::vector<Reference> references,
                                   const std::function<bool(const Reference&)>& keep) {
  std::erase_if(references, [&](const Reference& r) { return !keep(r); });
  return references;
}

}  // namespace mmbrdf
