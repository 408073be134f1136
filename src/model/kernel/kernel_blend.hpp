// SPDX-License-Identifier: BSD-3-Clause
/// Incident directions, and the mean of the tables around them from which others are drawn (theory 5.3). The lanes are points;
/// indices are whole numbers in floating point until numbers are gathered.
#pragma once

#include "model/kernel/kernel.hpp"
#include "model/kernel/kernel_geometry.hpp"

namespace mmbrdf::MMBRDF_ISA {
namespace {

constexpr double pi = 3.14159265358979323846;

// ---- whole numbers --------------------------------------------------------------------------------------------------

/// What is added to a number below 2⁵¹ to have it rounded to a whole one, in its last bits.
constexpr double to_last_bits = 0x1.8p52;

MMBRDF_INLINE Pack<double> floor_of(Pack<double> x) {
  using R = Pack<double>;
  const R nearest = (x + R(to_last_bits)) - R(to_last_bits);
  return select(nearest.v > x.v, nearest - R(1.0), nearest);
}

/// Of whole numbers from 0 to 2³².
MMBRDF_INLINE Bits integer(Pack<double> whole) { return bits_of(whole + Pack<double>(to_last_bits)) & 0xffffffffLL; }

/// How numbers are read: for a point in each lane.
struct Each {
  MMBRDF_INLINE static Pack<double> column(const double* from) { return load(from); }
  MMBRDF_INLINE static Pack<double> gather(const double* from, Bits index) {
#if defined(__AVX512F__)
    const __m512d none = {};  // all lanes by mask: see sqrt
    return _mm512_mask_i64gather_pd(none, 0xff, reinterpret_cast<__m512i>(index), from, 8);
#else
    Pack<double> r;
    for (int i = 0; i < Pack<double>::width; ++i) r.v[i] = from[index[i]];
    return r;
#endif
  }
};

/// For one point, in all lanes.
struct Alone {
  MMBRDF_INLINE static Pack<double> column(const double* from) { return Pack<double>(*from); }
  MMBRDF_INLINE static Pack<double> gather(const double* from, Bits index) { return Pack<double>(from[index[0]]); }
};

MMBRDF_INLINE Pack<double> least(Pack<double> a, Pack<double> b) { return select(a.v < b.v, a, b); }
MMBRDF_INLINE Pack<double> greatest(Pack<double> a, Pack<double> b) { return select(a.v > b.v, a, b); }

// ---- incident directions --------------------------------------------------------------------------------------------

/// In [−π, π], of cos x + i sin x: twice the arc tangent of half the angle to the nearest axis, by Taylor's series, where the
/// first term left out is below 1e-17.
MMBRDF_INLINE Pack<double> angle_of(Complex<Pack<double>> e) {
  using R = Pack<double>;
  const R x = absolute(e.re), y = absolute(e.im);
  const R tangent = least(x, y) / (R(1.0) + greatest(x, y)), square = tangent * tangent;
  const R fourth = square * square;
  R even(1.0 / 37), odd(1.0 / 39);  // two sums that do not wait for each other
  for (int n = 33; n > 0; n -= 4) {
    even = fma(even, fourth, R(1.0 / n));
    odd = fma(odd, fourth, R(1.0 / (n + 2)));
  }
  const R to_axis = (tangent + tangent) * fnma(odd, square, even);
  const R quadrant = select(y.v > x.v, R(pi / 2) - to_axis, to_axis);
  return copy_sign(select(e.re.v < 0, R(pi) - quadrant, quadrant), e.im);
}

/// An incident direction, as the tables have it.
struct Incidence {
  Pack<double> rho, turn;         // √(1 − cos theta_i);  phi_i / 2π, in [0, 1]
  Complex<Pack<double>> azimuth;  // cos phi_i + i sin phi_i, of vectors
};

MMBRDF_INLINE Pack<double> part_of_turn(Pack<double> phi) {
  using R = Pack<double>;
  const R turns = phi * R(1 / (2 * pi));
  return select(absolute(turns).v < 0x1p51, turns - floor_of(turns), R(0.0));  // larger ones are whole, or half
}

template <bool angles, class Read>
MMBRDF_INLINE Incidence incidence(const SamplingBlock& block, size_t q) {
  const auto in = [&](int j) { return Read::column(block.incident[j] + q); };
  if constexpr (angles) {
    return {disc_radius(in(0), false), part_of_turn(in(1)), {}};
  } else {
    const Lambert<Pack<double>> at(Vector<Pack<double>>{in(0), in(1), in(2)});
    const Complex<Pack<double>> azimuth = phase(Complex<Pack<double>>{in(0), in(1)});
    return {sqrt(at.area / at.denominator), part_of_turn(angle_of(azimuth)), azimuth};
  }
}

// ---- tables ---------------------------------------------------------------------------------------------------------

/// A place on an axis of steps: the step, and how far into it.
struct Step {
  Pack<double> whole, within;
};

/// Of 0 ≤ x ≤ 1; the end is in the last step.
MMBRDF_INLINE Step step(Pack<double> x, int count) {
  using R = Pack<double>;
  const R scaled = x * R(double(count)), whole = least(floor_of(scaled), R(count - 1.0));
  return {whole, scaled - whole};
}

/// The map of an incident direction: the mean of those of the nearest tables, 2 or 4 of them, or the one table that was made
/// of it. Each grows with u1, and at a given u1 with u2; so does their mean, whose density is the reciprocal of its Jacobian.
template <int corners, class Read>
struct Blend {
  const double* numbers;
  Bits corner[corners];
  Pack<double> weight[corners];

