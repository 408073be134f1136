// SPDX-License-Identifier: BSD-3-Clause
/// Directions drawn for incident ones, and their density (theory 5.3).
#pragma once

#include "model/kernel/kernel.hpp"
#include "model/kernel/kernel_blend.hpp"
#include "model/kernel/kernel_geometry.hpp"

namespace mmbrdf::MMBRDF_ISA {
namespace {

// ---- the map --------------------------------------------------------------------------------------------------------

constexpr double reciprocal_area = 1.0 / (SamplingTables::steps * SamplingTables::steps);

/// A place on the projected hemisphere, in coordinates in which equal areas are equal projected solid angles; and the density
/// there, per projected solid angle times π: 1 for the perfect diffuser.
struct Mapped {
  Pack<double> v, azimuth, density;  // sin² theta_r;  phi_r − phi_i, in [−π, π]
};

template <class Blend>
MMBRDF_INLINE Mapped map(const Blend& blend, bool folded, Pack<double> u1, Pack<double> u2) {
  using R = Pack<double>;
  const Step j = step(u1, SamplingTables::steps);
  const Step k = step(folded ? absolute(fms(R(2.0), u2, R(1.0))) : u2, SamplingTables::steps);
  const Bits at_v = integer(j.whole),
             at_share = integer(fma(j.whole + R(1.0), R(double(SamplingTables::row)), k.whole));
  const R v = blend.at(at_v), dv = blend.at(at_v + 1) - v;
  const R share = blend.share(at_share, j.within), dshare = blend.share(at_share + 1, j.within) - share;
  const R reached = least(fma(k.within, dshare, share), R(1.0));  // which rounding may pass
  const R azimuth = folded ? copy_sign(R(pi) * reached, u2 - R(0.5)) : R(pi) * fms(R(2.0), reached, R(1.0));
  return {fma(j.within, dv, v), azimuth, R(reciprocal_area) / (dv * dshare)};
}

/// The step of a rising row that holds a value.
MMBRDF_INLINE int step_of(double value, const double* rising) {
  int begun = 0;
  for (int n = 0; n < SamplingTables::steps; ++n) begun += rising[n] <= value;
  return begun > 0 ? begun - 1 : 0;
}

/// What map() has at a place, of one incident direction: the lanes are the steps of a row.
template <class Blend>
MMBRDF_INLINE double density(const Blend& blend, double v, double share) {
  constexpr int width = Pack<double>::width, row = SamplingTables::row;
  double rising[SamplingTables::padded_row];
  for (int n = 0; n < row; n += width) store(blend.row(n), rising + n);
  const int j = step_of(v, rising);
  const double dv = rising[j + 1] - rising[j], within = (v - rising[j]) / dv;
  const Pack<double> between(within < 0 ? 0 : within > 1 ? 1 : within);
  for (int n = 0; n < row; n += width) {
    const Pack<double> low = blend.row((j + 1) * row + n), high = blend.row((j + 2) * row + n);
    store(fma(between, high - low, low), rising + n);
  }
  const int k = step_of(share, rising);
  return reciprocal_area / (dv * (rising[k + 1] - rising[k]));
}

// ---- what the kernel does -------------------------------------------------------------------------------------------

/// The largest sin² theta_r that is drawn: at the horizon itself weights would be 0/0.
constexpr double largest_v = 1 - 0x1p-52;

/// Density per solid angle of one per projected solid angle times π.
MMBRDF_INLINE Pack<double> per_solid_angle(Pack<double> density, Pack<double> cos_theta) {
  return density * cos_theta * Pack<double>(1 / pi);
}

template <bool angles>
MMBRDF_INLINE void put_drawn(const Incidence& from, const Mapped& mapped, SamplingBlock& block, size_t q) {
  using R = Pack<double>;
  const R v = least(mapped.v, R(largest_v)), cos_theta = sqrt(R(1.0) - v), sin_theta = sqrt(v);
  const auto put = [&](int column, R value) { store(value, block.reflected[column] + q); };
  if constexpr (angles) {
    put(0, angle_of({cos_theta, sin_theta}));
    put(1, mapped.azimuth);
  } else {
    const Complex<R> across = sin_theta * (circle(mapped.azimuth) * from.azimuth);
    put(0, across.re);
    put(1, across.im);
    put(2, cos_theta);
  }
  store(per_solid_angle(mapped.density, cos_theta), block.pdf + q);
}

template <bool angles, class Read>
void draw_all(const SamplingTables& tables, SamplingBlock& block, size_t count) {
  for (size_t q = 0; q < count; q += Pack<double>::width) {
    const Incidence from = incidence<angles, Read>(block, q);
    const auto u1 = Read::column(block.u[0] + q), u2 = Read::column(block.u[1] + q);
    with_blend<Read>(tables, from,
                     [&](const auto& blend) { put_drawn<angles>(from, map(blend, tables.folded, u1, u2), block, q); });
  }
}

void draw(const SamplingTables& tables, SamplingBlock& block, size_t count) {
  if (count == 1) return (block.angles ? draw_all<true, Alone> : draw_all<false, Alone>)(tables, block, count);
  (block.angles ? draw_all<true, Each> : draw_all<false, Each>)(tables, block, count);
}

struct Reflected {
  Pack<double> v, azimuth, cos_theta;
};

template <bool angles>
MMBRDF_INLINE Reflected reflected(const Incidence& from, const SamplingBlock& block) {
  using R = Pack<double>;
  const auto in = [&](int j) { return Alone::column(block.reflected[j]); };
  if constexpr (angles) {
    const Complex<R> polar = circle(in(0));
    return {polar.im * polar.im, in(1), greatest(polar.re, R(0.0))};
  } else {
    const R area = fma(in(0), in(0), in(1) * in(1)), square = fma(in(2), in(2), area);
    // Not √(1 − v), which next to the horizon is what rounding left.
    return {area / square, angle_of(times_conj(phase(Complex<R>{in(0), in(1)}), from.azimuth)), in(2) / sqrt(square)};
  }
}

template <bool angles>
void pdf_of(const SamplingTables& tables, SamplingBlock& block) {
  const Incidence from = incidence<angles, Alone>(block, 0);
  const Reflected to = reflected<angles>(from, block);
  const double azimuth = to.azimuth.v[0];
  const double share = tables.folded ? (azimuth < 0 ? -azimuth : azimuth) / pi : azimuth / (2 * pi) + 0.5;
  with_blend<Alone>(tables, from, [&](const auto& blend) {
    store(per_solid_angle(Pack<double>(density(blend, to.v.v[0], share)), to.cos_theta), block.pdf);
  });
}

void pdf(const SamplingTables& tables, SamplingBlock& block) {
  (block.angles ? pdf_of<true> : pdf_of<false>)(tables, block);
}

void table(const SamplingTables& tables, const SamplingBlock& block, double* out) {
  const Incidence at = block.angles ? incidence<true, Alone>(block, 0) : incidence<false, Alone>(block, 0);
  with_blend<Alone>(tables, at, [&](const auto& blend) {
    for (int n = 0; n < SamplingTables::size; n += Pack<double>::width) store(blend.row(n), out + n);
  });
}

}  // namespace
}  // namespace mmbrdf::MMBRDF_ISA
