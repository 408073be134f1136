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
#include "model/kernel/kernels.hpp"
#include "model/sampling_map.hpp"
#include "model/unit_vectors.hpp"
#include "numerics/threads.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

/// So many directions for one incident one are drawn sooner with a table of their own.
constexpr std::size_t worth_a_table = 500;

// ---- what is asked --------------------------------------------------------------------------------------------------

bool is_allowed(const Direction& d) { return d.theta >= 0 && d.theta <= radians(90) && std::isfinite(d.phi); }
void require_allowed(const Direction& incident) { require_valid(Geometry{incident, {}}); }
bool is_allowed(const Vector3& v) { return is_unit_vector(v); }
void require_allowed(const Vector3& v) { require_unit_vector(v, "incident vector"); }

bool is_allowed(const UnitPoint& u) { return u[0] >= 0 && u[0] < 1 && u[1] >= 0 && u[1] < 1; }
void require_allowed(const UnitPoint& u) {
  if (!is_allowed(u))
    throw std::invalid_argument("u = (" + shortest(u[0]) + ", " + shortest(u[1]) + "): both must be in [0, 1)");
}

template <class T>
void require_all_allowed(std::span<const T> values, int threads) {
  const std::size_t bad = first_found(values.size(), threads, [&](std::size_t first, std::size_t count) {
    const auto part = values.subspan(first, count);
    const auto found = std::find_if_not(part.begin(), part.end(), [](const T& value) { return is_allowed(value); });
    return first + static_cast<std::size_t>(found - part.begin());
  });
  if (bad < values.size()) require_allowed(values[bad]);  // throws
}

void require_sizes(std::size_t incident, std::size_t asked, std::size_t room) {
  if (asked != room)
    throw std::invalid_argument(std::to_string(asked) + " directions asked for, room for " + std::to_string(room));
  if (incident != asked && incident != 1)
    throw std::invalid_argument(std::to_string(incident) + " incident directions for " + std::to_string(asked) +
                                ": expected as many, or one for all");
}

// ---- blocks of the kernel -------------------------------------------------------------------------------------------

constexpr bool is_angles(const Direction&) { return true; }
constexpr bool is_angles(const Vector3&) { return false; }

void put(const Direction& d, double (&columns)[3][SamplingBlock::size], std::size_t q) {
  columns[0][q] = d.theta;
  columns[1][q] = d.phi;
}
void put(const Vector3& v, double (&columns)[3][SamplingBlock::size], std::size_t q) {
  for (std::size_t c = 0; c < 3; ++c) columns[c][q] = v[c];
}

SampledDirection drawn(const SamplingBlock& block, const Direction& incident, std::size_t q) {
  return {{block.reflected[0][q], incident.phi + block.reflected[1][q]}, block.pdf[q]};
}
SampledVector drawn(const SamplingBlock& block, const Vector3&, std::size_t q) {
  return {{block.reflected[0][q], block.reflected[1][q], block.reflected[2][q]}, block.pdf[q]};
}

/// Number q of many incident directions, or of one for all.
template <class Incident>
const Incident& of(std::span<const Incident> incident, std::size_t q) {
  return incident[incident.size() == 1 ? 0 : q];
}

/// At most a block of them, from number first on.
template <class Incident, class Sampled>
void draw_block(const SamplingTables& tables, std::span<const Incident> incident, std::span<const UnitPoint> u,
                std::span<Sampled> out, std::size_t first, std::size_t count) {
  SamplingBlock block;
  block.angles = is_angles(incident.front());
  for (std::size_t q = 0; q < count || q % SamplingBlock::multiple != 0; ++q) {
    const std::size_t asked = first + std::min(q, count - 1);
    put(of(incident, asked), block.incident, q);
    for (std::size_t c = 0; c < 2; ++c) block.u[c][q] = u[asked][c];
  }
  best_kernel().draw(tables, block, count);
  for (std::size_t q = 0; q < count; ++q) out[first + q] = drawn(block, of(incident, first + q), q);
}

template <class Incident>
SamplingBlock block_of(const Incident& incident) {
  SamplingBlock block;
  block.angles = is_angles(incident);
  put(incident, block.incident, 0);
  return block;
}

template <class Incident>
auto draw_one(const SamplingMap& map, const Incident& incident, const UnitPoint& u) {
  SamplingBlock block = block_of(incident);
  for (std::size_t c = 0; c < 2; ++c) block.u[c][0] = u[c];
  best_kernel().draw(map.tables(), block, 1);
  return drawn(block, incident, 0);
}

template <class T>
double pdf_of(const SamplingTables& tables, const T& incident, const T& reflected) {
  SamplingBlock block = block_of(incident);
  put(reflected, block.reflected, 0);
  best_kernel().pdf(tables, block);
  return block.pdf[0];
}

double between_minus_pi_and_pi(double azimuth) {
  return std::abs(azimuth) <= std::numbers::pi ? azimuth : std::remainder(azimuth, 2 * std::numbers::pi);
}

/// Of a vector of nearly length 1.
double cos_theta(const Vector3& v) { return v[2] / std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

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
  require_all_allowed(incident, threads);
  require_all_allowed(u, threads);
  SamplingTables tables = map.tables();
  std::vector<double> own;
  if (incident.size() == 1 && u.size() > worth_a_table) {
    own.resize(SamplingTables::size);
    best_kernel().table(tables, block_of(incident.front()), own.data());
    tables = {own.data(), tables.folded, true};
  }
  in_parts(u.size(), threads, [&](std::size_t first, std::size_t count) {
    for (const std::size_t end = first + count; first < end; first += SamplingBlock::size)
      draw_block(tables, incident, u, out, first, std::min(SamplingBlock::size, end - first));
  });
}

}  // namespace

DirectionSampler::DirectionSampler(const PreparedModel& model)
    : model_(model), map_(std::make_shared<const SamplingMap>(model)) {}

SampledDirection DirectionSampler::sample(const Direction& incident, const UnitPoint& u) const {
  require_allowed(incident);
  require_allowed(u);
  return draw_one(*map_, incident, u);
}

SampledVector DirectionSampler::sample(const Vector3& incident, const UnitPoint& u) const {
  require_allowed(incident);
  require_allowed(u);
  return draw_one(*map_, incident, u);
}

double DirectionSampler::pdf(const Direction& incident, const Direction& reflected) const {
  const bool below = reflected.theta > radians(90) && reflected.theta <= radians(180);
  require_valid(Geometry{incident, {below ? 0 : reflected.theta, reflected.phi}});
  if (below) return 0;
  const double azimuth = between_minus_pi_and_pi(reflected.phi - incident.phi);
  return pdf_of(map_->tables(), incident, {reflected.theta, azimuth});
}

double DirectionSampler::pdf(const Vector3& incident, const Vector3& reflected) const {
  require_allowed(incident);
  if (reflected[2] < 0 && is_unit_vector({reflected[0], reflected[1], -reflected[2]})) return 0;
  require_unit_vector(reflected, "reflected vector");
  return pdf_of(map_->tables(), incident, reflected);
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
  for (std::size_t q = 0; q < count; ++q) out[q] = cos_theta(drawn[q].reflected) / drawn[q].pdf * out[q];
}

}  // namespace mmbrdf
