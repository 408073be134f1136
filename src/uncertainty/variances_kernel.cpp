// SPDX-License-Identifier: BSD-3-Clause
// Compiled once for each instruction set, with MMBRDF_ISA as its name.
#include "uncertainty/variances_kernel.hpp"

#include "model/kernel/kernel_pairs.hpp"
#include "numerics/pack.hpp"

namespace mmbrdf::MMBRDF_ISA {
namespace {

using R = Pack<double>;
constexpr long width = R::width;

/// Registers of geometries that are worked on together: with four columns twelve sums, as many as hide that each waits
/// for the one before. Of a single register, three times four columns.
constexpr int most_packs = 3;
template <int packs>
constexpr int panels_of_symmetric = packs == 1 ? 3 : 1;
/// Of products of all columns as many as there are registers for: of a symmetric matrix that is more of its diagonal, twice.
constexpr int registers = width == 8 ? 32 : 16;
template <int packs>
constexpr int panels_of_products = (registers - most_packs - 1) / (columns_together * packs);

/// One number of each of their geometries.
template <int packs>
struct Packs {
  R of[static_cast<size_t>(packs)];
  MMBRDF_INLINE R& operator[](int p) { return of[p]; }
};
template <int packs>
MMBRDF_INLINE Packs<packs> zeros() {
  Packs<packs> result;
  for (R& r : result.of) r = R(0);
  return result;
}

/// Calls work.template operator()<packs>(first) for all of them.
template <class Work>
MMBRDF_INLINE void in_tiles(long count, Work work) {
  long first = 0;
  for (; first + most_packs * width <= count; first += most_packs * width) work.template operator()<most_packs>(first);
  for (; first < count; first += width) work.template operator()<1>(first);
}

void functions(double* k, int order, bool projected, const double* theta, const double* phi, long count, long stride) {
  Together<R> table[max_table];
  const int size = (order + 1) * (order + 2) / 2;
  for (long first = 0; first < count; first += packs_together * width) {
    Complex<R> points[packs_together];
    for (int h = 0; h < packs_together; ++h) {
      const long at = first + h * width < count ? first + h * width : first;
      points[h] = disc_radius(load(theta + at), projected) * circle(load(phi + at));
    }
    const Complex<R>* const all[1] = {points};
    Together<R>* const tables[1] = {table};
    zernike_values(order, all, tables);
    for (int h = 0; h < packs_together && first + h * width < count; ++h)
      for (int f = 0; f < size; ++f) store(table[f].pack[h], k + f * stride + first + h * width);
  }
}

template <int packs>
struct RowAt {
  double* row;
  long stride;
  const double *k_i, *k_r;
  long of_k;
  Packs<packs> value;

