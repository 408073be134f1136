// SPDX-License-Identifier: BSD-3-Clause
#include "numerics/fold.hpp"

#include <algorithm>
#include <array>
#include <cmath>

// Column j of the new rows, B_j, is annihilated by the reflection 1 − τ v vᵀ, v = (1, w), that maps (T_jj, B_j) to
// (β, 0), with |w| ≤ 1; w takes the place of B_j. Four of them, of a panel of columns, make
//
//     1 − V Cᵀ Vᵀ,   V = (1; W),   C upper triangular (Schreiber and Van Loan 1989),
//
// which is applied to the columns behind the panel at once: y = Cᵀ (T + Wᵀ B), T −= y, B −= W y. So each number of B is
// read twice for four columns, and W stays in the first-level cache.

namespace mmbrdf {
namespace {

constexpr int width = 4;  // of a panel, and lanes of a sum

typedef double Pair __attribute__((vector_size(16)));

inline Pair load(const double* from) {
  Pair pair;
  __builtin_memcpy(&pair, from, sizeof pair);
  return pair;
}
inline void store(const Pair& pair, double* to) { __builtin_memcpy(to, &pair, sizeof pair); }

/// A sum over rows in four lanes, two in each register of the baseline.
struct Sum {
  Pair low{}, high{};
  void add(const double* w, Pair x_low, Pair x_high) {
    low += load(w) * x_low;
    high += load(w + 2) * x_high;
  }
  double total() const { return (low[0] + low[1]) + (high[0] + high[1]); }
};

/// Of columns whose number of rows is a multiple of 4.
double dot(const double* a, const double* b, std::size_t rows) {
  Sum sum;
  for (std::size_t i = 0; i < rows; i += width) sum.add(a + i, load(b + i), load(b + i + 2));
  return sum.total();
}

double norm(const double* a, std::size_t rows) {
  constexpr double small = 1e-280, large = 1e280;
  const double squares = dot(a, a, rows);
  if (squares > small && squares < large) return std::sqrt(squares);
  double largest = 0, sum = 0;
  for (std::size_t i = 0; i < rows; ++i) largest = std::max(largest, std::abs(a[i]));
  if (largest == 0) return 0;
  for (std::size_t i = 0; i < rows; ++i) sum += (a[i] / largest) * (a[i] / largest);
  return largest * std::sqrt(sum);
}

/// Up to four reflections. Those that are not there have τ = 0 and the w of another one.
struct Panel {
  std::array<const double*, width> w;
  double c[width][width] = {};

  /// Cᵀ z
  std::array<double, width> times(const std::array<double, width>& z) const {
    std::array<double, width> y{};
    for (int i = 0; i < width; ++i)
      for (int k = 0; k <= i; ++k) y[static_cast<std::size_t>(i)] += c[k][i] * z[static_cast<std::size_t>(k)];
    return y;
  }
};

/// Wᵀ B
std::array<double, width> dots(const Panel& panel, const double* b, std::size_t rows) {
  const auto [w0, w1, w2, w3] = panel.w;
  Sum s0, s1, s2, s3;
  for (std::size_t i = 0; i < rows; i += width) {
    const Pair low = load(b + i), high = load(b + i + 2);
    s0.add(w0 + i, low, high);
    s1.add(w1 + i, low, high);
    s2.add(w2 + i, low, high);
    s3.add(w3 + i, low, high);
  }
  return {s0.total(), s1.total(), s2.total(), s3.total()};
}

/// B −= W y
void subtract(const Panel& panel, const std::array<double, width>& y, double* b, std::size_t rows) {
  const auto [w0, w1, w2, w3] = panel.w;
  const Pair y0{y[0], y[0]}, y1{y[1], y[1]}, y2{y[2], y[2]}, y3{y[3], y[3]};
  for (std::size_t i = 0; i < rows; i += 2)
    store(load(b + i) - ((load(w0 + i) * y0 + load(w1 + i) * y1) + (load(w2 + i) * y2 + load(w3 + i) * y3)), b + i);
}

/// Applies the panel's reflections to a column; `t` are the numbers of the triangle in the rows of the panel.
void apply(const Panel& panel, int count, double* t, double* b, std::size_t rows) {
  std::array<double, width> z = dots(panel, b, rows);
  for (int i = 0; i < count; ++i) z[static_cast<std::size_t>(i)] += t[i];
  const std::array<double, width> y = panel.times(z);
  for (int i = 0; i < count; ++i) t[i] -= y[static_cast<std::size_t>(i)];
  subtract(panel, y, b, rows);
}

/// Makes reflection i of the panel from column b, which becomes w, and from the pivot. Returns whether there is one.
void make_reflection(Panel& panel, int i, double& pivot, double* b, std::size_t rows) {
  panel.w[static_cast<std::size_t>(i)] = b;
  const double length = norm(b, rows);
  if (length == 0) return;
  const double beta = -std::copysign(std::hypot(pivot, length), pivot);
  const double v = pivot - beta, tau = -v / beta;
  for (std::size_t r = 0; r < rows; ++r) b[r] /= v;
  pivot = beta;
  panel.c[i][i] = tau;
  for (int k = 0; k < i; ++k) {  // column i of C above the diagonal: −τ C (Wᵀ w)
    const double product = dot(panel.w[static_cast<std::size_t>(k)], b, rows);
    for (int row = 0; row <= k; ++row) panel.c[row][i] -= tau * panel.c[row][k] * product;
  }
}

}  // namespace

void fold(double* triangle, std::size_t unknowns, RowColumns& rows, Shape shape) {
  const std::size_t height = unknowns + 1;
  for (std::size_t first = 0; first < unknowns; first += width) {
    const int count = static_cast<int>(std::min<std::size_t>(width, unknowns - first));
    const std::size_t end = first + static_cast<std::size_t>(count);
    const std::size_t reached = shape == Shape::full ? rows.stride() : std::min((end + 3) / 4 * 4, rows.stride());
    Panel panel;
    panel.w.fill(rows.column(first));
    for (int i = 0; i < count; ++i) {
      const std::size_t j = first + static_cast<std::size_t>(i);
      if (i > 0) apply(panel, i, &triangle[j * height + first], rows.column(j), reached);
      make_reflection(panel, i, triangle[j * height + j], rows.column(j), reached);
    }
    for (std::size_t j = end; j < rows.columns(); ++j)
      apply(panel, count, &triangle[j * height + first], rows.column(j), reached);
  }
  for (std::size_t j = unknowns; j < rows.columns(); ++j) {
    double& left = triangle[j * height + unknowns];
    left = std::hypot(left, norm(rows.column(j), rows.stride()));
  }
}

}  // namespace mmbrdf
