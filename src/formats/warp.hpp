// SPDX-License-Identifier: BSD-3-Clause
// A density over the unit square, linear between the nodes of a grid, and the map that gives it to uniform samples.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace mmbrdf {

/// Values of a grid of ny rows of nx nodes, both 2 or more, at x and y in [0, 1], linear between them.
double bilinear(std::span<const double> grid, std::size_t nx, double x, double y);

/// Rows first, then within the row (Dupuy and Jakob, ACM Trans. Graph. 37, 274 (2018)).
class Warp {
 public:
  /// A density as for bilinear(), of any norm, without negative values.
  Warp(std::span<const double> density, std::size_t nx);

  /// Whether there is a density at all.
  bool valid() const { return rows_.back() > 0; }

  /// Where the sample (x, y) of the unit square goes.
  std::array<double, 2> operator()(double x, double y) const;

 private:
  std::vector<double> density_;
  std::size_t nx_, ny_;
  std::vector<double> within_;  // integrals along each row up to each node
  std::vector<double> rows_;    // of the rows up to each
};

}  // namespace mmbrdf
