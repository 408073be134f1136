// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarimetry/images.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "mmbrdf/polarimetry/reduction.hpp"
#include "numerics/threads.hpp"
#include "polarimetry/kernel/reduction_kernels.hpp"
#include "polarimetry/pixel_fit.hpp"

namespace mmbrdf {

namespace {

constexpr float nothing = std::numeric_limits<float>::quiet_NaN();

using Arm = Eigen::Matrix<double, 4, Eigen::Dynamic>;

/// (S Sᵀ)⁻¹ S of states S, 4 × n; not finite for states that are dependent.
Arm inverse_of_arm(const double* states, std::size_t count) {
  const Eigen::Map<const Arm> s(states, 4, static_cast<Eigen::Index>(count));
  if (!s.allFinite()) return Arm::Constant(4, s.cols(), std::numeric_limits<double>::quiet_NaN());
  Eigen::Matrix4d square = s * s.transpose();
  // Gauss and Jordan with pivots of the diagonal: the matrix is positive definite.
  Arm result = s;
  for (Eigen::Index k = 0; k < 4; ++k) {
    const double pivot = square(k, k);
    if (!(pivot > 1e-12 * s.squaredNorm())) return Arm::Constant(4, s.cols(), std::numeric_limits<double>::quiet_NaN());
    square.row(k) /= pivot;
    result.row(k) /= pivot;
    for (Eigen::Index r = 0; r < 4; ++r) {
      if (r == k) continue;
      const double factor = square(r, k);
      square.row(r) -= factor * square.row(k);
      result.row(r) -= factor * result.row(k);
    }
  }
  return result;
}

void put_arms(const double* generators, const double* analyzers, std::size_t pixel, PixelInverses& to) {
  const Arm w = inverse_of_arm(generators, to.generators), a = inverse_of_arm(analyzers, to.analyzers);
  const std::size_t pixels = to.pixels();
  float* const a_numbers = to.numbers.data() + 4 * to.analyzers * pixel;
  for (std::size_t r = 0; r < 4; ++r)
    for (std::size_t q = 0; q < to.analyzers; ++q)
      a_numbers[r * to.analyzers + q] =
          static_cast<float>(a(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(q)));
  float* const w_numbers = to.numbers.data() + 4 * to.analyzers * pixels + 4 * to.generators * pixel;
  for (std::size_t p = 0; p < to.generators; ++p)
    for (std::size_t c = 0; c < 4; ++c)
      w_numbers[4 * p + c] = static_cast<float>(w(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(p)));
}

/// By the reduction of the pixel alone: one of unit readings after the other.
void put_whole(Polarimeter pixel_of, const double* generators, const double* analyzers, float* to) {
  const std::size_t readings = pixel_of.readings();
  for (std::size_t p = 0; p < pixel_of.generator.size(); ++p)
    std::copy_n(generators + 4 * p, 4, pixel_of.generator[p].begin());
  for (std::size_t q = 0; q < pixel_of.analyzer.size(); ++q)
    std::copy_n(analyzers + 4 * q, 4, pixel_of.analyzer[q].begin());
  std::fill_n(to, 16 * readings, nothing);
  try {
    const Reduction reduction(pixel_of);
    if (reduction.undetermined().any()) return;
    std::vector<double> unit(readings);
    for (std::size_t j = 0; j < readings; ++j) {
      unit[j] = 1;
      const Mueller column = reduction.mueller(unit);
      unit[j] = 0;
      for (std::size_t e = 0; e < 16; ++e) to[16 * j + e] = static_cast<float>(column.elements[e]);
    }
  } catch (const std::invalid_argument&) {  // states that are not finite: NaN
  }
}

}  // namespace

std::size_t PixelInverses::pixels() const {
  const std::size_t each = analyzers > 0 ? 4 * (analyzers + generators) : 16 * readings;
  return each > 0 ? numbers.size() / each : 0;
}

PixelInverses pixel_inverses(std::span<const double> generators, std::span<const double> analyzers,
                             const Polarimeter& like, int threads) {
  const std::size_t p = like.generator.size(), q = like.analyzer.size();
  if (p == 0 || q == 0 || p > most_states || q > most_states)
    throw std::invalid_argument(std::to_string(p) + " generator and " + std::to_string(q) +
                                " analyzer states, must be 1 to " + std::to_string(most_states));
  const std::size_t pixels = generators.size() / (4 * p);
  if (generators.size() != 4 * p * pixels || analyzers.size() != 4 * q * pixels)
    throw std::invalid_argument(std::to_string(generators.size()) + " and " + std::to_string(analyzers.size()) +
                                " components of states are not those of as many pixels");
  PixelInverses result;
  result.readings = like.readings();
  const bool arms = like.pairs.empty() && p >= 4 && q >= 4;
  if (arms) {
    result.generators = p;
    result.analyzers = q;
  }
  result.numbers.resize(pixels * (arms ? 4 * (p + q) : 16 * result.readings));
  in_parts(pixels, threads, [&](std::size_t begin, std::size_t count) {
    for (std::size_t i = begin; i < begin + count; ++i)
      if (arms)
        put_arms(generators.data() + 4 * p * i, analyzers.data() + 4 * q * i, i, result);
      else
        put_whole(like, generators.data() + 4 * p * i, analyzers.data() + 4 * q * i,
                  result.numbers.data() + 16 * result.readings * i);
  });
  return result;
}

void muellers(const PixelInverses& inverses, std::span<const float> readings, std::span<float> elements, int threads,
              std::size_t first) {
  const std::size_t all = inverses.pixels(), n = inverses.readings, pixels = elements.size() / 16;
  if (first > all || pixels > all - first || elements.size() != 16 * pixels || readings.size() != n * pixels)
    throw std::invalid_argument(std::to_string(readings.size()) + " readings and " + std::to_string(elements.size()) +
                                " elements from pixel " + std::to_string(first) + " on, there are " +
                                std::to_string(all) + " pixels of " + std::to_string(n) + " and 16");
  const ReductionKernel& kernel = best_reduction_kernel();
  const float* const a = inverses.numbers.data();
  const float* const w = a + 4 * inverses.analyzers * all;
  in_parts(pixels, threads, [&](std::size_t begin, std::size_t count) {
    const std::size_t pixel = first + begin;
    const float* const from = readings.data() + n * begin;
    float* const to = elements.data() + 16 * begin;
    if (inverses.analyzers > 0)
      kernel.run_arms(a + 4 * inverses.analyzers * pixel, w + 4 * inverses.generators * pixel, inverses.analyzers,
                      inverses.generators, from, count, to);
    else
      kernel.run_each(a + 16 * n * pixel, n, from, count, to);
    for (std::size_t i = 0; i < 16 * count; i += 16)  // what is not finite is in every sum of the first element
      if (!std::isfinite(to[i])) std::fill_n(to + i, 16, nothing);
  });
}

namespace {

/// Where the numbers of one pixel go.
void put(const calibration::PixelProblem& problem, const calibration::FittedPixel& fit, std::size_t pixel,
         PixelCalibrations& to) {
  using Eigen::Index;
  const std::size_t p = 4 * problem.generators, q = 4 * problem.analyzers;
  double* const generators = to.generators.data() + p * pixel;
  double* const analyzers = to.analyzers.data() + q * pixel;
  const Eigen::VectorXd& u = fit.uncertainties;
  if (!problem.retarders) {
    std::copy_n(fit.x.references.generator.data(), p, generators);
    std::copy_n(fit.x.references.analyzer.data(), q, analyzers);
    std::copy_n(u.data(), p, to.generator_uncertainties.data() + p * pixel);
    std::copy_n(u.data() + p, q, to.analyzer_uncertainties.data() + q * pixel);
    return;
  }
  const Polarimeter states = polarimeter(fit.x.instrument, problem.retarders->dials);
  for (std::size_t s = 0; s < problem.generators; ++s) {
    std::ranges::copy(states.generator[s], generators + 4 * s);
    std::ranges::copy(states.analyzer[s], analyzers + 4 * s);
  }
  const auto values = parameters(fit.x.instrument);
  std::ranges::copy(values, to.retarders.begin() + static_cast<std::ptrdiff_t>(retarder_parameters * pixel));
  for (std::size_t k = 0; k < retarder_parameters; ++k) to.retarder_uncertainties[retarder_parameters * pixel + k] = 0;
  for (std::size_t k = 0; k < problem.retarders->free.size(); ++k)
    to.retarder_uncertainties[retarder_parameters * pixel + problem.retarders->free[k]] = u(static_cast<Index>(k));
}

PixelFailure condition_of(const calibration::PixelProblem& problem, const calibration::FittedPixel& fit) {
  if (fit.failure != PixelFailure::none || problem.retarders) return fit.failure;
  for (const Eigen::MatrixXd* arm : {&fit.x.references.generator, &fit.x.references.analyzer}) {
    std::vector<Stokes> states(static_cast<std::size_t>(arm->cols()));
    for (std::size_t s = 0; s < states.size(); ++s) std::copy_n(arm->data() + 4 * s, 4, states[s].begin());
    if (!(condition_number(states) <= worst_condition)) return PixelFailure::dependent;
  }
  return PixelFailure::none;
}

}  // namespace

PixelCalibrations calibrate_pixels(const Calibration& start, std::span<const Reference> references,
                                   std::span<const float> readings, const CalibrationOptions& options,
                                   const PixelOptions& pixel_options) {
  const calibration::PixelProblem problem(start, references, options);
  const std::size_t each = problem.readings * references.size(), pixels = readings.size() / each;
  if (readings.size() != each * pixels)
    throw std::invalid_argument(std::to_string(readings.size()) + " readings are not those of whole pixels of " +
                                std::to_string(each));
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  PixelCalibrations result;
  result.generators.assign(4 * problem.generators * pixels, unknown);
  result.analyzers.assign(4 * problem.analyzers * pixels, unknown);
  result.misfit.assign(pixels, unknown);
  result.failures.assign(pixels, PixelFailure::none);
  if (problem.retarders) {
    result.retarders.assign(retarder_parameters * pixels, unknown);
    result.retarder_uncertainties = result.retarders;
  } else {
    result.generator_uncertainties = result.generators;
    result.analyzer_uncertainties = result.analyzers;
  }
  const auto calibrate = [&](std::size_t i) {
    const calibration::FittedPixel fit =
        fit_pixel(problem, readings.subspan(each * i, each), pixel_options.most_misfit);
    result.misfit[i] = fit.misfit;
    result.failures[i] = condition_of(problem, fit);
    if (result.failures[i] == PixelFailure::none) put(problem, fit, i, result);
  };
  in_any_order(pixels, calibrate, pixel_options.threads);
  return result;
}

}  // namespace mmbrdf