  MMBRDF_INLINE Blend(const SamplingTables& tables, const Incidence& at) : numbers(tables.numbers) {
    using R = Pack<double>;
    constexpr double size = SamplingTables::size, turns = SamplingTables::incident_azimuths;
    if constexpr (corners == 1) {
      corner[0] = Bits{};
      weight[0] = R(1.0);
      return;
    }
    const Step r = step(at.rho, SamplingTables::incident_steps);
    if constexpr (corners == 2) {
      corner[0] = integer(r.whole * R(size));
      corner[1] = corner[0] + SamplingTables::size;
      weight[0] = R(1.0) - r.within;
      weight[1] = r.within;
    }
    if constexpr (corners == 4) {
      const Step a = step(at.turn, SamplingTables::incident_azimuths);
      const R next = select(a.whole.v == turns - 1, R(0.0), a.whole + R(1.0)), first = r.whole * R(turns);
      corner[0] = integer((first + a.whole) * R(size));
      corner[1] = integer((first + next) * R(size));
      const R far = R(1.0) - r.within, before = R(1.0) - a.within;
      weight[0] = far * before;
      weight[1] = far * a.within;
      weight[2] = r.within * before;
      weight[3] = r.within * a.within;
      for (int c = 0; c < 2; ++c) corner[2 + c] = corner[c] + SamplingTables::incident_azimuths * SamplingTables::size;
    }
  }

  /// The mean of what value(c) is of each.
  template <class Value>
  MMBRDF_INLINE Pack<double> mean(Value value) const {
    if constexpr (corners == 1) return value(0);
    Pack<double> sum = weight[0] * value(0);
    for (int c = 1; c < corners; ++c) sum = fma(weight[c], value(c), sum);
    return sum;
  }

  MMBRDF_INLINE Pack<double> at(Bits place) const {
    return mean([&](int c) { return Read::gather(numbers, corner[c] + place); });
  }

  /// A Pack of numbers that follow each other, of one incident direction.
  MMBRDF_INLINE Pack<double> row(int begin) const {
    return mean([&](int c) { return load(numbers + corner[c][0] + begin); });
  }

  /// Between two rows, at a step of u2.
  MMBRDF_INLINE Pack<double> share(Bits place, Pack<double> between) const {
    const Pack<double> low = at(place);
    return fma(between, at(place + SamplingTables::row) - low, low);
  }
};

/// Calls work(blend) with the one that the tables ask for.
template <class Read, class Work>
MMBRDF_INLINE void with_blend(const SamplingTables& tables, const Incidence& at, Work work) {
  if (tables.of_one_incidence) return work(Blend<1, Read>(tables, at));
  if (tables.folded) return work(Blend<2, Read>(tables, at));
  work(Blend<4, Read>(tables, at));
}

}  // namespace
}  // namespace mmbrdf::MMBRDF_ISA
