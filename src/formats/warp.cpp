// SPDX-License-Identifier: BSD-3-Clause
#include "formats/warp.hpp"

#include <algorithm>
#include <cmath>

namespace mmbrdf {
namespace {

/// Samples at the very ends would stay in front of a density that begins with 0.
constexpr double inner = 0x1p-24;

/// t in [0, 1] where a density that goes from a to b has its integral up to t equal to `area`.
double place(double a, double b, double area) {
  const double divisor = a + std::sqrt(std::max(0.0, a * a + 2 * area * (b - a)));
  return divisor > 0 ? std::clamp(2 * area / divisor, 0.0, 1.0) : 0;
}

}  // namespace

double bilinear(std::span<const double> grid, std::size_t nx, double x, double y) {
  const std::size_t ny = grid.size() / nx;
  const auto cell = [](double u, std::size_t nodes) {
    return std::min(static_cast<std::size_t>(std::max(0.0, u * static_cast<double>(nodes - 1))), nodes - 2);
  };
  const std::size_t column = cell(x, nx), row = cell(y, ny), at = row * nx + column;
  const double s = x * static_cast<double>(nx - 1) - static_cast<double>(column);
  const double t = y * static_cast<double>(ny - 1) - static_cast<double>(row);
  return (1 - t) * ((1 - s) * grid[at] + s * grid[at + 1]) + t * ((1 - s) * grid[at + nx] + s * grid[at + nx + 1]);
}

Warp::Warp(std::span<const double> density, std::size_t nx)
    : density_(density.begin(), density.end()), nx_(nx), ny_(density.size() / nx), within_(density.size()), rows_(ny_) {
  for (std::size_t y = 0; y < ny_; ++y)
    for (std::size_t x = 1; x < nx_; ++x) {
      const std::size_t at = y * nx_ + x;
      within_[at] = within_[at - 1] + (density_[at - 1] + density_[at]) / 2;
    }
  for (std::size_t y = 1; y < ny_; ++y)
    rows_[y] = rows_[y - 1] + (within_[y * nx_ - 1] + within_[(y + 1) * nx_ - 1]) / 2;
}

std::array<double, 2> Warp::operator()(double x, double y) const {
  double area = std::clamp(y, inner, 1 - inner) * rows_.back();
  const auto above = std::partition_point(rows_.begin() + 1, rows_.end() - 1, [&](double sum) { return sum < area; });
  const auto row = static_cast<std::size_t>(above - rows_.begin()) - 1;
  const double *lower = &within_[row * nx_], *upper = lower + nx_;
  const double t = place(lower[nx_ - 1], upper[nx_ - 1], area - rows_[row]);
  const auto within = [&](std::size_t column) { return (1 - t) * lower[column] + t * upper[column]; };
  area = std::clamp(x, inner, 1 - inner) * within(nx_ - 1);
  std::size_t column = 0;
  while (column + 2 < nx_ && within(column + 1) < area) ++column;
  const double* corner = &density_[row * nx_ + column];
  const double s =
      place((1 - t) * corner[0] + t * corner[nx_], (1 - t) * corner[1] + t * corner[nx_ + 1], area - within(column));
  return {(static_cast<double>(column) + s) / static_cast<double>(nx_ - 1),
          (static_cast<double>(row) + t) / static_cast<double>(ny_ - 1)};
}

}  // namespace mmbrdf
