// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/samples/samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

#include "numerics/random.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr double counts = 1e-12;  // coefficient of a rotation: below it is the rounding of a sine that is 0

void require_wavelength(const Sample& sample, std::size_t index) {
  if (sample.wavelength > 0 && std::isfinite(sample.wavelength)) return;
  throw std::invalid_argument("sample " + std::to_string(index + 1) +
                              ": wavelength = " + shortest(in_nanometres(sample.wavelength)) + " nm, must be positive");
}

void require_samples_at(std::span<const double> present, double wavelength) {
  const auto found = [&](double other) { return same_wavelength(wavelength, other); };
  if (std::any_of(present.begin(), present.end(), found)) return;
  std::string list;
  for (double other : present) list += (list.empty() ? "" : ", ") + shortest(in_nanometres(other));
  throw std::invalid_argument(
      "wavelength = " + shortest(in_nanometres(wavelength)) +
      " nm: " + (list.empty() ? "there are no samples" : "no sample; there are samples at " + list + " nm"));
}

/// The direction with cosines x and y.
Direction from_cosines(double x, double y) { return direction({x, y, std::sqrt(1 - x * x - y * y)}); }

double distance(const Direction& a, const Direction& b) {
  const Vector3 u = unit_vector(a), v = unit_vector(b);
  return std::hypot(u[0] - v[0], u[1] - v[1], u[2] - v[2]);
}

void require_valid_elements(const Sample& sample, const std::string& name) {
  for (std::size_t e = 0; e < 16; ++e) {
    const double value = e == 0 ? sample.f11 : sample.normalized.elements[e], u = sample.uncertainty.elements[e];
    if (std::isinf(value))
      throw std::invalid_argument(name + ": " + sample_element(e) + " = " + shortest(value) + ", must be finite");
    if (!(u >= 0) || !std::isfinite(u))
      throw std::invalid_argument(name + ": u_" + sample_element(e) + " = " + shortest(u) +
                                  ", must be finite and not negative");
  }
}

/// Of rotated(m, scattered, incident) from those of m, uncorrelated; 0 where one that counts is 0.
Mueller rotated_uncertainty(const Mueller& uncertainty, double scattered, double incident) {
  Mueller squares;
  std::array<bool, 16> known;
  known.fill(true);
  for (std::size_t from = 0; from < 16; ++from) {
    Mueller unit;
    unit.elements[from] = 1;
    const Mueller slopes = rotated(unit, scattered, incident);
    for (std::size_t to = 0; to < 16; ++to) {
      const double part = slopes.elements[to] * uncertainty.elements[from];
      squares.elements[to] += part * part;
      if (std::abs(slopes.elements[to]) > counts && uncertainty.elements[from] == 0) known[to] = false;
    }
  }
  for (std::size_t e = 0; e < 16; ++e) squares.elements[e] = known[e] ? std::sqrt(squares.elements[e]) : 0;
  return squares;
}

Direction random_direction(std::mt19937_64& engine, double theta_max) {
  const double sine = std::sin(theta_max) * std::sqrt(uniform(engine));
  const double phi = std::numbers::pi * (2 * uniform(engine) - 1);
  return {std::min(std::asin(sine), theta_max), phi};
}

}  // namespace

bool same_wavelength(double a, double b) { return std::abs(a - b) <= wavelength_resolution; }

std::size_t wavelength_index(std::span<const double> wavelengths, double wavelength) {
  const auto at = std::ranges::partition_point(
      wavelengths, [=](double other) { return other < wavelength && !same_wavelength(wavelength, other); });
  const bool there = at != wavelengths.end() && same_wavelength(wavelength, *at);
  return there ? static_cast<std::size_t>(at - wavelengths.begin()) : wavelengths.size();
}

std::vector<double> wavelengths(std::span<const Sample> samples) {
  std::vector<double> sorted;
  sorted.reserve(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    require_wavelength(samples[i], i);
    sorted.push_back(samples[i].wavelength);
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<double> distinct;
  for (double wavelength : sorted)
    if (distinct.empty() || !same_wavelength(wavelength, distinct.back())) distinct.push_back(wavelength);
  return distinct;
}

std::vector<Sample> at_wavelengths(std::span<const Sample> samples, std::span<const double> wanted) {
  const std::vector<double> present = wavelengths(samples);
  for (double wavelength : wanted) require_samples_at(present, wavelength);
  std::vector<Sample> kept;
  std::copy_if(samples.begin(), samples.end(), std::back_inserter(kept), [&](const Sample& sample) {
    return std::any_of(wanted.begin(), wanted.end(),
                       [&](double wavelength) { return same_wavelength(wavelength, sample.wavelength); });
  });
  return kept;
}

Sides side(const Geometry& geometry) {
  const auto& [incident, reflected] = geometry;
  const double out = std::sin(reflected.phi - incident.phi) * std::sin(std::min(incident.theta, reflected.theta));
  if (std::abs(out) <= std::sin(side_tolerance)) return plane_of_incidence;
  return out < 0 ? negative_side : positive_side;
}

Sample in_own_frame(const Sample& sample) {
  Sample result = sample;
  if (sample.as_measured) {
    result.normalized = sample.as_measured->normalized;
    result.uncertainty = sample.as_measured->uncertainty;
    result.as_measured.reset();
  }
  return result;
}

Elements not_measured(const Sample& sample) {
  Elements result = unknown_elements(sample.normalized);
  result[0] = std::isnan(sample.f11);
  return result;
}

Elements not_measured(std::span<const Sample> samples) {
  Elements result;
  result.set();
  for (const Sample& sample : samples) result &= not_measured(sample);
  return result;
}

std::vector<SamplesInFrame> by_own_frame(std::span<const Sample> samples) {
  std::vector<SamplesInFrame> result;
  for (const Frame frame : {Frame::xy, Frame::sp, Frame::scattering_plane}) {
    SamplesInFrame here{frame, 0, {}};
    for (const Sample& sample : samples)
      if (own_frame(sample) == frame) ++here.samples, here.measured |= ~not_measured(in_own_frame(sample));
    if (here.samples > 0) result.push_back(here);
  }
  return result;
}

Elements measured_elements(std::span<const Sample> samples) {
  Elements result;
  for (const SamplesInFrame& here : by_own_frame(samples)) result |= here.measured;
  return result;
}

std::string sample_element(std::size_t element) { return (element == 0 ? "f" : "m") + element_name(element); }

bool has_uncertainty(const Sample& sample) {
  const auto& all = sample.uncertainty.elements;
  return std::any_of(all.begin(), all.end(), [](double u) { return u != 0; });
}

void require_valid(std::span<const Sample> samples) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Sample& sample = samples[i];
    const std::string name = "sample " + std::to_string(i + 1);
    require_wavelength(sample, i);
    require_valid(sample.geometry, name.c_str());
    require_valid_elements(sample, name);
    if (sample.as_measured)
      require_valid_elements({sample.wavelength, sample.geometry, sample.f11, sample.as_measured->normalized,
                              sample.as_measured->uncertainty},
                             name);
    if (not_measured(sample).all()) throw std::invalid_argument(name + ": nothing is measured");
  }
}

