// SPDX-License-Identifier: BSD-3-Clause
/// Stokes vectors, Mueller matrices, and the conventions in which other communities write them.
///
/// Convention of this project (Germer 2017, Eq. 11): with transverse axes e1, e2 and propagation k, e1 × e2 = k,
///     S1 = I1 + I2,   S2 = I1 − I2,   S3 = I(e1+e2) − I(e1−e2),   S4 = I(left) − I(right),
/// where e1 is s, y or ⊥ and e2 is p, x or ∥ (see geometry.hpp). Right-handed light is a field that turns clockwise
/// for an observer who faces the source. The time factor is exp(−iωt).
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <string>

#include "mmbrdf/polarization/exchange_sign.hpp"

namespace mmbrdf {

using Stokes = std::array<double, 4>;

/// One of the sixteen elements of a Mueller matrix, row and column from 0.
struct Element {
  int row = 0, column = 0;

  /// 0 … 15 in row-major order.
  constexpr std::size_t index() const { return static_cast<std::size_t>(4 * row + column); }
  friend bool operator==(const Element&, const Element&) = default;
};

/// Some of them, in row-major order.
using Elements = std::bitset<16>;

/// A 4 × 4 real matrix that maps incident to scattered Stokes vectors. As a BRDF its unit is sr⁻¹.
/// Row = outgoing, column = incoming component, both counted from 0. Plain data: 16 doubles in row-major order. An element
/// that was not measured is NaN.
struct Mueller {
  std::array<double, 16> elements{};

  double& operator()(int row, int column) { return elements[Element{row, column}.index()]; }
  double operator()(int row, int column) const { return elements[Element{row, column}.index()]; }
  friend bool operator==(const Mueller&, const Mueller&) = default;
};

/// Of element number 0 … 15 in row-major order: "11", "12" … "44".
std::string element_name(std::size_t element);

/// "12, 13 and 44" for messages.
std::string element_names(const Elements& elements);

/// Those that are NaN.
Elements unknown_elements(const Mueller& m);

/// The elements that a turn of either beam's axes mixes with one of these, and these: 12 and 13, 21 and 31, 24 and 34, 42
/// and 43, and 22, 23, 32 and 33 belong together.
Elements turned_into(const Elements& elements);

/// Those that a turn of both beams' axes by these angles (radians) makes unknown where these are: fewer at multiples of 45
/// degrees.
Elements turned_into(const Elements& elements, double scattered, double incident);

Mueller identity();
Mueller diagonal(double m11, double m22, double m33, double m44);
Mueller operator*(const Mueller& a, const Mueller& b);
Stokes operator*(const Mueller& m, const Stokes& s);
Mueller operator*(double factor, const Mueller& m);
Mueller operator+(const Mueller& a, const Mueller& b);
Mueller operator-(const Mueller& a, const Mueller& b);
Mueller transpose(const Mueller& m);

/// M / M11. Throws std::invalid_argument if M11 is 0, not finite, or so small that an element overflows.
Mueller normalized(const Mueller& m);

/// R(angle): the same light, described in axes turned by `angle` radians from e1 towards e2 (theory 1.1).
///   rotator(π/4) * [1, 1, 0, 0] = [1, 0, −1, 0].        Period π; rotator(a)ᵀ = rotator(−a).
Mueller rotator(double angle);

/// R(a) from the direction of the double angle: cos 2a and sin 2a. For callers that have no angle, only a vector.
Mueller rotator(double cos_2a, double sin_2a);

/// R(scattered) M R(incident)ᵀ: the same matrix, in axes of both beams turned by these angles (radians). What is unknown
/// makes unknown what it is mixed with, and no more.
Mueller rotated(const Mueller& m, double scattered, double incident);

/// A Mᵀ A with A = diag(1, 1, −1, 1): the matrix measured when source and detector change places (Eq. 12).
/// Elements 13, 23, 34 and their transposes change sign. Valid in each of the frames of geometry.hpp.
Mueller exchanged(const Mueller& m);

/// P M P with P = diag(1, 1, −1, −1): the matrix of the mirror image, at the mirrored geometry.
Mueller mirrored(const Mueller& m);

/// How Stokes vectors are written elsewhere (docs/conventions.md). A convention is the sign pattern D of the Stokes
/// components relative to this project's; M' = D M D. D changes no modulus, so no test of realizability can find a
/// wrong one: store the convention with the data.
enum class StokesConvention {
  /// D = (1, 1, 1, 1): s first, S4 = left − right. This project, the paper, SCATMECH.
  germer2017,
  /// D = (1, 1, 1, −1): s first, S4 = right − left. Hecht; Mitsuba with the basis vector along s.
  s_first_right,
  /// D = (1, −1, −1, 1): axes (p, −s), S4 = left − right. IAU with p towards North.
  p_first_left,
  /// D = (1, −1, −1, −1): axes (p, −s), S4 = right − left. Most optics text books, Azzam and Bashara.
  p_first_right,
  /// D = (1, −1, 1, 1): axes (p, s), a left-handed pair; S4 = left − right. Avoid.
  p_first_left_handed_axes_left,
  /// D = (1, −1, 1, −1): axes (p, s), a left-handed pair; S4 = right − left. Avoid.
  p_first_left_handed_axes_right,
};

/// "germer2017", "s_first_right" …; the opposite throws std::invalid_argument for another name.
std::string to_string(StokesConvention convention);
StokesConvention convention_from(const std::string& name);

/// D M D, the matrix as another convention writes it. convert(M, c, c) = M, and it is its own inverse with from and to
/// exchanged.  convert(M, germer2017, s_first_right) changes the sign of elements 14, 24, 34, 41, 42, 43.
Mueller convert(const Mueller& m, StokesConvention from, StokesConvention to);
Stokes convert(const Stokes& s, StokesConvention from, StokesConvention to);

}  // namespace mmbrdf
