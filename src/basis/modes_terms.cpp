// SPDX-License-Identifier: BSD-3-Clause
// What modes are made of. Part of modes.hpp.

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "basis/harmonics.hpp"
#include "mmbrdf/basis/modes.hpp"

// Every mode is written as a sum of products K_n^k(i) K_m^l(r) of real Zernike functions.
//
//   V_n^k  = √((n+1)/π) R_n^|k| e^{ikφ} = C_n^k + i S_n^k       the complex function of the isotropic family
//   C_n^k  = √2 K_n^0 for k = 0, else K_n^|k|
//   S_n^k  = 0 for k = 0, else sign(k) K_n^{−|k|}
//   Z(i,r) = V_n^k(i) V_m^l(r)                                  the mode function of theory 2.3

namespace mmbrdf {
namespace {

/// Collects terms, adding up the weights of equal products.
class Terms {
 public:
  void add(int row, int column, int incident, int reflected, double weight) {
    for (Term& term : list_)
      if (term.row == row && term.column == column && term.incident == incident && term.reflected == reflected) {
        term.weight += weight;
        return;
      }
    list_.push_back({row, column, incident, reflected, weight});
  }
  std::vector<Term> take() { return std::move(list_); }

 private:
  std::vector<Term> list_;
};

/// The complex function V_n^k.
struct V {
  int n, k;
  V conjugate() const { return {n, -k}; }
};

struct Factor {
  int index;
  double weight;
};
Factor real_part(const V& f) { return {zernike_index(f.n, std::abs(f.k)), f.k == 0 ? std::numbers::sqrt2 : 1.0}; }
Factor imaginary_part(const V& f) {
  return {zernike_index(f.n, -std::abs(f.k)), f.k == 0 ? 0.0 : f.k > 0 ? 1.0 : -1.0};
}

void add_product(Terms& t, int row, int column, const Factor& i, const Factor& r, double weight) {
  const double w = weight * i.weight * r.weight;
  if (w != 0) t.add(row, column, i.index, r.index, w);
}

/// iⁿ a(incident) b(reflected), n = `quarters` of a turn.
struct Product {
  V a, b;
  int quarters = 0;
};

/// weight × Re (or Im) of a product.
void add_real(Terms& t, int row, int column, const Product& p, double weight) {
  const auto& [a, b, quarters] = p;
  const double sign = quarters % 4 == 1 || quarters % 4 == 2 ? -weight : weight;  // Re z, −Im z, −Re z, Im z
  if (quarters % 2 == 0) {
    add_product(t, row, column, real_part(a), real_part(b), sign);
    add_product(t, row, column, imaginary_part(a), imaginary_part(b), -sign);
  } else {
    add_product(t, row, column, imaginary_part(a), real_part(b), sign);
    add_product(t, row, column, real_part(a), imaginary_part(b), sign);
  }
}
void add_imaginary(Terms& t, int row, int column, const Product& p, double weight) {
  add_real(t, row, column, {p.a, p.b, p.quarters + 3}, weight);
}

/// u and v share the four elements 22, 33, 32 and 23; v enters 33 and 23 with the other sign.
void add_u_or_v(Terms& t, const Product& z, const Product& exchanged, bool is_u) {
  const int sign = is_u ? 1 : -1;
  const auto add_both = [&](auto add, int row, int column, int weight) {
    add(t, row, column, z, weight);  // Z(i,r), then Z(r,i) for u and its conjugate for v
    const auto& [a, b, quarters] = exchanged;
    add(t, row, column, is_u ? exchanged : Product{a.conjugate(), b.conjugate(), quarters == 0 ? 0 : 4 - quarters},
        weight);
  };
  add_both(add_real, 1, 1, 1);
  add_both(add_real, 2, 2, sign);
  add_both(add_imaginary, 2, 1, 1);
  add_both(add_imaginary, 1, 2, -sign);
}

}  // namespace

/// Theory 2.3, the table of real elements.
std::vector<Term> complex_terms(const Mode& mode, bool imaginary) {
  const V a{mode.n, mode.k}, b{mode.m, mode.l};
  const Product z{a, b, imaginary ? 1 : 0}, exchanged{b, a, imaginary ? 1 : 0};
  Terms t;
  switch (mode.function) {
    case Function::m11:
    case Function::m44: {
      const int e = mode.function == Function::m11 ? 0 : 3;
      add_real(t, e, e, z, 1);
      add_real(t, e, e, exchanged, 1);
      break;
    }
    case Function::m14:  // iZ: what the isotropic family has is its real part with the other sign
      add_imaginary(t, 0, 3, z, 1);
      add_imaginary(t, 3, 0, exchanged, 1);
      break;
    case Function::g:
      add_real(t, 0, 1, z, 1);
      add_imaginary(t, 0, 2, z, -1);
      add_real(t, 1, 0, exchanged, 1);
      add_imaginary(t, 2, 0, exchanged, 1);
      break;
    case Function::h:  // h = iZ: Re h = −Im Z, Im h = Re Z
      add_imaginary(t, 3, 1, z, -1);
      add_real(t, 3, 2, z, -1);
      add_imaginary(t, 1, 3, exchanged, -1);
      add_real(t, 2, 3, exchanged, 1);
      break;
    case Function::u:
    case Function::v:
      add_u_or_v(t, z, exchanged, mode.function == Function::u);
      break;
    default:
      throw std::logic_error(to_string(mode) + " is no mode of complex functions");
  }
  return t.take();
}

std::vector<Term> antisymmetric_terms(const Mode& mode) {
  const V a{mode.n, mode.k}, b{mode.m, mode.l};
  Terms t;
  add_real(t, 0, 0, {a, b}, 1);
  add_real(t, 0, 0, {b, a}, -1);
  return t.take();
}

namespace {

/// A_nm^k of Eq. 10, corrected (theory 7).
double normalisation(int n, int m, int k) { return (n == m ? 2 : 1) * (k == 0 ? 2 : 1); }

/// H_nm^kl of Eq. 2 (m11 anisotropic, and the other diagonal elements of both families, Eq. 14) and the products of
/// Eqs. 15 and 16; for m11 of germer2017 I_nm^k of Eq. 9.
std::vector<Term> published_terms(const Mode& mode, Family family) {
  const auto [function, n, m, k, l] = mode;
  const auto [row, column] = element_of(function);
  const int first = zernike_index(n, k), second = zernike_index(m, l);
  Terms t;
  if (row != column) {
    t.add(row, column, first, second, 1);
    t.add(column, row, second, first, exchange_sign(row, column));
  } else if (function == Function::m11 && family == Family::germer2017) {
    const double weight = 0.5 / std::sqrt(normalisation(n, m, k));
    for (const int azimuthal : {k, -k}) {  // cos kΔφ = cos kφi cos kφr + sin kφi sin kφr
      t.add(0, 0, zernike_index(n, azimuthal), zernike_index(m, azimuthal), weight);
      t.add(0, 0, zernike_index(m, azimuthal), zernike_index(n, azimuthal), weight);
    }
  } else {
    const double weight = first == second ? 0.5 : 1 / std::numbers::sqrt2;
    t.add(row, column, first, second, weight);
    t.add(row, column, second, first, weight);
  }
  return t.take();
}

}  // namespace

std::vector<Term> terms(const Mode& mode, Family family) {
  require_valid(mode, family);
  return family == Family::isotropic ? complex_terms(mode) : published_terms(mode, family);
}

double squared_norm(const Mode& mode, Family family, int row, int column) {
  double sum = 0;  // the products of a mode are different, and orthonormal
  for (const Term& term : terms(mode, family))
    if (term.row == row && term.column == column) sum += term.weight * term.weight;
  return sum;
}

}  // namespace mmbrdf
