// SPDX-License-Identifier: BSD-3-Clause
#include "quantities/angle_unit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "mmbrdf/quantities/conventions.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr double edge = 1e-3;      // radians that files round
constexpr double no_small = 0.35;  // 20 degrees
constexpr double different = 0.5;  // of numbers that are azimuths
constexpr double rounding = 1e-9;  // rms of simulated data without noise

/// A direction as its numbers were, with a polar angle that is not folded: azimuths of radians are within ±2π.
Direction in_numbers(const Direction& direction) {
  const double phi = std::remainder(degrees(direction.phi), 360);
  if (std::abs(phi) <= 90) return {degrees(direction.theta), phi};
  return {-degrees(direction.theta), std::remainder(phi - 180, 360)};
}

double largest_theta(std::span<const Sample> samples) {
  double largest = 0;
  for (const Sample& s : samples)
    largest = std::max({largest, degrees(s.geometry.incident.theta), degrees(s.geometry.reflected.theta)});
  return largest;
}

double largest_phi(std::span<const Sample> samples) {
  double largest = 0;
  for (const Sample& s : samples)
    for (const Direction& d : {s.geometry.incident, s.geometry.reflected})
      largest = std::max(largest, std::abs(in_numbers(d).phi));
  return largest;
}

/// As if polar angles were radians, and azimuths, too, or not.
std::vector<Sample> read_as_radians(std::span<const Sample> samples, bool azimuths) {
  std::vector<Sample> result(samples.begin(), samples.end());
  for (Sample& s : result)
    for (Direction* d : {&s.geometry.incident, &s.geometry.reflected}) {
      const Direction numbers = in_numbers(*d);
      const double theta = std::clamp(numbers.theta, -std::numbers::pi / 2, std::numbers::pi / 2);
      *d = unfolded({theta, azimuths ? numbers.phi : radians(numbers.phi)});
    }
  return result;
}

struct Left {
  double f11 = 0, others = 0;
  bool enough = false;
};

Left left_by_fit(std::span<const Sample> samples) {
  FitOptions options;
  options.minimum_norm = true;
  const FitResult fitted = fit(samples, {Family::isotropic, inspected_orders}, options);
  std::size_t coefficients = 0;
  for (const FittedBlock& block : fitted.model.blocks) coefficients = std::max(coefficients, block.coefficients.size());
  return {fitted.elements[0].rms, polarization_rms(fitted), samples.size() >= 2 * coefficients};
}

/// "12 of 13 theta_i are multiples of 0.5 degrees if they are radians", of the direction of which it holds; or empty.
std::string round_line(std::span<const Sample> samples, Direction Geometry::*direction, const std::string& name) {
  constexpr double step = 0.5, tolerance = 0.004;  // degrees; of radians with four decimals
  constexpr std::size_t fewest = 4;
  std::set<long> values;  // 1e-6 degrees
  for (const Sample& s : samples) values.insert(std::lround(degrees((s.geometry.*direction).theta) * 1e6));
  values.erase(0);
  const auto round = [](long value) {
    return std::abs(std::remainder(degrees(static_cast<double>(value) * 1e-6), step)) < tolerance;
  };
  const auto count = static_cast<std::size_t>(std::ranges::count_if(values, round));
  if (count < fewest || static_cast<double>(count) < 0.9 * static_cast<double>(values.size())) return "";
  return std::to_string(count) + " of " + std::to_string(values.size()) + " different " + name +
         " are multiples of 0.5 degrees if they are radians";
}

/// "a fit of low order leaves 6.8 times as much of f11 as it does if they are radians", if that tells; or empty.
std::string fit_line(std::span<const Sample> samples) {
  const bool azimuths = std::ranges::any_of(samples, [](const Sample& s) {
    return std::abs(in_numbers(s.geometry.reflected).phi - in_numbers(s.geometry.incident).phi) > different;
  });
  if (!azimuths) return "";
  const Left as_is = left_by_fit(samples), turned = left_by_fit(read_as_radians(samples, true)),
             wide = left_by_fit(read_as_radians(samples, false));
  const auto tells = [](double as, double wider, double other) {
    return std::min(as, wider) > better_convention * std::max(other, rounding);
  };
  const bool by_f11 = tells(as_is.f11, wide.f11, turned.f11);
  if (!as_is.enough || !(by_f11 || tells(as_is.others, wide.others, turned.others))) return "";
  const double was = by_f11 ? as_is.f11 : as_is.others, is = by_f11 ? turned.f11 : turned.others;
  return "a fit of low order leaves " + rounded(was / std::max(is, rounding), 2) + " times as much of " +
         (by_f11 ? "f11" : "the other elements") + " as it does if they are radians";
}

}  // namespace

bool may_be_radians(std::span<const Sample> samples) {
  const double theta = largest_theta(samples);
  return theta >= no_small && theta <= std::numbers::pi / 2 + edge &&
         largest_phi(samples) <= 2 * std::numbers::pi + edge;
}

Finding radian_finding(std::span<const Sample> samples) {
  std::string evidence;
  for (const std::string& line : {round_line(samples, &Geometry::incident, "theta_i"),
                                  round_line(samples, &Geometry::reflected, "theta_r"), fit_line(samples)})
    if (!line.empty()) evidence += "; " + line;
  if (evidence.empty()) return {};
  return {
      "angles in radians",
      "polar angles are up to " + rounded(largest_theta(samples), 4) + " and azimuths within +-" +
          rounded(largest_phi(samples), 4) + " degrees" + evidence,
      "call the columns theta_i_rad, phi_i_rad, theta_r_rad and phi_r_rad (or columns theta_i_rad=NAME,... of names "
      "without a unit)",
      {}};
}

}  // namespace mmbrdf