Sample turned(const Sample& sample, double angle) {
  Sample result = sample;
  result.normalized = turned(sample.normalized, angle);
  if (has_uncertainty(sample)) result.uncertainty = rotated_uncertainty(sample.uncertainty, -angle, angle);
  result.geometry.incident.phi += angle;
  result.geometry.reflected.phi += angle;
  return result;
}

Sample at_zero_azimuth(const Sample& sample) { return turned(sample, -sample.geometry.incident.phi); }

Sample from_frame(const Sample& sample, Frame frame) {
  const FrameAngles angles = angles_to_xy(sample.geometry, frame);
  Sample result = sample;
  result.given_in = frame;
  result.normalized = rotated(sample.normalized, angles.scattered, angles.incident);
  if (has_uncertainty(sample))
    result.uncertainty = rotated_uncertainty(sample.uncertainty, angles.scattered, angles.incident);
  if ((not_measured(result) & ~not_measured(sample)).any())
    result.as_measured = std::make_shared<const AsMeasured>(AsMeasured{frame, sample.normalized, sample.uncertainty});
  return result;
}

Sample in_frame(const Sample& sample, Frame frame) {
  if (own_frame(sample) == frame) return in_own_frame(sample);
  Sample result = sample;
  result.as_measured.reset();
  if (frame == Frame::xy) return result;
  const FrameAngles angles = angles_to_xy(sample.geometry, frame);
  result.normalized = rotated(sample.normalized, -angles.scattered, -angles.incident);
  if (has_uncertainty(sample))
    result.uncertainty = rotated_uncertainty(sample.uncertainty, -angles.scattered, -angles.incident);
  return result;
}

Mueller measured_matrix(const Sample& sample) {
  Mueller result = sample.f11 * sample.normalized;
  result(0, 0) = sample.f11;
  return result;
}

MuellerCovariance covariance(const Sample& sample) {
  const auto variance = [&](std::size_t e) {
    const double u = sample.uncertainty.elements[e];
    return u > 0 ? u * u : std::numeric_limits<double>::quiet_NaN();
  };
  Mueller slopes = sample.normalized;  // of F over f11
  slopes(0, 0) = 1;
  MuellerCovariance result;
  for (std::size_t e = 0; e < 16; ++e)
    for (std::size_t other = 0; other < 16; ++other)
      result(e, other) = slopes.elements[e] * slopes.elements[other] * variance(0);
  for (std::size_t e = 1; e < 16; ++e) result(e, e) += sample.f11 * sample.f11 * variance(e);
  set_unknown(result, not_measured(sample));
  return result;
}

std::vector<std::size_t> grouped(std::span<const double> values, double tolerance) {
  std::vector<std::size_t> order(values.size()), result(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::size_t group = 0;
  for (std::size_t q = 0; q < order.size(); ++q) {
    if (q > 0 && values[order[q]] - values[order[q - 1]] > tolerance) ++group;
    result[order[q]] = group;
  }
  return result;
}

std::vector<Geometry> germer2017_grid() {
  const double receiver = 2 * std::sin(radians(5) / 2);  // it blocks the beam nearer than this chord
  std::vector<Geometry> grid;
  for (int theta_i = 0; theta_i <= 75; theta_i += 15) {
    const Direction incident{radians(theta_i), std::numbers::pi};
    for (int i = -9; i <= 9; ++i)
      for (int j = -9; j <= 9; ++j) {
        if (i * i + j * j >= 100) continue;
        const Direction reflected = from_cosines(0.1 * i, 0.1 * j);
        if (distance(incident, reflected) >= receiver) grid.push_back({incident, reflected});
      }
  }
  return grid;
}

std::vector<Geometry> random_geometries(int count, unsigned long seed, double theta_max) {
  if (count < 0) throw std::invalid_argument("count = " + std::to_string(count) + ", must not be negative");
  if (!(theta_max > 0 && theta_max <= radians(90)))
    throw std::invalid_argument("theta_max = " + shortest(in_degrees(theta_max)) + " degrees, must be in (0, 90]");
  std::mt19937_64 engine(seed);
  std::vector<Geometry> geometries(static_cast<std::size_t>(count));
  for (Geometry& geometry : geometries) {
    geometry.incident = random_direction(engine, theta_max);
    geometry.reflected = random_direction(engine, theta_max);
  }
  return geometries;
}

}  // namespace mmbrdf
