// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/basis/modes.hpp"

#include "basis/harmonics.hpp"
#include "text/names.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <stdexcept>
#include <tuple>
#include <utility>

// Every mode is written as a sum of products K_n^k(i) K_m^l(r) of real Zernike functions.
//
//   V_n^k  = √((n+1)/π) R_n^|k| e^{ikφ} = C_n^k + i S_n^k       the complex function of the isotropic family
//   C_n^k  = √2 K_n^0 for k = 0, else K_n^|k|
//   S_n^k  = 0 for k = 0, else sign(k) K_n^{−|k|}
//   Z(i,r) = V_n^k(i) V_m^l(r)                                  the mode function of theory 2.3

namespace mmbrdf {
namespace {

constexpr Named<Function> function_names[] = {
    {Function::m11, "11"}, {Function::m12, "12"}, {Function::m13, "13"}, {Function::m14, "14"}, {Function::m22, "22"},
    {Function::m23, "23"}, {Function::m24, "24"}, {Function::m33, "33"}, {Function::m34, "34"}, {Function::m44, "44"},
    {Function::g, "g"},    {Function::h, "h"},    {Function::u, "u"},    {Function::v, "v"}};

// ---- terms ----------------------------------------------------------------------------------------------------------

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

Element element_of(Function function) {
  const std::string name = to_string(function);
  return {name[0] - '1', name[1] - '1'};
}

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

// ---- index sets -----------------------------------------------------------------------------------------------------

/// The canonical order of azimuthal orders: |k|, |l|, then k > 0 before k < 0, then l > 0 before l < 0.
auto azimuthal_key(int k, int l) { return std::tuple(std::abs(k), std::abs(l), k < 0, l < 0); }
auto key(const Mode& mode) { return std::tuple(mode.function, mode.n, mode.m, azimuthal_key(mode.k, mode.l)); }

bool not_before(int n, int k, int m, int l) { return std::tuple(n, std::abs(k), k) >= std::tuple(m, std::abs(l), l); }

/// Whether the published files have this index (theory 2.2).
bool is_published(const Mode& mode) {
  const auto [function, n, m, k, l] = mode;
  const bool same_sign = k > 0 && l > 0, opposite = k * l < 0;
  const auto zero_with = [k = mode.k, l = mode.l](int other) {
    return (k == 0 && l == other) || (k == other && l == 0);
  };
  switch (function) {
    case Function::m11:
    case Function::m44:
      return n >= m && k == l && k >= 0;
    case Function::m22:
    case Function::m33:
      return n >= m && k >= l && (same_sign || (l == 0 && (k == 0 || k == 4)));
    case Function::m12:
    case Function::m34:
      return same_sign || zero_with(2);
    case Function::m13:
    case Function::m24:
      return opposite || zero_with(-2);
    case Function::m14:
      return opposite;
    case Function::m23:
      return opposite || zero_with(-4);
    default:
      return false;
  }
}

/// k + l of the isotropic family, 2 (σ_out + σ_in).
int spin_sum(Function function) {
  switch (function) {
    case Function::g:
    case Function::h:
      return 2;
    case Function::u:
      return 4;
    default:
      return 0;
  }
}

/// The rule that a mode with proper radial and azimuthal orders breaks in its family; empty if none.
std::string broken_rule(const Mode& mode, Family family) {
  const auto [function, n, m, k, l] = mode;
  const bool shared = function >= Function::g;
  if (family != Family::isotropic) {
    if (shared) return "only the isotropic family has the functions g, h, u and v";
    if ((n - m) % 2 != 0 && family == Family::germer2017) return "n - m must be even";
    const auto [row, column] = element_of(function);
    if (row == column && n < m) return "n must not be less than m";
    if (row == column && !not_before(n, k, m, l)) return "for n = m, k must not come before l";
    if (function == Function::m11 && family == Family::germer2017 && (k != l || k < 0))
      return "k and l must be equal and >= 0";
    return "";
  }
  if (!shared && function != Function::m11 && function != Function::m14 && function != Function::m44)
    return "the isotropic family has the functions 11, 14, 44, g, h, u and v";
  const int sum = spin_sum(function);
  if (k + l != sum) return "k + l must be " + std::to_string(sum);
  switch (function) {
    case Function::m11:
    case Function::m44:
      return n >= m && k >= 0 ? "" : "n must not be less than m, nor k less than 0";
    case Function::m14:
      return k > 0 ? "" : "k must be positive";
    case Function::u:
      return n > m || (n == m && k >= l) ? "" : "n must be greater than m, or equal with k >= l";
    case Function::v:
      return n >= m ? "" : "n must not be less than m";
    default:
      return "";
  }
}

bool belongs(const Mode& mode, Family family) {
  return broken_rule(mode, family).empty() && (family != Family::germer2017 || is_published(mode));
}

/// The functions of each block of a family.
std::vector<std::vector<Function>> block_functions(Family family) {
  using enum Function;
  if (family == Family::isotropic) return {{m11}, {g}, {m14}, {u, v}, {h}, {m44}};
  return {{m11}, {m12}, {m13}, {m14}, {m22}, {m23}, {m24}, {m33}, {m34}, {m44}};
}

/// The block of some functions without modes: its elements are those that its functions feed.
Block empty_block(const std::vector<Function>& functions) {
  using List = std::vector<Element>;
  Block block;
  switch (functions.front()) {
    case Function::g:
      block.elements = {{0, 1}, {0, 2}, {1, 0}, {2, 0}};
      break;
    case Function::h:
      block.elements = {{1, 3}, {2, 3}, {3, 1}, {3, 2}};
      break;
    case Function::u:
      block.elements = {{1, 1}, {1, 2}, {2, 1}, {2, 2}};
      break;
    default: {
      const auto [row, column] = element_of(functions.front());
      block.elements = row == column ? List{{row, column}} : List{{row, column}, {column, row}};
    }
  }
  for (const auto& [row, column] : block.elements)
    block.name.append(block.name.empty() ? "" : ",").append(std::to_string(10 * (row + 1) + column + 1));
  return block;
}

void append_modes(std::vector<Mode>& modes, Function function, Family family, int order) {
  const auto first = static_cast<std::ptrdiff_t>(modes.size());
  for (int n = 0; n <= order; ++n)
    for (int m = 0; m <= order; ++m)
      for (int k = -n; k <= n; k += 2)
        for (int l = -m; l <= m; l += 2)
          if (const Mode mode{function, n, m, k, l}; belongs(mode, family)) modes.push_back(mode);
  std::sort(modes.begin() + first, modes.end(), [](const Mode& a, const Mode& b) { return key(a) < key(b); });
}

void require_order(int order) {
  if (order < 0 || order > max_order)
    throw std::invalid_argument("order " + std::to_string(order) + " is not in 0..." + std::to_string(max_order));
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

std::vector<Block> blocks(Family family, const Orders& orders) {
  require_order(orders.f11);
  require_order(orders.other);
  std::vector<Block> result;
  for (const auto& functions : block_functions(family)) {
    Block block = empty_block(functions);
    for (const Function function : functions)
      append_modes(block.modes, function, family, function == Function::m11 ? orders.f11 : orders.other);
    if (!block.modes.empty()) result.push_back(std::move(block));
  }
  return result;
}

std::vector<Block> blocks(Family family, const std::vector<Mode>& modes) {
  for (const Mode& mode : modes) require_valid(mode, family);
  std::vector<Mode> sorted = modes;
  std::sort(sorted.begin(), sorted.end(), [](const Mode& a, const Mode& b) { return key(a) < key(b); });
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end()) throw std::invalid_argument("mode " + to_string(*twice) + " is given twice");
  std::vector<Block> result;
  for (const auto& functions : block_functions(family)) {
    Block block = empty_block(functions);
    for (const Function function : functions)
      std::copy_if(sorted.begin(), sorted.end(), std::back_inserter(block.modes),
                   [&](const Mode& mode) { return mode.function == function; });
    if (!block.modes.empty()) result.push_back(std::move(block));
  }
  return result;
}

std::vector<Block> without(const Elements& elements, std::vector<Block> blocks) {
  std::erase_if(blocks, [&](const Block& block) {
    return std::ranges::all_of(block.elements, [&](const Element& element) { return elements[element.index()]; });
  });
  return blocks;
}

Orders orders(const std::vector<Block>& blocks) {
  Orders result{0, 0};
  for (const Block& block : blocks)
    for (const Mode& mode : block.modes) {
      int& order = mode.function == Function::m11 ? result.f11 : result.other;
      order = std::max({order, mode.n, mode.m});
    }
  return result;
}

int mode_count(const std::vector<Block>& blocks) {
  std::size_t count = 0;
  for (const Block& block : blocks) count += block.modes.size();
  return static_cast<int>(count);
}

void require_valid(const Mode& mode, Family family) {
  const auto [function, n, m, k, l] = mode;
  const auto refuse = [&](const std::string& rule) {
    throw std::invalid_argument("mode " + to_string(mode) + " of the " + to_string(family) + " family: " + rule);
  };
  if (n < 0 || n > max_order) refuse("n must be in 0..." + std::to_string(max_order));
  if (m < 0 || m > max_order) refuse("m must be in 0..." + std::to_string(max_order));
  if (k < -n || k > n) refuse("|k| must not exceed n");
  if (l < -m || l > m) refuse("|l| must not exceed m");
  if ((n - k) % 2 != 0) refuse("n - k must be even");
  if ((m - l) % 2 != 0) refuse("m - l must be even");
  if (const std::string rule = broken_rule(mode, family); !rule.empty()) refuse(rule);
}

std::string to_string(const Mode& mode) {
  return to_string(mode.function) + " (n, m, k, l) = (" + std::to_string(mode.n) + ", " + std::to_string(mode.m) +
         ", " + std::to_string(mode.k) + ", " + std::to_string(mode.l) + ")";
}

std::string to_string(Function function) { return name_of(function_names, function); }
Function function_from(const std::string& name) { return value_of(function_names, name, "function"); }

Function function_of(int row, int column) {
  return function_from(std::to_string(row + 1) + std::to_string(column + 1));
}

}  // namespace mmbrdf
