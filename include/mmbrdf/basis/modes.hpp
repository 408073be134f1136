// SPDX-License-Identifier: BSD-3-Clause
/// Basis functions of a reciprocal Mueller-matrix BRDF. A model is linear in its coefficients over a list of modes.
///
/// A mode feeds one or several matrix elements. What it gives to element ij is a sum of products of real Zernike
/// functions, K_n^k(incident) K_m^l(reflected), in the xy frame: its terms. All families are lists of such terms, so
/// one evaluation serves them all. f11 is in sr⁻¹; the other elements are normalised, m_ij = f_ij / f11.
///
///   n, k   radial and azimuthal order of the first factor, which Eq. 15 gives to the incident side
///   m, l   radial and azimuthal order of the second factor
#pragma once

#include <string>
#include <vector>

#include "mmbrdf/basis/family.hpp"
#include "mmbrdf/basis/zernike.hpp"
#include "mmbrdf/polarization/mueller.hpp"

namespace mmbrdf {

/// The function a mode belongs to. Pairs m_ij name element ij and, by reciprocity, ji. g, h, u and v are the functions
/// of the isotropic family that several elements share:
///   g: m12 = Re g(i,r)   m13 = −Im g(i,r)   m21 = Re g(r,i)   m31 = Im g(r,i)
///   h: m42 = Re h(i,r)   m43 = −Im h(i,r)   m24 = Re h(r,i)   m34 = Im h(r,i)
///   u, v: m22 = Re(u+v)  m33 = Re(u−v)      m32 = Im(u+v)     m23 = Im(v−u)
enum class Function { m11, m12, m13, m14, m22, m23, m24, m33, m34, m44, g, h, u, v };

struct Mode {
  Function function;
  int n, m, k, l;
  friend bool operator==(const Mode&, const Mode&) = default;
};

/// weight × K_n^k(incident) × K_m^l(reflected), added to element (row, column), counted from 0. The positions are those
/// of zernike_index.
struct Term {
  int row, column;
  int incident, reflected;
  double weight;

  constexpr std::size_t element() const { return Element{row, column}.index(); }
  friend bool operator==(const Term&, const Term&) = default;
};

/// What a mode is made of; no two terms have the same element and positions.
/// Throws std::invalid_argument if the mode is not valid in the family (see require_valid).
std::vector<Term> terms(const Mode& mode, Family family);

/// ∫∫ Y² dΩi dΩr of the part Y that a mode gives to an element (row, column from 0), lambert mapping; 0 if it feeds
/// that element nothing. germer2017 and anisotropic modes have 1 for each element; isotropic ones carry no A_nm factor
/// and have 2, 4, 8 or 16. The modes of a block are orthogonal, all its elements taken together; in one element alone
/// all are but the isotropic v of opposite k.
double squared_norm(const Mode& mode, Family family, int row, int column);

/// Modes that are fitted together, because they feed the same elements or elements related by reciprocity.
struct Block {
  std::string name;               ///< "11", "12,21", "22,23,32,33", …: the elements fed
  std::vector<Element> elements;  ///< those
  std::vector<Mode> modes;
};

/// Whether the block is that of element 11, which alone is in sr⁻¹.
inline bool feeds_f11(const Block& block) { return block.elements.front().index() == 0; }

/// The blocks but those whose elements are all among these.
std::vector<Block> without(const Elements& elements, std::vector<Block> blocks);

/// Radial orders: n, m ≤ f11 for the element 11, ≤ other for all others.
struct Orders {
  int f11 = 7;
  int other = 4;
  friend bool operator==(const Orders&, const Orders&) = default;
};

/// Every mode of a family up to the given orders, block by block, in the canonical order:
///   blocks   germer2017, anisotropic: 11 12 13 14 22 23 24 33 34 44;   isotropic: 11, g, 14, u and v, h, 44
///   modes    by function, n, m, |k|, |l|, then k > 0 before k < 0, then l > 0 before l < 0
/// Throws std::invalid_argument unless 0 ≤ order ≤ max_order.
std::vector<Block> blocks(Family family, const Orders& orders);

/// The blocks that hold exactly these modes, in canonical order, for model files whose index set is their own.
/// Throws std::invalid_argument, naming the mode, for one that is not valid or given twice.
std::vector<Block> blocks(Family family, const std::vector<Mode>& modes);

/// Largest radial orders among the modes.
Orders orders(const std::vector<Block>& blocks);

int mode_count(const std::vector<Block>& blocks);

/// Throws std::invalid_argument, naming mode and rule, unless |k| ≤ n ≤ max_order, |l| ≤ m ≤ max_order, n − k and m − l
/// even, and the family's rules hold:
///   family                    function   rule
///   germer2017, anisotropic   mii        n > m, or n = m and (|k|, k) ≥ (|l|, l): (n, k) does not come before (m, l)
///   germer2017                all        n − m even
///                             m11        k = l ≥ 0
///   isotropic                 m11, m44   k + l = 0, n ≥ m, k ≥ 0
///                             m14        k + l = 0, k > 0
///                             g, h       k + l = 2
///                             u          k + l = 4, n > m, or n = m and k ≥ l
///                             v          k + l = 0, n ≥ m
void require_valid(const Mode& mode, Family family);

/// "22 (n, m, k, l) = (4, 2, 4, 2)" for messages.
std::string to_string(const Mode& mode);

/// The names used in files and by the program: 11, 12, …, g, h, u, v; lambert, projected. The opposites throw
/// std::invalid_argument for another name.
std::string to_string(Function function);
std::string to_string(DiscMapping mapping);
/// Of row and column, from 0, on or above the diagonal: m11 … m44. Throws std::invalid_argument for others.
Function function_of(int row, int column);
Function function_from(const std::string& name);
DiscMapping disc_mapping_from(const std::string& name);

}  // namespace mmbrdf