  /// A column of some terms, where a number that is known here makes a straight line.
  MMBRDF_INLINE void add(const RowTerm* terms, int count, int column, double coefficient) {
    Packs<packs> sum = zeros<packs>();
    for (int t = 0; t < count; ++t) {
      const double *const i = k_i + terms[t].incident * of_k, *const r = k_r + terms[t].reflected * of_k;
      for (int p = 0; p < packs; ++p)
        sum[p] = fma(R(terms[t].weight), load(i + p * width) * load(r + p * width), sum[p]);
    }
    for (int p = 0; p < packs; ++p) {
      store(sum[p], row + column * stride + p * width);
      value[p] = fma(R(coefficient), sum[p], value[p]);
    }
  }
};

constexpr int any_number = -1;
template <int known, int packs>
MMBRDF_INLINE void add_columns_of(RowAt<packs>& at, TermColumns& next, int terms) {
  const int each = known == any_number ? terms : known;
  for (int c = 0; c < next.with[terms]; ++c, next.terms += each)
    at.add(next.terms, each, next.column[c], next.coefficients[c]);
  next.column += next.with[terms];
  next.coefficients += next.with[terms];
}

template <int packs>
void rows_of(RowAt<packs> at, double* value, TermColumns columns) {
  at.value = zeros<packs>();
  for (int terms = 0; terms <= columns.most; ++terms) switch (terms) {
      case 1:
        add_columns_of<1>(at, columns, 1);
        break;
      case 2:
        add_columns_of<2>(at, columns, 2);
        break;
      case 4:
        add_columns_of<4>(at, columns, 4);
        break;
      default:
        add_columns_of<any_number>(at, columns, terms);
    }
  for (int p = 0; p < packs; ++p) store(at.value[p], value + p * width);
}

void rows(double* row, long stride, double* value, const TermColumns& columns, const double* k_i, const double* k_r,
          long of_k, long count) {
  in_tiles(count, [&]<int packs>(long first) {
    rows_of<packs>({row + first, stride, k_i + first, k_r + first, of_k, {}}, value + first, columns);
  });
}

/// Sums of four columns each.
template <int packs, int panels>
struct Columns {
  Packs<packs> of[static_cast<size_t>(columns_together * panels)];
  MMBRDF_INLINE Columns() {
    for (Packs<packs>& column : of) column = zeros<packs>();
  }
};

/// Adds entries begin … end of columns, times h.
template <int packs, int panels>
MMBRDF_INLINE void add_columns(Columns<packs, panels>& sum, const double* h, const PackedColumns& v, long panel,
                               long begin, long end, long stride) {
  const double* const values = v.values + panel * columns_together * v.rows;
  for (long k = begin; k < end; ++k) {
    Packs<packs> here;
    for (int p = 0; p < packs; ++p) here[p] = load(h + k * stride + p * width);
    for (int q = 0; q < panels; ++q)
      for (int j = 0; j < columns_together; ++j)
        for (int p = 0; p < packs; ++p) {
          R& to = sum.of[columns_together * q + j][p];
          to = fma(R(values[(q * v.rows + k) * columns_together + j]), here[p], to);
        }
  }
}

/// Adds Σ h_j (V h)_j over columns of some panels. What is above the blocks on the diagonal counts twice.
template <int panels, int packs>
MMBRDF_INLINE void add_variances(Packs<packs>& result, const double* h, const PackedColumns& v, long panel,
                                 long stride) {
  Columns<packs, panels> above;
  add_columns(above, h, v, panel, 0, panel * columns_together, stride);
  for (int q = 0; q < panels; ++q) {
    Columns<packs, 1> sum;
    for (int j = 0; j < columns_together; ++j) sum.of[j] = above.of[columns_together * q + j];
    const long first = (panel + q) * columns_together;
    add_columns(sum, h, v, panel + q, panel * columns_together, first, stride);
    for (Packs<packs>& column : sum.of)
      for (R& s : column.of) s = s + s;
    add_columns(sum, h, v, panel + q, first, first + columns_together, stride);
    for (int j = 0; j < columns_together; ++j)
      for (int p = 0; p < packs; ++p)
        result[p] = fma(sum.of[j][p], load(h + (first + j) * stride + p * width), result[p]);
  }
}

template <int packs>
void variances_of(double* out, const double* h, const PackedColumns& v, long stride) {
  constexpr int together = panels_of_symmetric<packs>;
  Packs<packs> result = zeros<packs>();
  const long panels = v.rows / columns_together;
  long panel = 0;
  for (; panel + together <= panels; panel += together) add_variances<together>(result, h, v, panel, stride);
  for (; panel < panels; ++panel) add_variances<1>(result, h, v, panel, stride);
  for (int p = 0; p < packs; ++p) store(result[p], out + p * width);
}

void variances(double* out, const double* h, const PackedColumns& v, long count, long stride) {
  in_tiles(count, [&]<int packs>(long first) { variances_of<packs>(out + first, h + first, v, stride); });
}

template <int panels, int packs>
MMBRDF_INLINE void products_of_panels(double* out, long out_stride, const double* h, const PackedColumns& v, long panel,
                                      long stride) {
  Columns<packs, panels> sum;
  add_columns(sum, h, v, panel, 0, v.rows, stride);
  for (int j = 0; j < columns_together * panels; ++j)
    for (int p = 0; p < packs; ++p) store(sum.of[j][p], out + (panel * columns_together + j) * out_stride + p * width);
}

template <int packs>
void products_of(double* out, long out_stride, const double* h, const PackedColumns& v, long stride) {
  constexpr int together = panels_of_products<packs>;
  const long panels = v.columns / columns_together;
  long panel = 0;
  for (; panel + together <= panels; panel += together)
    products_of_panels<together, packs>(out, out_stride, h, v, panel, stride);
  for (; panel < panels; ++panel) products_of_panels<1, packs>(out, out_stride, h, v, panel, stride);
}

void products(double* out, long out_stride, const double* h, const PackedColumns& v, long count, long stride) {
  in_tiles(count, [&]<int packs>(long first) { products_of<packs>(out + first, out_stride, h + first, v, stride); });
}

template <int packs>
MMBRDF_INLINE void dots_of(double* out, const double* x, const double* y, long columns, long stride) {
  Packs<packs> sum = zeros<packs>();
  for (long at = 0; at < columns * stride; at += stride)
    for (int p = 0; p < packs; ++p) sum[p] = fma(load(x + at + p * width), load(y + at + p * width), sum[p]);
  for (int p = 0; p < packs; ++p) store(sum[p], out + p * width);
}

void dots(double* out, const double* x, const double* y, long columns, long count, long stride) {
  const long whole = count / width * width;
  in_tiles(whole, [&]<int packs>(long first) { dots_of<packs>(out + first, x + first, y + first, columns, stride); });
  for (long g = whole; g < count; ++g) {
    double sum = 0;
    for (long at = g; at < g + columns * stride; at += stride) sum = fma(x[at], y[at], sum);
    out[g] = sum;
  }
}

void double_angles(double* cosine, double* sine, const double* angle, long count) {
  for (long g = 0; g < count; g += width) {
    const R a = load(angle + g);
    const Complex<R> e = circle(a + a);
    store(e.re, cosine + g);
    store(e.im, sine + g);
  }
}

template <class T>
MMBRDF_INLINE void turn_one(T& x, T& y, T c, T s) {
  const T a = x;
  x = fma(s, y, c * a);
  y = fma(-s, a, c * y);
}

void turn(double* x, double* y, const double* c, const double* s, long columns, long count, long stride) {
  long g = 0;
  for (; g + width <= count; g += width) {
    const R cosine = load(c + g), sine = load(s + g);
    for (long at = g; at < g + columns * stride; at += stride) {
      R a = load(x + at), b = load(y + at);
      turn_one(a, b, cosine, sine);
      store(a, x + at);
      store(b, y + at);
    }
  }
  for (; g < count; ++g)
    for (long at = g; at < g + columns * stride; at += stride) turn_one(x[at], y[at], c[g], s[g]);
}

void deviations(double* out, const double* m, const double* v, long count, long stride) {
  for (long g = 0; g < count; g += width) {
    const R f11 = load(m + g), v11 = load(v + g), square = f11 * f11;
    for (long e = 0; e < 16; ++e) {
      const R of_element = load(m + e * stride + g);
      const R variance = e == 0 ? v11 : fma(of_element * of_element, v11, square * load(v + e * stride + g));
      const R root = sqrt(select(variance.v < R(0).v, R(0), variance));
      for (long i = 0; i < width; ++i) out[16 * (g + i) + e] = root.v[i];
    }
  }
}

}  // namespace

extern const VariancesKernel variances_kernel;
const VariancesKernel variances_kernel{runs_here, width,         functions,  rows, variances,
                                       products,  double_angles, deviations, dots, turn};

}  // namespace mmbrdf::MMBRDF_ISA
