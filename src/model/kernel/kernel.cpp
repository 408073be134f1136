// SPDX-License-Identifier: BSD-3-Clause
// Compiled once for each instruction set, with MMBRDF_ISA as its name.
#include "model/kernel/kernel.hpp"

#include "model/kernel/kernel_frames.hpp"
#include "model/kernel/kernel_geometry.hpp"
#include "model/kernel/kernel_germer2017.hpp"
#include "model/kernel/kernel_incidence.hpp"
#include "model/kernel/kernel_isotropic.hpp"
#include "model/kernel/kernel_pairs.hpp"
#include "model/kernel/kernel_sampling.hpp"
#include "model/kernel/layouts.hpp"
#include "numerics/pack.hpp"

namespace mmbrdf::MMBRDF_ISA {
namespace {

/// Coefficients at the wavelength that was folded in.
template <class T>
struct Folded {
  static constexpr bool same_for_all_packs = true;
  const T* values;
  Folded() = default;
  MMBRDF_INLINE Folded(const KernelModel<T>& model, Pack<T>) : values(model.coefficients) {}
  MMBRDF_INLINE Pack<T> operator()(int i) const { return Pack<T>(values[i]); }
};

/// Coefficients at the wavelength of each point; any number of powers if it is not known here.
constexpr int any_powers = 0;
template <class T, int known_powers>
struct Spectral {
  static constexpr bool same_for_all_packs = false;
  const T* values;
  int powers, count;
  Pack<T> wavelength;
  Spectral() = default;
  MMBRDF_INLINE Spectral(const KernelModel<T>& model, Pack<T> at)
      : values(model.coefficients),
        powers(known_powers == any_powers ? model.powers : known_powers),
        count(model.count),
        wavelength(at) {}
  MMBRDF_INLINE Pack<T> operator()(int i) const {
    Pack<T> sum(values[powers * count + i]);
    for (int p = powers - 1; p >= 0; --p) sum = fma(sum, wavelength, Pack<T>(values[p * count + i]));
    return sum;
  }
};

/// The same for the straight lines, worked out before their use: a loop in each of hundreds of terms takes twice as long.
template <class T>
struct Tabulated {
  Pack<T> values[Germer2017Layout::count];  // of the form with most of them
  Tabulated(const KernelModel<T>& model, Pack<T> wavelength) {
    const Spectral<T, any_powers> at(model, wavelength);
    for (int i = 0; i < model.count; ++i) values[i] = at(i);
  }
  MMBRDF_INLINE Pack<T> operator()(int i) const { return values[i]; }
};

template <class R>
struct Place {
  Complex<R> i, r;
  Complex<R> turned;  // 1, or cos φi + i sin φi of what was taken off
};

/// The columns of KernelPoints, one number after the other, as many as fill a whole number of Packs.
template <class T>
struct Columns {
  bool angles;
  const T* column[6];
  const T *wavelength, *scale;
};

template <class T>
MMBRDF_INLINE Place<Pack<T>> place(const KernelModel<T>& model, const Columns<T>& points, size_t q) {
  using R = Pack<T>;
  const auto in = [&](int j) { return load(points.column[j] + q); };
  if constexpr (sizeof(T) == sizeof(double)) {
    if (points.angles) {
      const Complex<R> e_i = circle(in(1)), w_r = disc_radius(in(2), model.projected) * circle(in(3));
      const R rho_i = disc_radius(in(0), model.projected);
      if (!model.turned) return {rho_i * e_i, w_r, {}};
      return {{rho_i, R(T(0))}, times_conj(w_r, e_i), e_i};
    }
  }
  const Complex<R> w_i = disc_point(Vector<R>{in(0), in(1), in(2)}, model.projected);
  const Complex<R> w_r = disc_point(Vector<R>{in(3), in(4), in(5)}, model.projected);
  if (!model.turned) return {w_i, w_r, {}};
  const Complex<R> e_i = phase(w_i);
  return {{fma(w_i.re, e_i.re, w_i.im * e_i.im), R(T(0))}, times_conj(w_r, e_i), e_i};
}

template <class T>
MMBRDF_INLINE Complex<Pack<T>> reflected_place(const KernelModel<T>& model, const Columns<T>& points, size_t q) {
  const auto in = [&](int j) { return load(points.column[j] + q); };
  if constexpr (sizeof(T) == sizeof(double))
    if (points.angles) return disc_radius(in(0), model.projected) * circle(in(1));
  return disc_point(Vector<Pack<T>>{in(0), in(1), in(2)}, model.projected);
}

constexpr bool has_one_incident_direction(Form form) { return form == Form::plane || form == Form::functions; }

/// What a form needs of the directions.
template <Form form, class T>
MMBRDF_INLINE auto directions(const KernelModel<T>& model, const Columns<T>& points, size_t q) {
  if constexpr (form == Form::plane) {
    return reflected_place(model, points, q);
  } else if constexpr (form == Form::isotropic) {
    const auto in = [&](int j) { return load(points.column[j] + q); };
    if (!points.angles && !model.projected)
      return lambert_products(Vector<Pack<T>>{in(0), in(1), in(2)}, Vector<Pack<T>>{in(3), in(4), in(5)});
    const Place<Pack<T>> at = place(model, points, q);
    return products(at.i, at.r);
  } else {
    return place(model, points, q);
  }
}

template <bool one_incident_direction, class T>
MMBRDF_INLINE Turn<Pack<T>> turn_to_frame(const KernelModel<T>& model, const Columns<T>& points, size_t q) {
  using R = Pack<T>;
  const auto in = [&](int j) { return load(points.column[j] + q); };
  const auto vector = [&](int j) { return Vector<R>{in(j), in(j + 1), in(j + 2)}; };
  const auto incident = [&](int j) { return R(model.incident[j]); };
  const Complex<R> e_i{R(model.turned_by[0]), R(model.turned_by[1])};
  if constexpr (sizeof(T) == sizeof(double)) {
    const auto angles = [&](int j) { return Angles<R>{in(j), in(j + 1), circle(in(j + 1))}; };
    if (points.angles && one_incident_direction)
      return turn_to(model.frame, Angles<R>{incident(0), incident(1), e_i}, angles(0));
    if (points.angles) return turn_to(model.frame, angles(0), angles(2));
  }
  if constexpr (one_incident_direction) {
    const Vector<R> i{incident(2), incident(3), incident(4)};
    return turn_to(model.frame, i, vector(0), [&] { return square(e_i); });
  } else {
    const Vector<R> i = vector(0);
    return turn_to(model.frame, i, vector(3), [&] { return doubled_azimuth(i); });
  }
}

/// A function of its own, with its own copy of the matrix, so that evaluation in xy has all registers to itself.
template <bool one_incident_direction, class T>
[[gnu::noinline]] void apply_frame(const KernelModel<T>& model, const Columns<T>& points, size_t q, Pack<T>* f) {
  apply(turn_to_frame<one_incident_direction>(model, points, q), f);
}

template <Form form, class T>
MMBRDF_INLINE void into_frame(const KernelModel<T>& model, const Columns<T>& points, size_t q, Pack<T> (&f)[16]) {
  if (model.frame == KernelFrame::xy) [[likely]]
    return;
  Pack<T> copy[16];
  for (int e = 0; e < 16; ++e) copy[e] = f[e];
  apply_frame<has_one_incident_direction(form)>(model, points, q, copy);
  for (int e = 0; e < 16; ++e) f[e] = copy[e];
}

template <Form form, class T, class C, class Directions>
MMBRDF_INLINE void evaluate_pack(const C& a, const KernelModel<T>& model, Pack<T> scale, const Directions& at,
                                 Pack<T> (&f)[16]) {
  if constexpr (form == Form::isotropic) {
    isotropic(a, scale, at, f);
  } else if constexpr (form == Form::plane) {
    plane_of_incidence(a, scale, {Pack<T>(model.turned_by[0]), Pack<T>(model.turned_by[1])}, at, f);
  } else {
    germer2017(a, scale, at.i, at.r, f);
    if (model.turned) turn(at.turned, f);
  }
}

template <class T>
MMBRDF_INLINE void write(const Pack<T> (&f)[16], const KernelMatrices<T>& out, size_t q) {
  if (out.stride == 1) {
    for (int e = 0; e < 16; ++e) store(f[e], out.element[e] + q);
    return;
  }
  constexpr size_t width = Pack<T>::width;
  T values[16][width];
  for (int e = 0; e < 16; ++e) store(f[e], values[e]);
  T* const matrices = out.element[0] + 16 * q;
  for (size_t lane = 0; lane < width; ++lane)
    for (size_t e = 0; e < 16; ++e) matrices[16 * lane + e] = values[e][lane];
}

/// The directions of the next points are worked out beside the matrices of these: a square root and a division take
/// long, and nothing else waits for them.
template <class T, Form form, class Coefficients>
void evaluate_columns(const KernelModel<T>& model, const Columns<T>& points, const KernelMatrices<T>& out,
                      size_t count) {
  using R = Pack<T>;
  if (count == 0) return;
  auto at = directions<form>(model, points, 0);
  for (size_t q = 0; q < count; q += R::width) {
    const auto next = directions<form>(model, points, q + R::width < count ? q + R::width : q);
    const Coefficients a(model, points.wavelength ? load(points.wavelength + q) : R(T(0)));
    const R scale = points.wavelength ? load(points.scale + q) : R(model.scale);
    R f[16];
    evaluate_pack<form>(a, model, scale, at, f);
    into_frame<form>(model, points, q, f);
    write(f, out, q);
    at = next;
  }
}

/// The forms of any order, for several packs at a time; where there are fewer, the first is done twice.
template <class T, Form form, class Coefficients>
void evaluate_any_order(const KernelModel<T>& model, const Columns<T>& points, const KernelMatrices<T>& out,
                        size_t count) {
  using R = Pack<T>;
  const Complex<R> turned_by{R(model.turned_by[0]), R(model.turned_by[1])};
  for (size_t first = 0; first < count; first += packs_together * R::width) {
    size_t begin[packs_together];
    Complex<R> w_i[packs_together], w_r[packs_together], turned[packs_together];
    R scale[packs_together], f[packs_together][16];
    Coefficients a[packs_together];
    for (int h = 0; h < packs_together; ++h) {
      const size_t q = first + static_cast<size_t>(h) * R::width;
      begin[h] = q < count ? q : first;
      a[h] = Coefficients(model, points.wavelength ? load(points.wavelength + begin[h]) : R(T(0)));
      scale[h] = points.wavelength ? load(points.scale + begin[h]) : R(model.scale);
      if constexpr (form == Form::pairs) {
        const Place<R> at = place(model, points, begin[h]);
        w_i[h] = at.i, w_r[h] = at.r, turned[h] = at.turned;
      } else {
        const Complex<R> w = reflected_place(model, points, begin[h]);
        w_r[h] = model.turned ? times_conj(w, turned_by) : w, turned[h] = turned_by;
      }
    }
    if constexpr (form == Form::pairs)
      pairs(a, model.list, scale, w_i, w_r, f);
    else
      all_functions(a, model.list.order, scale, w_r, f);
    for (int h = 0; h < packs_together; ++h) {
      if (model.turned) turn(turned[h], f[h]);
      into_frame<form>(model, points, begin[h], f[h]);
      write(f[h], out, begin[h]);
    }
  }
}

template <class T>
void evaluate_columns(const KernelModel<T>& model, const Columns<T>& points, const KernelMatrices<T>& out,
                      size_t count) {
  const auto run = [&]<Form form>() {
    if (!points.wavelength) return evaluate_columns<T, form, Folded<T>>(model, points, out, count);
    if (model.powers == 1) return evaluate_columns<T, form, Spectral<T, 1>>(model, points, out, count);
    return evaluate_columns<T, form, Tabulated<T>>(model, points, out, count);
  };
  switch (model.form) {
    case Form::isotropic:
      return run.template operator()<Form::isotropic>();
    case Form::germer2017:
      return run.template operator()<Form::germer2017>();
    case Form::pairs:
      return points.wavelength ? evaluate_any_order<T, Form::pairs, Spectral<T, any_powers>>(model, points, out, count)
                               : evaluate_any_order<T, Form::pairs, Folded<T>>(model, points, out, count);
    case Form::plane:
      return evaluate_columns<T, Form::plane, Folded<T>>(model, points, out, count);
    case Form::functions:
      return evaluate_any_order<T, Form::functions, Folded<T>>(model, points, out, count);
  }
}

int column_count(Form form, bool angles) { return (angles ? 4 : 6) / (has_one_incident_direction(form) ? 2 : 1); }

/// A few points copied side by side; where there are fewer than fill a Pack, the last is repeated.
template <class T>
struct Block {
  static constexpr size_t width = Pack<T>::width, size = 8 * width;
  T values[8][size];

