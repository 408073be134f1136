// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/uncertainty/budget.hpp"
#include "mmbrdf/model/prepared.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "numerics/random.hpp"
#include "text/numbers.hpp"
#include "uncertainty/drawn_errors.hpp"

namespace mmbrdf {
namespace {

constexpr std::array<std::pair<ErrorOf, const char*>, 5> names{{{ErrorOf::scale, "scale"},
                                                                {ErrorOf::theta_i, "theta_i"},
                                                                {ErrorOf::theta_r, "theta_r"},
                                                                {ErrorOf::azimuth, "azimuth"},
                                                                {ErrorOf::calibration, "calibration"}}};

constexpr double step = 1e-4;  // radians: the third derivative adds 2e-9 of itself, rounding 1e-12

/// ∂F/∂θ of one of the directions, in the sp frame. Beyond the normal the arm comes down at the opposite azimuth, where
/// s and p have both changed sign and the matrix is the same.
Mueller polar_slope(const PreparedModel& model, const Geometry& geometry, Direction Geometry::*which) {
  const double theta = (geometry.*which).theta, phi = (geometry.*which).phi;
  const double low = theta - step, high = std::min(theta + step, std::numbers::pi / 2);
  const auto at = [&](double angle) {
    Geometry moved = geometry;
    moved.*which = unfolded(Direction{angle, phi});
    return model.evaluate(moved, Frame::sp);
  };
  return (1 / (high - low)) * (at(high) - at(low));
}

Mueller azimuth_slope(const PreparedModel& model, Geometry geometry) {
  const double phi = geometry.reflected.phi;
  const auto at = [&](double angle) {
    geometry.reflected.phi = angle;
    return model.evaluate(geometry, Frame::sp);
  };
  return (1 / (2 * step)) * (at(phi + step) - at(phi - step));
}

/// dF/dd of a measurement with the detector at θr + d, in the sp frame.
Mueller detector_slope(const PreparedModel& model, const Geometry& geometry) {
  const double theta = geometry.reflected.theta;
  if (std::cos(theta) < grazing_limit)
    throw std::invalid_argument("theta_r = " + shortest(in_degrees(theta)) +
                                " degrees, where no measurement tells f11 and a term theta_r is infinite");
  return polar_slope(model, geometry, &Geometry::reflected) - std::tan(theta) * model.evaluate(geometry, Frame::sp);
}

/// Of the elements in the sp frame, that of the polarimeter, so that one draw of errors is one instrument at all
/// geometries. Independent errors with one variance are so in every frame: axes turn by orthogonal matrices.
std::vector<Mueller> calibration_effects(const PreparedModel& model, const Geometry& geometry, double uncertainty,
                                         Frame frame) {
  const double f11 = model.f11(geometry);
  std::vector<Mueller> result;
  for (std::size_t e = 1; e < 16; ++e) {
    Mueller effect;
    effect.elements[e] = uncertainty * f11;
    result.push_back(change_frame(effect, geometry, Frame::sp, frame));
  }
  return result;
}

void add(MuellerCovariance& sum, const Mueller& effect) {
  for (std::size_t e = 0; e < 16; ++e)
    for (std::size_t other = 0; other < 16; ++other) sum(e, other) += effect.elements[e] * effect.elements[other];
}

/// `where` is a geometry, or several with weights.
template <class Where>
Budget budget_of(std::vector<BudgetTerm> fit, const PreparedModel& model, std::span<const TypeBTerm> terms,
                 const Where& where, Frame frame) {
  Budget result{std::move(fit), {}};
  for (const TypeBTerm& term : terms) {
    result.terms.push_back({term.name, {}, term.freedom});
    for (const Mueller& effect : effects(term, model, where, frame)) add(result.terms.back().covariance, effect);
  }
  for (const BudgetTerm& term : result.terms)
    for (std::size_t i = 0; i < 256; ++i) result.total.values[i] += term.covariance.values[i];
  return result;
}

}  // namespace

std::string to_string(ErrorOf what) {
  for (const auto& [value, name] : names)
    if (value == what) return name;
  throw std::invalid_argument("there is no such ErrorOf");
}

ErrorOf error_from(const std::string& name) {
  for (const auto& [value, known] : names)
    if (name == known) return value;
  throw std::invalid_argument("kind of error '" + name +
                              "' is not one of scale, theta_i, theta_r, azimuth, calibration");
}

std::vector<Mueller> effects(const TypeBTerm& term, const PreparedModel& model, const Geometry& geometry, Frame frame) {
  require_valid(geometry);
  const double u = term.uncertainty;
  if (!(u >= 0 && u <= largest_term))
    throw std::invalid_argument("uncertainty " + shortest(u) + " of " + term.name + ", must be in [0, " +
                                shortest(largest_term) + "]");
  const auto in_frame = [&](const Mueller& slope_sp) {
    return std::vector<Mueller>{u * change_frame(slope_sp, geometry, Frame::sp, frame)};
  };
  switch (term.what) {
    case ErrorOf::scale:
      return {u * model.evaluate(geometry, frame)};
    case ErrorOf::theta_i:
      return in_frame(polar_slope(model, geometry, &Geometry::incident));
    case ErrorOf::theta_r:
      return in_frame(detector_slope(model, geometry));
    case ErrorOf::azimuth:
      return in_frame(azimuth_slope(model, geometry));
    case ErrorOf::calibration:
      return calibration_effects(model, geometry, u, frame);
  }
  throw std::invalid_argument("there is no such ErrorOf");
}

std::vector<Mueller> effects(const TypeBTerm& term, const PreparedModel& model,
                             std::span<const WeightedGeometry> geometries, Frame frame) {
  std::vector<Mueller> sum;
  for (const auto& [geometry, weight] : geometries) {
    const std::vector<Mueller> here = effects(term, model, geometry, frame);
    sum.resize(here.size());
    for (std::size_t i = 0; i < here.size(); ++i) sum[i] = sum[i] + weight * here[i];
  }
  return sum;
}

Budget budget(const PreparedModel& model, const PreparedUncertainty& fit, std::span<const TypeBTerm> terms,
              const Geometry& geometry, Frame frame) {
  return budget_of(fit.parts(geometry, frame), model, terms, geometry, frame);
}

Budget budget(const PreparedModel& model, const PreparedUncertainty& fit, std::span<const TypeBTerm> terms,
              std::span<const WeightedGeometry> geometries, Frame frame) {
  return budget(model, fit, fit.gradient(geometries, frame), terms, geometries, frame);
}

Budget budget(const PreparedModel& model, const PreparedUncertainty& fit, const MuellerGradient& gradient,
              std::span<const TypeBTerm> terms, std::span<const WeightedGeometry> geometries, Frame frame) {
  return budget_of(fit.parts(gradient), model, terms, geometries, frame);
}

std::vector<Mueller> drawn(std::span<const PreparedModel> draws, const PreparedModel& model,
                           std::span<const TypeBTerm> terms, const Geometry& geometry, Frame frame,
                           unsigned long seed) {
  std::vector<Mueller> errors;
  for (const TypeBTerm& term : terms)
    for (const Mueller& effect : effects(term, model, geometry, frame)) errors.push_back(effect);
  const std::vector<double> sizes = drawn_errors(terms, draws.size(), seed);
  const double* size = sizes.data();
  std::vector<Mueller> result;
  result.reserve(draws.size());
  for (const PreparedModel& draw : draws) {
    result.push_back(draw.evaluate(geometry, frame));
    for (const Mueller& error : errors) result.back() = result.back() + *size++ * error;
  }
  return result;
}

std::vector<double> drawn_errors(std::span<const TypeBTerm> terms, std::size_t draws, unsigned long seed) {
  std::size_t count = 0;
  for (const TypeBTerm& term : terms) count += term.what == ErrorOf::calibration ? 15 : 1;
  std::vector<double> result(draws * count);
  std::mt19937_64 engine(~seed);  // not the stream of Draws with the same seed
  for (double& error : result) error = normal(engine);
  return result;
}

}  // namespace mmbrdf
