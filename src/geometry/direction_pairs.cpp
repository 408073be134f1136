// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/geometry/direction_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace mmbrdf {
namespace {

constexpr double tie = 1e-9;  // of a step: half way goes up, however it was rounded

/// Steps and numbers of nodes: θ of either direction, φi, and φr or |φr − φi|.
struct GridAxes {
  double theta_step, phi_step;
  std::size_t theta, phi_i, phi_r;
  std::size_t nodes() const { return theta * theta * phi_i * phi_r; }
};
constexpr GridAxes grids[] = {{5, 10, 19, 1, 19}, {10, 20, 10, 18, 18}};
const GridAxes& axes(DirectionPairs::Grid grid) { return grids[static_cast<std::size_t>(grid)]; }

std::size_t bytes_for(std::size_t nodes) { return (nodes + 7) / 8; }

DirectionPairs::Grid grid_of(std::size_t bytes) {
  for (const auto grid : {DirectionPairs::Grid::isotropic, DirectionPairs::Grid::anisotropic})
    if (bytes == bytes_for(axes(grid).nodes())) return grid;
  throw std::invalid_argument(std::to_string(bytes) + " bytes are no set of pairs of directions");
}

/// Not negative.
std::size_t nearest(double angle, double step) {
  return static_cast<std::size_t>(angle * (180 / std::numbers::pi) / step + 0.5 + tie);
}

/// Of `count` in a circle.
std::size_t around(double phi, double step, std::size_t count) {
  const double turn = 2 * std::numbers::pi;
  return nearest(phi - turn * std::floor(phi / turn), step) % count;
}

}  // namespace

DirectionPairs::DirectionPairs(Grid grid) : grid_(grid), bytes_(bytes_for(axes(grid).nodes())) {}

DirectionPairs::DirectionPairs(std::span<const std::uint8_t> bytes)
    : grid_(grid_of(bytes.size())), bytes_(bytes.begin(), bytes.end()) {}

void DirectionPairs::merge(const DirectionPairs& other) {
  if (grid_ != other.grid_) throw std::invalid_argument("sets of pairs of directions of different grids");
  std::ranges::transform(bytes_, other.bytes_, bytes_.begin(),
                         [](unsigned a, unsigned b) { return static_cast<std::uint8_t>(a | b); });
}

bool DirectionPairs::reach(double theta_i, double theta_r) const {
  const GridAxes& a = axes(grid_);
  const std::size_t azimuths = a.phi_i * a.phi_r, last_i = nearest(theta_i, a.theta_step),
                    last_r = nearest(theta_r, a.theta_step);
  for (std::size_t i = 0; i <= last_i; ++i)
    for (std::size_t first = i * a.theta * azimuths, n = first; n < first + (last_r + 1) * azimuths; ++n)
      if (!contains(n)) return false;
  return true;
}

void DirectionPairs::keep(const DirectionPairs& other) {
  if (grid_ != other.grid_) throw std::invalid_argument("sets of pairs of directions of different grids");
  std::ranges::transform(bytes_, other.bytes_, bytes_.begin(),
                         [](unsigned a, unsigned b) { return static_cast<std::uint8_t>(a & b); });
}

std::size_t DirectionPairs::nodes() const { return axes(grid_).nodes(); }

std::size_t DirectionPairs::node(const Geometry& geometry) const {
  const GridAxes& a = axes(grid_);
  const auto& [i, r] = geometry;
  const std::size_t theta_i = nearest(i.theta, a.theta_step), theta_r = nearest(r.theta, a.theta_step);
  std::size_t phi_i = 0, phi_r = 0;
  if (grid_ == Grid::isotropic) {
    if (theta_i > 0 && theta_r > 0)  // else there is no azimuth between them
      phi_r = nearest(std::abs(std::remainder(r.phi - i.phi, 2 * std::numbers::pi)), a.phi_step);
  } else {
    if (theta_i > 0) phi_i = around(i.phi, a.phi_step, a.phi_i);
    if (theta_r > 0) phi_r = around(r.phi, a.phi_step, a.phi_r);
  }
  return ((theta_i * a.theta + theta_r) * a.phi_i + phi_i) * a.phi_r + phi_r;
}

Geometry DirectionPairs::geometry(std::size_t node) const {
  const GridAxes& a = axes(grid_);
  const auto radians = [](std::size_t steps, double step) {
    return static_cast<double>(steps) * step * (std::numbers::pi / 180);
  };
  const std::size_t phi_r = node % a.phi_r, phi_i = node / a.phi_r % a.phi_i, pair = node / (a.phi_r * a.phi_i);
  return {{radians(pair / a.theta, a.theta_step), radians(phi_i, a.phi_step)},
          {radians(pair % a.theta, a.theta_step), radians(phi_r, a.phi_step)}};
}

}  // namespace mmbrdf