  void copy(const KernelPoints<T>& points, int columns, size_t first, size_t count) {
    const size_t padded = (count + width - 1) / width * width;
    const auto copy_column = [&](T* to, const T* from, ptrdiff_t stride) {
      // Whole vectors first: one that was written number by number cannot be read at once.
      store(Pack<T>(from[static_cast<ptrdiff_t>(first + count - 1) * stride]), to + padded - width);
      for (size_t q = 0; q + 1 < count; ++q) to[q] = from[static_cast<ptrdiff_t>(first + q) * stride];
    };
    for (int j = 0; j < columns; ++j) copy_column(values[j], points.column[j], points.stride);
    if (!points.wavelength) return;
    copy_column(values[6], points.wavelength, 1);
    copy_column(values[7], points.scale, 1);
  }
  Columns<T> columns(const KernelPoints<T>& points) const {
    Columns<T> result{points.angles, {}, nullptr, nullptr};
    for (int j = 0; j < 6; ++j) result.column[j] = values[j];
    if (points.wavelength) result.wavelength = values[6], result.scale = values[7];
    return result;
  }
};

template <class T>
KernelMatrices<T> beginning_at(const KernelMatrices<T>& out, size_t first) {
  KernelMatrices<T> result = out;
  for (T*& element : result.element) element += static_cast<ptrdiff_t>(first) * out.stride;
  return result;
}

/// Fewer points than a Pack has.
template <class T>
void evaluate_few(const KernelModel<T>& model, const Columns<T>& points, const KernelMatrices<T>& out, size_t count) {
  constexpr size_t width = Pack<T>::width;
  T values[16][width];
  KernelMatrices<T> all{{}, 1};
  for (int e = 0; e < 16; ++e) all.element[e] = values[e];
  evaluate_columns(model, points, all, width);
  for (size_t q = 0; q < count; ++q)
    for (int e = 0; e < 16; ++e) out.element[e][static_cast<ptrdiff_t>(q) * out.stride] = values[e][q];
}

template <class T>
void evaluate(const KernelModel<T>& model, const KernelPoints<T>& points, const KernelMatrices<T>& out, size_t count) {
  constexpr size_t width = Pack<T>::width;
  const int column_number = column_count(model.form, points.angles);
  size_t first = 0;
  if (points.stride == 1) {
    Columns<T> columns{points.angles, {}, points.wavelength, points.scale};
    for (int j = 0; j < column_number; ++j) columns.column[j] = points.column[j];
    first = count / width * width;
    evaluate_columns(model, columns, out, first);
  }
  Block<T> block;
  while (first < count) {
    const size_t left = count - first, whole = left / width * width, take = whole < block.size ? whole : block.size;
    const size_t copied = take > 0 ? take : left;
    block.copy(points, column_number, first, copied);
    if (take > 0)
      evaluate_columns(model, block.columns(points), beginning_at(out, first), take);
    else
      evaluate_few(model, block.columns(points), beginning_at(out, first), left);
    first += copied;
  }
}

/// As Spectral, for many coefficients in place of many wavelengths.
void fold(const KernelModel<double>& model, double wavelength, double* out) {
  using R = Pack<double>;
  const Spectral<double, any_powers> one_by_one(model, R(wavelength));
  int i = 0;
  for (; i + R::width <= model.count; i += R::width) {
    const auto of_power = [&](int p) { return load(model.coefficients + p * model.count + i); };
    R sum = of_power(model.powers);
    for (int p = model.powers - 1; p >= 0; --p) sum = fma(sum, R(wavelength), of_power(p));
    store(sum, out + i);
  }
  for (; i < model.count; ++i) out[i] = one_by_one(i).v[0];
}

template <class T>
size_t first_invalid(const T* const vectors[3], size_t count) {
  using R = Pack<T>;
  const auto square_excess = [](const auto& x, const auto& y, const auto& z, auto one) {
    return fma(x, x, fma(y, y, fma(z, z, -one)));
  };
  constexpr T limit = T(2e-6);
  size_t q = 0;
  while (q + R::width <= count) {
    auto valid = R(T(0)).v == R(T(0)).v;
    const size_t begin = q, left = (count - q) / R::width, packs = left < 64 ? left : 64;
    for (size_t i = 0; i < packs; ++i, q += R::width) {
      const R z = load(vectors[2] + q), e = square_excess(load(vectors[0] + q), load(vectors[1] + q), z, R(T(1)));
      valid &= (e.v < limit) & (e.v > -limit) & (z.v >= 0);
    }
    bool all = true;
    for (int lane = 0; lane < R::width; ++lane) all = all && valid[lane] != 0;
    if (!all) {
      q = begin;
      break;
    }
  }
  for (; q < count; ++q) {
    const T z = vectors[2][q], e = square_excess(vectors[0][q], vectors[1][q], z, T(1));
    if (!(e < limit && e > -limit && z >= 0)) break;
  }
  return q;
}

#define MMBRDF_TEXT(name) #name
#define MMBRDF_NAME(name) MMBRDF_TEXT(name)

}  // namespace

extern const Kernel kernel;
const Kernel kernel{MMBRDF_NAME(MMBRDF_ISA),
                    runs_here,
                    evaluate<double>,
                    evaluate<float>,
                    fold,
                    first_invalid<double>,
                    first_invalid<float>,
                    draw,
                    pdf,
                    table};

}  // namespace mmbrdf::MMBRDF_ISA
