// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/model/sampling.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "mmbrdf/model/batch.hpp"
#include "model/sampling_map.hpp"
#include "model/unit_vectors.hpp"
#include "numerics/threads.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using std::numbers::pi;

/// The largest sin² theta_r that is drawn: at the horizon itself weights would be 0/0.
constexpr double largest_v = 1 - 0x1p-52;

/// So many directions for one incident one are drawn sooner with a table of their own.
constexpr std::size_t worth_a_table = 500;

// ---- what is asked --------------------------------------------------------------------------------------------------

bool is_valid(const Direction& d) { return d.theta >= 0 && d.theta <= radians(90) && std::isfinite(d.phi); }
void require_valid(const Direction& incident) { mmbrdf::require_valid(Geometry{incident, {}}); }
bool is_valid(const Vector3& v) { return is_unit_vector(v); }
void require_valid(const Vector3& v) { require_unit_vector(v, "incident vector"); }

bool is_valid(const UnitPoint& u) { return u[0] >= 0 && u[0] < 1 && u[1] >= 0 && u[1] < 1; }
void require_valid(const UnitPoint& u) {
  if (!is_valid(u))
    throw std::invalid_argument("u = (" + shortest(u[0]) + ", " + shortest(u[1]) + "): both must be in [0, 1)");
}

template <class T>
void require_all_valid(std::span<const T> values, int threads) {
  const std::size_t bad = first_found(values.size(), threads, [&](std::size_t first, std::size_t count) {
    const auto part = values.subspan(first, count);
    const auto found = std::find_if_not(part.begin(), part.end(), [](const T& value) { return is_valid(value); });
    return first + static_cast<std::size_t>(found - part.begin());
  });
  if (bad < values.size()) require_valid(values[bad]);  // throws
}

void require_sizes(std::size_t incident, std::size_t asked, std::size_t room) {
  if (asked != room)
    throw std::invalid_argument(std::to_string(asked) + " directions asked for, room for " + std::to_string(room));
  if (incident != asked && incident != 1)
    throw std::invalid_argument(std::to_string(incident) + " incident directions for " + std::to_string(asked) +
                                ": expected as many, or one for all");
}

// ---- one direction --------------------------------------------------------------------------------------------------

double between_minus_pi_and_pi(double azimuth) {
  return std::abs(azimuth) <= pi ? azimuth : std::remainder(azimuth, 2 * pi);
}

/// Density per solid angle of one per projected solid angle times π.
double per_solid_angle(double density, double cos_theta) { return density * cos_theta / pi; }

/// An incident direction, as the tables have it.
SamplingMap::Incidence incidence(const SamplingMap&, const Direction& incident) {
  return {std::numbers::sqrt2 * std::sin(incident.theta / 2), incident.phi};
}

/// What a vector of nearly length 1 says of its direction.
struct Polar {
  double v, cos_theta, cos_phi, sin_phi;
};

Polar polar(const Vector3& vector) {
  const double across = vector[0] * vector[0] + vector[1] * vector[1];
  const double squared = across + vector[2] * vector[2], length = std::sqrt(across);
  if (length == 0) return {0, 1, 1, 0};
  // Not √(1 − v), which next to the horizon is what rounding left.
  return {across / squared, vector[2] / std::sqrt(squared), vector[0] / length, vector[1] / length};
}

SamplingMap::Incidence incidence(const SamplingMap& map, const Polar& incident) {
  return {std::sqrt(incident.v / (1 + incident.cos_theta)),
          map.depends_on_incident_azimuth() ? std::atan2(incident.sin_phi, incident.cos_phi) : 0};
}

/// What is the same for all that is drawn for one incident direction.
struct From {
  SamplingMap::Incidence incidence;
  double phi;
};
From from(const SamplingMap& map, const Direction& incident) { return {incidence(map, incident), incident.phi}; }

struct FromVector {
  SamplingMap::Incidence incidence;
  double cos_phi, sin_phi;
};
FromVector from(const SamplingMap& map, const Vector3& incident) {
  const Polar at = polar(incident);
  return {incidence(map, at), at.cos_phi, at.sin_phi};
}

SampledDirection drawn(const From& from, const SamplingMap::Mapped& mapped) {
  const double v = std::min(mapped.place.v, largest_v), cos_theta = std::sqrt(1 - v);
  return {{std::acos(cos_theta), from.phi + mapped.place.azimuth}, per_solid_angle(mapped.density, cos_theta)};
}

SampledVector drawn(const FromVector& from, const SamplingMap::Mapped& mapped) {
  const double v = std::min(mapped.place.v, largest_v), cos_theta = std::sqrt(1 - v), sin_theta = std::sqrt(v);
  const double c = sin_theta * std::cos(mapped.place.azimuth), s = sin_theta * std::sin(mapped.place.azimuth);
  return {{c * from.cos_phi - s * from.sin_phi, s * from.cos_phi + c * from.sin_phi, cos_theta},
          per_solid_angle(mapped.density, cos_theta)};
}

auto drawn(const SamplingMap& map, const auto& incident, const UnitPoint& u) {
  const auto begin = from(map, incident);
  return drawn(begin, map.map(begin.incidence, u));
}

template <class Sampled>
void require_pdfs(std::span<const Sampled> drawn) {
  for (const Sampled& one : drawn)
    if (!(one.pdf > 0 && std::isfinite(one.pdf)))
      throw std::invalid_argument("pdf = " + shortest(one.pdf) + ", must be positive: was the direction drawn?");
}

