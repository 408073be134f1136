// SPDX-License-Identifier: BSD-3-Clause
/// Some geometries on their way through the kernel. Part of variances.hpp, for variances.cpp.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "model/kernel/kernel.hpp"
#include "uncertainty/variances.hpp"

namespace mmbrdf {

inline constexpr long at_once = 24;  // geometries: whole tiles of each kernel, and their rows in the cache
inline constexpr double largest_azimuth = max_azimuth / 8;  // that of frames, doubled, is a sum of eight

inline long rounded_up(long n, long multiple) { return (n + multiple - 1) / multiple * multiple; }

/// Numbers that begin with a line of the cache.
class Numbers {
 public:
  void reserve(std::size_t count) { lines_.resize(std::max(lines_.size(), count / 8 + 1)); }
  double* data() { return lines_.front().values.data(); }
  const double* data() const { return lines_.front().values.data(); }

 private:
  struct alignas(64) Line {
    std::array<double, 8> values;
    Line() {}  // not zeros, which nobody reads
  };
  std::vector<Line> lines_;
};

constexpr std::size_t size(long n) { return static_cast<std::size_t>(n); }

inline double reduced(double phi) {
  return std::abs(phi) <= largest_azimuth ? phi : std::atan2(std::sin(phi), std::cos(phi));
}
inline Direction reduced(const Direction& d) { return {d.theta, reduced(d.phi)}; }

/// Elements that a turn of the axes mixes. With left angle, (x, y) of rows 2 and 3; with right angle of columns 2 and 3.
using Group = std::vector<std::size_t>;
inline const std::array<Group, 5> groups{{{1, 2}, {13, 14}, {4, 8}, {7, 11}, {5, 6, 9, 10}}};
inline constexpr std::array<std::array<std::size_t, 2>, 4> left_pairs{{{4, 8}, {5, 9}, {6, 10}, {7, 11}}},
    right_pairs{{{1, 2}, {5, 6}, {9, 10}, {13, 14}}};

/// Some geometries, and what is known of them. Number e of geometry g is at [e × stride + g]. Rows of elements stand side
/// by side: column j of the element at place p is at [j × row_stride + p × count + g].
struct Variances::Some {
  const VariancesKernel& kernel = best_variances_kernel();
  long count = 0, stride = 0;  // the latter a whole number of registers
  long row_stride = 0, row_count = 0;
  bool mixes = false;                  // a turn of the axes
  std::array<double*, 16> drawn_of{};  // elements; those of draw d are at [d × drawn_stride + g]
  long drawn_stride = 0;
  std::array<Geometry, size(at_once)> geometries;
  Numbers k_incident, k_reflected, rows, products, covariances, drawn;
  alignas(64) std::array<double, 16 * at_once> m, variances, of_rows;
  alignas(64) std::array<double, at_once> value, left_c, left_s, right_c, right_s;

  /// For those that follow each other from the first.
  void begin(std::span<const Geometry> some) {
    count = std::min(at_once, static_cast<long>(some.size()));
    stride = rounded_up(count, kernel.width);
    for (long g = 0; g < stride; ++g) {
      const Geometry& asked = some[size(std::min(g, count - 1))];
      geometries[size(g)] = {reduced(asked.incident), reduced(asked.reflected)};
    }
    std::fill_n(m.begin(), 16 * stride, 0.0);
    std::fill_n(variances.begin(), 16 * stride, 0.0);
  }

  /// Functions of the direction d(geometry), at the azimuth less that of turn(geometry).
  void set_functions(Numbers& to, int order, DiscMapping mapping, auto d, auto turn) {
    alignas(64) std::array<double, at_once> theta, phi;
    for (long g = 0; g < stride; ++g) {
      const Geometry& here = geometries[size(g)];
      theta[size(g)] = d(here).theta;
      phi[size(g)] = d(here).phi - turn(here);
    }
    to.reserve(size(zernike_count(order) * stride));
    kernel.functions(to.data(), order, mapping == DiscMapping::projected, theta.data(), phi.data(), stride, stride);
  }

  /// M → L M R from what the modes give into a frame, where that mixes anything.
  void set_turn(Frame frame, bool turns) {
    mixes = turns || frame != Frame::xy;
    if (!mixes) return;
    alignas(64) std::array<double, at_once> left, right;
    for (long g = 0; g < stride; ++g) {
      const Geometry& here = geometries[size(g)];
      const FrameAngles angles = angles_to_xy(here, frame);
      const double turn = turns ? here.incident.phi : 0;
      left[size(g)] = -angles.scattered - turn;
      right[size(g)] = turn - angles.incident;
    }
    kernel.double_angles(left_c.data(), left_s.data(), left.data(), stride);
    kernel.double_angles(right_c.data(), right_s.data(), right.data(), stride);
  }

  /// Room for rows of such columns. An odd number of lines apart, columns do not meet in the cache.
  double* begin_rows(std::size_t elements, long columns) {
    row_count = rounded_up(static_cast<long>(elements) * count, kernel.width);
    const long lines = std::max(row_count, static_cast<long>(elements) * count + stride - count) / 8 + 1;
    row_stride = 8 * (lines + 1 - lines % 2);
    rows.reserve(size(columns * row_stride));
    return rows.data();
  }

  /// Room for the elements of draws.
  double* begin_drawn(long draws) {
    drawn_stride = rounded_up(16 * count, kernel.width) + kernel.width;
    drawn.reserve(size(draws * drawn_stride));
    return drawn.data();
  }

  double* m_of(std::size_t element) { return m.data() + static_cast<long>(element) * stride; }
  double* variance_of(std::size_t element) { return variances.data() + static_cast<long>(element) * stride; }

  /// Elements of which there are such columns, turned.
  void turn(const std::array<double*, 16>& elements, long columns, long apart) const {
    for (const auto& [x, y] : left_pairs)
      if (elements[x] && elements[y])
        kernel.turn(elements[x], elements[y], left_c.data(), left_s.data(), columns, count, apart);
    for (const auto& [x, y] : right_pairs)
      if (elements[x] && elements[y])
        kernel.turn(elements[x], elements[y], right_c.data(), right_s.data(), columns, count, apart);
  }

  /// Adds a variance of an element to those of what it becomes.
  void spread(std::size_t element, const double* variance) {
    const bool in_rows = element / 4 == 1 || element / 4 == 2, in_columns = element % 4 == 1 || element % 4 == 2;
    const std::size_t across = element / 4 == 1 ? element + 4 : element - 4,
                      beside = element % 4 == 1 ? element + 1 : element - 1, opposite = across + beside - element;
    for (long g = 0; g < count; ++g) {
      const auto at = size(g);
      const double cl = left_c[at] * left_c[at], sl = left_s[at] * left_s[at], cr = right_c[at] * right_c[at],
                   sr = right_s[at] * right_s[at], v = variance[g];
      variance_of(element)[g] += (in_rows ? cl : 1) * (in_columns ? cr : 1) * v;
      if (in_rows) variance_of(across)[g] += sl * (in_columns ? cr : 1) * v;
      if (in_columns) variance_of(beside)[g] += (in_rows ? cl : 1) * sr * v;
      if (in_rows && in_columns) variance_of(opposite)[g] += sl * sr * v;
    }
  }
};

}  // namespace mmbrdf
