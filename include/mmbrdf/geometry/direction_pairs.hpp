// SPDX-License-Identifier: BSD-3-Clause
/// Sets of pairs of directions, to a few degrees: where was measured, and where a model knows of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mmbrdf/geometry/geometry.hpp"

namespace mmbrdf {

/// Which of the nodes of a grid of pairs are in a set; a geometry counts as the node next to it. For isotropic samples
/// these are θi, θr in steps of 5 degrees and |φr − φi| in steps of 10, else θi, θr in steps of 10, φi, φr of 20.
class DirectionPairs {
 public:
  enum class Grid { isotropic, anisotropic };

  explicit DirectionPairs(Grid grid = Grid::isotropic);  ///< none of them
  /// A bit for each node, the lowest of a byte first. Throws std::invalid_argument for a number of bytes of no grid.
  explicit DirectionPairs(std::span<const std::uint8_t> bytes);

  void add(const Geometry& geometry) { add(node(geometry)); }
  void add(std::size_t node) { bytes_[node / 8] |= static_cast<std::uint8_t>(1U << (node % 8)); }
  void merge(const DirectionPairs& other);  ///< of the same grid: what either has
  void keep(const DirectionPairs& other);   ///< what both have

  bool contains(const Geometry& geometry) const { return contains(node(geometry)); }
  bool contains(std::size_t node) const { return (bytes_[node / 8] >> (node % 8) & 1U) != 0; }

  /// Whether all are in it whose polar angles are at most these, to the next node.
  bool reach(double theta_i, double theta_r) const;

  Grid grid() const { return grid_; }
  std::size_t nodes() const;                ///< of the grid
  std::size_t node(const Geometry&) const;  ///< next to a valid geometry
  Geometry geometry(std::size_t node) const;
  std::span<const std::uint8_t> bytes() const { return bytes_; }

  friend bool operator==(const DirectionPairs&, const DirectionPairs&) = default;

 private:
  Grid grid_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace mmbrdf