/// sample() of many.
template <class Incident, class Sampled>
void draw(const SamplingMap& map, std::span<const Incident> incident, std::span<const UnitPoint> u,
          std::span<Sampled> out, int threads) {
  require_sizes(incident.size(), u.size(), out.size());
  require_all_valid(incident, threads);
  require_all_valid(u, threads);
  if (incident.size() == 1 && u.size() > worth_a_table) {
    const auto begin = from(map, incident.front());
    const SamplingMap::Table table = map.table(begin.incidence);
    return in_parts(u.size(), threads, [&](std::size_t first, std::size_t count) {
      for (std::size_t q = first; q < first + count; ++q) out[q] = drawn(begin, map.map(table, u[q]));
    });
  }
  const std::size_t each = incident.size() == 1 ? 0 : 1;
  in_parts(u.size(), threads, [&](std::size_t first, std::size_t count) {
    for (std::size_t q = first; q < first + count; ++q) out[q] = drawn(map, incident[each * q], u[q]);
  });
}

}  // namespace

DirectionSampler::DirectionSampler(const PreparedModel& model)
    : model_(model), map_(std::make_shared<const SamplingMap>(model)) {}

SampledDirection DirectionSampler::sample(const Direction& incident, const UnitPoint& u) const {
  require_valid(incident);
  require_valid(u);
  return drawn(*map_, incident, u);
}

SampledVector DirectionSampler::sample(const Vector3& incident, const UnitPoint& u) const {
  require_valid(incident);
  require_valid(u);
  return drawn(*map_, incident, u);
}

double DirectionSampler::pdf(const Direction& incident, const Direction& reflected) const {
  const bool below = reflected.theta > radians(90) && reflected.theta <= radians(180);
  mmbrdf::require_valid(Geometry{incident, {below ? 0 : reflected.theta, reflected.phi}});
  if (below) return 0;
  const double cos_theta = std::max(0.0, std::cos(reflected.theta)), sin_theta = std::sin(reflected.theta);
  const double azimuth = between_minus_pi_and_pi(reflected.phi - incident.phi);
  return per_solid_angle(map_->density(incidence(*map_, incident), {sin_theta * sin_theta, azimuth}), cos_theta);
}

double DirectionSampler::pdf(const Vector3& incident, const Vector3& reflected) const {
  require_valid(incident);
  if (reflected[2] < 0 && is_unit_vector({reflected[0], reflected[1], -reflected[2]})) return 0;
  require_unit_vector(reflected, "reflected vector");
  const Polar from = polar(incident), to = polar(reflected);
  const double azimuth = std::atan2(to.sin_phi * from.cos_phi - to.cos_phi * from.sin_phi,
                                    to.cos_phi * from.cos_phi + to.sin_phi * from.sin_phi);
  return per_solid_angle(map_->density(incidence(*map_, from), {to.v, azimuth}), to.cos_theta);
}

Mueller DirectionSampler::weight(const Direction& incident, const SampledDirection& drawn, Frame frame) const {
  Mueller m;
  weights(std::span(&incident, 1), std::span(&drawn, 1), frame, std::span(&m, 1));
  return m;
}

Mueller DirectionSampler::weight(const Vector3& incident, const SampledVector& drawn, Frame frame) const {
  Mueller m;
  weights(std::span(&incident, 1), std::span(&drawn, 1), frame, std::span(&m, 1));
  return m;
}

void DirectionSampler::sample(std::span<const Direction> incident, std::span<const UnitPoint> u,
                              std::span<SampledDirection> out, int threads) const {
  draw(*map_, incident, u, out, threads);
}

void DirectionSampler::sample(std::span<const Vector3> incident, std::span<const UnitPoint> u,
                              std::span<SampledVector> out, int threads) const {
  draw(*map_, incident, u, out, threads);
}

void DirectionSampler::weights(std::span<const Direction> incident, std::span<const SampledDirection> drawn,
                               Frame frame, std::span<Mueller> out, int threads) const {
  require_sizes(incident.size(), drawn.size(), out.size());
  require_pdfs(drawn);
  std::vector<Geometry> geometries(drawn.size());
  for (std::size_t q = 0; q < drawn.size(); ++q)
    geometries[q] = {incident[incident.size() == 1 ? 0 : q], drawn[q].reflected};
  evaluate(model_, geometries, out, {.frame = frame, .threads = threads});
  for (std::size_t q = 0; q < drawn.size(); ++q) out[q] = std::cos(drawn[q].reflected.theta) / drawn[q].pdf * out[q];
}

void DirectionSampler::weights(std::span<const Vector3> incident, std::span<const SampledVector> drawn, Frame frame,
                               std::span<Mueller> out, int threads) const {
  require_sizes(incident.size(), drawn.size(), out.size());
  require_pdfs(drawn);
  const std::size_t count = drawn.size();
  std::array<std::vector<double>, 3> from, to;
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t q = 0; q < count; ++q) from[c].push_back(incident[incident.size() == 1 ? 0 : q][c]);
    for (std::size_t q = 0; q < count; ++q) to[c].push_back(drawn[q].reflected[c]);
  }
  evaluate(model_, VectorGeometries<double>{{from[0], from[1], from[2]}, {to[0], to[1], to[2]}}, out,
           {.frame = frame, .threads = threads});
  for (std::size_t q = 0; q < count; ++q) out[q] = polar(drawn[q].reflected).cos_theta / drawn[q].pdf * out[q];
}

}  // namespace mmbrdf
