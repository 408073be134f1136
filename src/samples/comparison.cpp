// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/samples/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string>

#include "mmbrdf/model/at_wavelengths.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/samples/simulation.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

void add(Difference& total, double d, const Sample& sample) {
  if (std::isnan(d)) return;  // not measured, or the model does not know it
  ++total.samples;
  total.rms += d * d;
  total.mean += d;
  if (std::abs(d) <= total.largest && total.wavelength > 0) return;
  total.largest = std::abs(d);
  total.wavelength = sample.wavelength;
  total.geometry = sample.geometry;
}

/// From sums to means.
void divide(Difference& total, const std::string& name) {
  if (total.samples == 0) return;
  total.rms = std::sqrt(total.rms / static_cast<double>(total.samples));
  total.mean /= static_cast<double>(total.samples);
  if (!std::isfinite(total.rms) || !std::isfinite(total.mean))
    throw std::invalid_argument("the differences of " + name + " are too large to be squared");
}

/// A difference where f11 of the first is so large.
void add(Comparison& total, const Mueller& d, double f11, const Sample& sample) {
  ++total.samples;
  add(total.f11, d(0, 0), sample);
  if (!(f11 > 0)) {
    ++total.dark;
    return;
  }
  add(total.f11_relative, d(0, 0) / f11, sample);
  for (std::size_t e = 1; e < 16; ++e) add(total.normalized[e], d.elements[e], sample);
}

Comparison divided(Comparison total, const std::string& first) {
  if (total.samples == total.dark)
    throw std::invalid_argument("f11 of " + first + " is positive at none of the samples");
  divide(total.f11, "f11");
  divide(total.f11_relative, "f11");
  for (std::size_t e = 1; e < 16; ++e) divide(total.normalized[e], "element " + element_name(e));
  return total;
}

bool is_beyond(double theta_max, const Geometry& geometry) {
  constexpr double rounding = 1e-9;  // files give degrees
  return std::max(geometry.incident.theta, geometry.reflected.theta) > theta_max + rounding;
}

bool is_beyond(const Model& model, double wavelength, const Geometry& geometry, std::optional<double> theta_max) {
  constexpr unsigned angles = outside_theta_i | outside_theta_r | outside_directions;
  return theta_max ? is_beyond(*theta_max, geometry) : (outside(model.validity, wavelength, geometry) & angles) != 0;
}

}  // namespace

std::vector<Mueller> residuals(const Model& model, std::span<const Sample> samples) {
  std::vector<Mueller> result;
  result.reserve(samples.size());
  const PreparedModel first = prepare(model, 1);
  AtWavelengths prepared([&](double wavelength) { return first.at(wavelength); });
  for (const Sample& sample : samples) {
    const Mueller predicted = prepared(sample.wavelength).evaluate(sample.geometry);
    Mueller difference = sample.normalized - normalized(predicted);
    difference(0, 0) = sample.f11 - predicted(0, 0);
    result.push_back(difference);
  }
  return result;
}

Comparison compare(const Model& model, std::span<const Sample> samples) {
  if (samples.empty()) throw std::invalid_argument("no samples");
  require_valid(samples);
  const std::vector<Mueller> differences = residuals(model, samples);
  const PreparedModel first = prepare(model, 1);
  AtWavelengths prepared([&](double wavelength) { return first.at(wavelength); });
  Comparison result;
  for (std::size_t s = 0; s < samples.size(); ++s)
    add(result, differences[s], prepared(samples[s].wavelength).f11(samples[s].geometry), samples[s]);
  return divided(result, "the model");
}

Comparison compare(std::span<const Sample> first, std::span<const Sample> second) {
  if (first.empty()) throw std::invalid_argument("no samples");
  if (first.size() != second.size()) throw std::invalid_argument("samples to compare must be as many");
  require_valid(first);
  require_valid(second);
  Comparison result;
  for (std::size_t s = 0; s < first.size(); ++s) {
    Mueller difference = second[s].normalized - first[s].normalized;
    difference(0, 0) = second[s].f11 - first[s].f11;
    add(result, difference, std::isnan(first[s].f11) ? 1 : first[s].f11, second[s]);
  }
  return divided(result, "the first");
}

Comparison compare(const Model& first, const Model& second, std::span<const double> wavelengths,
                   std::span<const Geometry> geometries) {
  return compare(first, simulate(second, wavelengths, geometries));
}

std::string dark_line(const Comparison& comparison) {
  if (comparison.dark == 0) return "";
  return "f11 of the model is not positive at " + std::to_string(comparison.dark) + " of " +
         std::to_string(comparison.samples) + " samples: there f11 alone is compared";
}

std::vector<double> common_wavelengths(const Model& first, const Model& second) {
  const std::vector<double>&a = first.validity.wavelengths, &b = second.validity.wavelengths;
  if (a.empty() || b.empty()) return a.empty() ? b : a;
  std::vector<double> common;
  std::copy_if(a.begin(), a.end(), std::back_inserter(common), [&](double one) {
    return std::any_of(b.begin(), b.end(), [=](double other) { return same_wavelength(one, other); });
  });
  return common;
}

std::size_t leave_out_beyond(const Model& model, std::vector<Sample>& samples, std::optional<double> theta_max) {
  return std::erase_if(samples, [&](const Sample& s) { return is_beyond(model, s.wavelength, s.geometry, theta_max); });
}

std::size_t leave_out_beyond(double theta_max, std::vector<Sample>& samples) {
  return std::erase_if(samples, [=](const Sample& s) { return is_beyond(theta_max, s.geometry); });
}

std::vector<Sample> samples_to_compare(const Model& first, const Model& second, std::span<const double> wavelengths,
                                       std::span<const Geometry> geometries, std::optional<double> theta_max) {
  std::vector<Sample> result;
  for (const double wavelength : wavelengths) {
    std::vector<Geometry> here(geometries.begin(), geometries.end());
    std::erase_if(here, [&](const Geometry& g) {
      return is_beyond(first, wavelength, g, theta_max) || is_beyond(second, wavelength, g, theta_max);
    });
    const std::vector<Sample> samples = simulate(second, {&wavelength, 1}, here);
    result.insert(result.end(), samples.begin(), samples.end());
  }
  return result;
}

double polarization_rms(const Comparison& comparison) {
  double squares = 0, known = 0;
  for (std::size_t e = 1; e < 16; ++e) {
    squares += std::pow(comparison.normalized[e].rms, 2);
    known += comparison.normalized[e].samples > 0 ? 1 : 0;
  }
  return known > 0 ? std::sqrt(squares / known) : 0;
}

Difference largest(const Comparison& comparison) {
  Difference result = comparison.f11_relative;
  for (std::size_t e = 1; e < 16; ++e)
    if (comparison.normalized[e].largest > result.largest) result = comparison.normalized[e];
  return result;
}

}  // namespace mmbrdf
