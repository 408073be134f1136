// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/basis/modes.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "given/cases.hpp"
#include "given/published.hpp"

using namespace mmbrdf;
using enum Function;

namespace {

constexpr double pi = std::numbers::pi;
constexpr std::array every_family{Family::isotropic, Family::germer2017, Family::anisotropic};
constexpr std::array every_function{m11, m12, m13, m14, m22, m23, m24, m33, m34, m44, g, h, u, v};

Direction any_direction() { return {between(0, pi / 2), between(-pi, pi)}; }

std::vector<Mode> modes_of(const std::vector<Block>& blocks) {
  std::vector<Mode> result;
  for (const Block& block : blocks) result.insert(result.end(), block.modes.begin(), block.modes.end());
  return result;
}

std::vector<Mode> modes_of(Family family, Orders orders) { return modes_of(blocks(family, orders)); }

Mode any_mode(Family family, Orders orders) { return *rc::gen::elementOf(modes_of(family, orders)); }

std::map<Function, int> counts(Family family, Orders orders) {
  std::map<Function, int> result;
  for (const Mode& mode : modes_of(family, orders)) ++result[mode.function];
  return result;
}

int count_without_f11(Family family, int order) {
  const auto list = blocks(family, {0, order});
  return mode_count(list) - static_cast<int>(list.front().modes.size());
}

std::vector<std::string> names_of(const std::vector<Block>& blocks) {
  std::vector<std::string> names;
  for (const Block& block : blocks) names.push_back(block.name);
  return names;
}

/// The indices of a file of published coefficients, row by row; those of λ⁰ where there are more.
std::vector<Mode> modes_of_file(const std::string& path) {
  std::ifstream file(path);
  std::vector<Mode> modes;
  int i, j, n, m, k, l, p;
  char comma;
  std::string rest;
  while (file >> i >> comma >> j >> comma >> n >> comma >> m >> comma >> k >> comma >> l >> comma >> p) {
    std::getline(file, rest);
    if (p == 0) modes.push_back({function_from(std::to_string(i) + std::to_string(j)), n, m, k, l});
  }
  return modes;
}

// ---- the functions as printed, from radial() and sines --------------------------------------------------------------

double k_function(int n, int k, const Direction& d) {
  const double azimuthal = k > 0 ? std::cos(k * d.phi) : k < 0 ? -std::sin(k * d.phi) : 1 / std::numbers::sqrt2;
  const double rho = std::min(1.0, std::numbers::sqrt2 * std::sin(d.theta / 2));
  return std::sqrt((n + 1) / pi) * radial(n, std::abs(k), rho) * azimuthal;  // Eqs. 3 and 4
}

double h_function(int n, int m, int k, int l, const Geometry& g) {
  const double same = n == m && k == l ? 1 : 0;
  return (k_function(n, k, g.incident) * k_function(m, l, g.reflected) +
          k_function(n, k, g.reflected) * k_function(m, l, g.incident)) /
         std::sqrt(2 + 2 * same);  // Eq. 2
}

double i_function(int n, int m, int k, const Geometry& g) {
  const double a = n == m && k == 0 ? 4 : n == m || k == 0 ? 2 : 1;  // Eq. 10, corrected in theory 7
  const double rho_i = std::min(1.0, std::numbers::sqrt2 * std::sin(g.incident.theta / 2));
  const double rho_r = std::min(1.0, std::numbers::sqrt2 * std::sin(g.reflected.theta / 2));
  return std::sqrt((n + 1) * (m + 1) / a) / (2 * pi) *
         (radial(n, k, rho_i) * radial(m, k, rho_r) + radial(m, k, rho_i) * radial(n, k, rho_r)) *
         std::cos(k * (g.reflected.phi - g.incident.phi));  // Eq. 9, corrected
}

/// What a mode of germer2017 or anisotropic gives to the elements: Eq. 9 or 2 and 14, else 15 and 16.
Mueller printed(const Mode& mode, Family family, const Geometry& g) {
  const auto [function, n, m, k, l] = mode;
  const std::string name = to_string(function);
  const int row = name[0] - '1', column = name[1] - '1';
  Mueller result;
  if (function == m11 && family == Family::germer2017)
    result(0, 0) = i_function(n, m, k, g);
  else if (row == column)
    result(row, column) = h_function(n, m, k, l, g);
  else {
    const double sign = function == m13 || function == m23 || function == m34 ? -1 : 1;  // Eq. 13
    result(row, column) = k_function(n, k, g.incident) * k_function(m, l, g.reflected);
    result(column, row) = sign * k_function(m, l, g.incident) * k_function(n, k, g.reflected);
  }
  return result;
}

/// What a mode of isotropic gives to the elements: theory 2.3 with complex numbers.
Mueller spin_weighted(const Mode& mode, const Geometry& geometry) {
  using Complex = std::complex<double>;
  const auto [function, n, m, k, l] = mode;
  const auto z_of = [n = mode.n, m = mode.m, k = mode.k, l = mode.l](const Direction& a, const Direction& b) {
    const double rho_a = std::min(1.0, std::numbers::sqrt2 * std::sin(a.theta / 2));
    const double rho_b = std::min(1.0, std::numbers::sqrt2 * std::sin(b.theta / 2));
    return std::sqrt((n + 1) * (m + 1)) / pi * radial(n, std::abs(k), rho_a) * radial(m, std::abs(l), rho_b) *
           std::polar(1.0, k * a.phi + l * b.phi);
  };
  const Complex z = z_of(geometry.incident, geometry.reflected),
                exchanged = z_of(geometry.reflected, geometry.incident);
  const Complex i(0, 1);
  Mueller result;
  switch (function) {
    case m11:
      result(0, 0) = (z + exchanged).real();
      break;
    case m44:
      result(3, 3) = (z + exchanged).real();
      break;
    case m14:
      result(0, 3) = z.imag();
      result(3, 0) = exchanged.imag();
      break;
    case g:
      result(0, 1) = z.real();
      result(0, 2) = -z.imag();
      result(1, 0) = exchanged.real();
      result(2, 0) = exchanged.imag();
      break;
    case h:
      result(3, 1) = (i * z).real();
      result(3, 2) = -(i * z).imag();
      result(1, 3) = (i * exchanged).real();
      result(2, 3) = (i * exchanged).imag();
      break;
    default: {
      const Complex u_value = function == u ? z + exchanged : 0, v_value = function == v ? z + std::conj(exchanged) : 0;
      result(1, 1) = (u_value + v_value).real();
      result(2, 2) = (u_value - v_value).real();
      result(2, 1) = (u_value + v_value).imag();
      result(1, 2) = (v_value - u_value).imag();
    }
  }
  return result;
}

Mueller sum_of_terms(const Mode& mode, Family family, const Geometry& geometry) {
  std::vector<double> k_i(zernike_count(max_order)), k_r(zernike_count(max_order));
  zernike_table(max_order, disc_point(geometry.incident, DiscMapping::lambert), k_i.data());
  zernike_table(max_order, disc_point(geometry.reflected, DiscMapping::lambert), k_r.data());
  Mueller result;
  for (const Term& term : terms(mode, family))
    result(term.row, term.column) +=
        term.weight * k_i[static_cast<std::size_t>(term.incident)] * k_r[static_cast<std::size_t>(term.reflected)];
  return result;
}

double largest_difference(const Mueller& a, const Mueller& b) {
  double result = 0;
  for (std::size_t e = 0; e < 16; ++e) result = std::max(result, std::abs(a.elements[e] - b.elements[e]));
  return result;
}

/// ∫∫ of the product of what two modes give to an element: the products of K are orthonormal.
double overlap(const std::vector<Term>& a, const std::vector<Term>& b, int row, int column) {
  double sum = 0;
  for (const Term& s : a)
    for (const Term& t : b)
      if (s.row == row && s.column == column && t.row == row && t.column == column && s.incident == t.incident &&
          s.reflected == t.reflected)
        sum += s.weight * t.weight;
  return sum;
}

std::string refusal(const Mode& mode, Family family) {
  return message_of([&] { require_valid(mode, family); });
}

}  // namespace

// ---- how many -------------------------------------------------------------------------------------------------------

TEST(Modes, OfGermer2017AtOrders7And4AreThe330OfThePublishedFiles) {
  const std::map<Function, int> expected{{m11, 40}, {m12, 30}, {m13, 48}, {m14, 36}, {m22, 21},
                                         {m23, 42}, {m24, 48}, {m33, 21}, {m34, 30}, {m44, 14}};
  EXPECT_EQ(counts(Family::germer2017, {7, 4}), expected);
  EXPECT_EQ(mode_count(blocks(Family::germer2017, {7, 4})), 330);
}

TEST(Modes, OfGermer2017AtOrders7And5AreThe634OfThePublishedGrey10Set) {
  EXPECT_EQ(mode_count(blocks(Family::germer2017, {7, 5})), 634);
}

// Theory 2.2: how many (n, m) each pair (k, l) has.
TEST(Modes, OfGermer2017HaveThePublishedAzimuthalOrders) {
  using Counts = std::map<std::pair<int, int>, int>;
  const Counts of_11{{{0, 0}, 10}, {{1, 1}, 10}, {{2, 2}, 6}, {{3, 3}, 6},
                     {{4, 4}, 3},  {{5, 5}, 3},  {{6, 6}, 1}, {{7, 7}, 1}};
  const Counts of_22{{{0, 0}, 6}, {{1, 1}, 3}, {{2, 2}, 3}, {{3, 1}, 2},
                     {{3, 3}, 1}, {{4, 0}, 3}, {{4, 2}, 2}, {{4, 4}, 1}};
  const Counts of_44{{{0, 0}, 6}, {{1, 1}, 3}, {{2, 2}, 3}, {{3, 3}, 1}, {{4, 4}, 1}};
  const Counts nonzero{{{1, 1}, 4}, {{1, 3}, 2}, {{3, 1}, 2}, {{3, 3}, 1},
                       {{2, 2}, 4}, {{2, 4}, 2}, {{4, 2}, 2}, {{4, 4}, 1}};
  Counts of_12 = nonzero, of_14;
  of_12[{0, 2}] = of_12[{2, 0}] = 6;
  for (const auto& [pair, count] : nonzero)
    of_14[{pair.first, -pair.second}] = of_14[{-pair.first, pair.second}] = count;
  Counts of_13 = of_14, of_23 = of_14;
  of_13[{0, -2}] = of_13[{-2, 0}] = 6;
  of_23[{0, -4}] = of_23[{-4, 0}] = 3;
  const std::map<Function, Counts> expected{{m11, of_11}, {m12, of_12}, {m13, of_13}, {m14, of_14}, {m22, of_22},
                                            {m23, of_23}, {m24, of_13}, {m33, of_22}, {m34, of_12}, {m44, of_44}};
  std::map<Function, Counts> found;
  for (const Mode& mode : modes_of(Family::germer2017, {7, 4})) ++found[mode.function][{mode.k, mode.l}];
  EXPECT_EQ(found, expected);
}

TEST(Modes, OfTheIsotropicFamilyAtOrders7And4Are142) {
  const std::map<Function, int> expected{{m11, 40}, {m14, 10}, {m44, 14}, {g, 24}, {h, 24}, {u, 8}, {v, 22}};
  EXPECT_EQ(counts(Family::isotropic, {7, 4}), expected);
  EXPECT_EQ(mode_count(blocks(Family::isotropic, {7, 4})), 142);
}

TEST(Modes, OfTheIsotropicFamilyGrowWithThePolarizationOrderAsTheorySays) {
  const std::pair<int, int> expected[] = {{2, 25}, {3, 54}, {4, 102}, {5, 170}, {6, 264}};
  for (const auto& [order, count] : expected) EXPECT_EQ(count_without_f11(Family::isotropic, order), count) << order;
}

// With N = (order + 1)(order + 2) / 2 functions, a diagonal element has N (N + 1) / 2 modes and a pair N².
TEST(Modes, OfTheAnisotropicFamilyAreAllThereCanBe) {
  for (const Orders orders : {Orders{7, 4}, Orders{0, 0}, Orders{2, 5}, Orders{6, 1}}) {
    const int f11 = zernike_count(orders.f11), other = zernike_count(orders.other);
    EXPECT_EQ(mode_count(blocks(Family::anisotropic, orders)),
              f11 * (f11 + 1) / 2 + 3 * other * (other + 1) / 2 + 6 * other * other);
  }
  EXPECT_EQ(mode_count(blocks(Family::anisotropic, {7, 4})), 2376);
}

// Of the products of K, those of f11 that depend on φr − φi alone and do not change sign in a mirror are cos k(φr −
// φi).
TEST(Modes, OfF11AreTheSameFunctionsInTheIsotropicFamilyAndInGermer2017) {
  EXPECT_EQ(blocks(Family::isotropic, {12, 0}).front().modes.size(),
            blocks(Family::germer2017, {12, 0}).front().modes.size());
}

// ---- in which order -------------------------------------------------------------------------------------------------

TEST(Modes, StandInTheOrderOfThePublishedFiles) {
  for (const char* name :
       {"PTFE.351.coeff.csv", "PTFE.532.coeff.csv", "PTFE.633.coeff.csv", "PTFE.1064.coeff.csv", "PTFE.coeff.csv"}) {
    const std::string file = published(name);
    if (file.empty()) GTEST_SKIP() << absent(name);
    EXPECT_EQ(modes_of(Family::germer2017, {7, 4}), modes_of_file(file)) << name;
  }
}

TEST(Modes, ComeInBlocksNamedByTheElementsTheyFeed) {
  const std::vector<std::string> isotropic{"11", "12,13,21,31", "14,41", "22,23,32,33", "24,34,42,43", "44"};
  const std::vector<std::string> others{"11", "12,21", "13,31", "14,41", "22", "23,32", "24,42", "33", "34,43", "44"};
  EXPECT_EQ(names_of(blocks(Family::isotropic, {7, 4})), isotropic);
  EXPECT_EQ(names_of(blocks(Family::germer2017, {7, 4})), others);
  EXPECT_EQ(names_of(blocks(Family::anisotropic, {7, 4})), others);
}

TEST(Modes, OfABlockFeedItsElementsAndNoOthers) {
  for (const Family family : every_family)
    for (const Block& block : blocks(family, {5, 5})) {
      std::set<std::size_t> fed, named;
      for (const Mode& mode : block.modes)
        for (const Term& term : terms(mode, family)) fed.insert(term.element());
      for (const Element& element : block.elements) named.insert(element.index());
      EXPECT_EQ(fed, named) << to_string(family) << " " << block.name;
    }
}

TEST(Modes, AreSortedByFunctionThenRadialThenAzimuthalOrdersWithPositiveFirst) {
  const auto key = [](const Mode& q) {
    return std::tuple(q.function, q.n, q.m, std::abs(q.k), std::abs(q.l), q.k < 0, q.l < 0);
  };
  for (const Family family : every_family)
    for (const Block& block : blocks(family, {6, 4}))
      EXPECT_TRUE(std::is_sorted(block.modes.begin(), block.modes.end(),
                                 [&](const Mode& a, const Mode& b) { return key(a) < key(b); }));
}

TEST(Modes, FollowTheOrderOfF11AndThatOfAllOtherElementsSeparately) {
  for (const Family family : every_family)
    for (const Orders orders : {Orders{7, 4}, Orders{3, 6}, Orders{0, 4}}) {
      EXPECT_EQ(mmbrdf::orders(blocks(family, orders)), orders) << to_string(family);
      EXPECT_EQ(blocks(family, orders).front().modes, blocks(family, {orders.f11, 1}).front().modes);
    }
}

TEST(Modes, OfAnOrderOutsideZeroToMaxOrderAreRefused) {
  for (const Family family : every_family)
    for (const Orders orders : {Orders{-1, 4}, Orders{7, -1}, Orders{max_order + 1, 4}, Orders{7, max_order + 1}})
      EXPECT_THROW(blocks(family, orders), std::invalid_argument);
}

// Order 0 holds constants, and without azimuthal dependence an isotropic sample has 11, 22 + 33 and 44 only.
TEST(Modes, OfOrderZeroAreTheIdealDiffusers) {
  const std::vector<Mode> expected{{m11, 0, 0, 0, 0}, {v, 0, 0, 0, 0}, {m44, 0, 0, 0, 0}};
  EXPECT_EQ(modes_of(Family::isotropic, {0, 0}), expected);
}

RC_GTEST_PROP(Modes, GivenInAnyOrderComeBackInTheCanonicalBlocks, ()) {
  const Family family = *rc::gen::elementOf(every_family);
  const std::vector<Block> canonical = blocks(family, {4, 3});
  std::vector<Mode> shuffled = modes_of(canonical);
  for (std::size_t i = shuffled.size(); i > 1; --i)
    std::swap(shuffled[i - 1], shuffled[*rc::gen::inRange<std::size_t>(0, i)]);
  const std::vector<Block> found = blocks(family, shuffled);
  RC_ASSERT(names_of(found) == names_of(canonical));
  RC_ASSERT(modes_of(found) == modes_of(canonical));
  for (std::size_t b = 0; b < found.size(); ++b) RC_ASSERT(found[b].elements == canonical[b].elements);
}

RC_GTEST_PROP(Modes, AnyOfThemMayBeLeftOut, ()) {
  const Family family = *rc::gen::elementOf(every_family);
  std::vector<Mode> some;
  for (const Mode& mode : modes_of(family, {4, 3}))
    if (*rc::gen::inRange(0, 3) == 0) some.push_back(mode);
  RC_ASSERT(modes_of(blocks(family, some)) == some);
  RC_ASSERT(mode_count(blocks(family, some)) == static_cast<int>(some.size()));
}

RC_GTEST_PROP(Modes, GivenTwiceAreRefusedByName, ()) {
  const Family family = *rc::gen::elementOf(every_family);
  std::vector<Mode> modes = modes_of(family, {4, 3});
  const Mode twin = *rc::gen::elementOf(modes);
  modes.insert(modes.begin() + *rc::gen::inRange<std::ptrdiff_t>(0, static_cast<std::ptrdiff_t>(modes.size())), twin);
  RC_ASSERT(message_of([&] { blocks(family, modes); }) == "mode " + to_string(twin) + " is given twice");
}

// A file may have modes of its own: those that the published sets leave out, up to where they are still told apart.
TEST(Modes, OfTheGermer2017FamilyNeedNotBeInThePublishedSets) {
  const std::vector<Mode> modes{{m11, 0, 0, 0, 0}, {m22, 5, 3, 1, 3}, {m23, 2, 2, -2, -2}};
  EXPECT_EQ(modes_of(blocks(Family::germer2017, modes)), modes);
}

// ---- what they are --------------------------------------------------------------------------------------------------

// Of √((n+1)(m+1)), for a few products with some roundings each; the largest seen in 60000 cases is 5.5e-16.
constexpr double printed_error = 4e-15;

RC_GTEST_PROP(Modes, OfGermer2017AndAnisotropicAreTheFunctionsAsPrinted, ()) {
  const Family family = *rc::gen::element(Family::germer2017, Family::anisotropic);
  const Mode mode = any_mode(family, family == Family::germer2017 ? Orders{12, 8} : Orders{5, 4});
  const Geometry geometry{any_direction(), any_direction()};
  RC_ASSERT(largest_difference(sum_of_terms(mode, family, geometry), printed(mode, family, geometry)) <=
            printed_error * std::sqrt((mode.n + 1) * (mode.m + 1)));
}

RC_GTEST_PROP(Modes, OfTheIsotropicFamilyAreTheComplexFunctionsOfTheirDerivation, ()) {
  const Mode mode = any_mode(Family::isotropic, {12, 10});
  const Geometry geometry{any_direction(), any_direction()};
  RC_ASSERT(largest_difference(sum_of_terms(mode, Family::isotropic, geometry), spin_weighted(mode, geometry)) <=
            printed_error * std::sqrt((mode.n + 1) * (mode.m + 1)));
}

TEST(Modes, HaveNoTwoTermsOfTheSameElementAndProduct) {
  for (const Family family : every_family)
    for (const Mode& mode : modes_of(family, {6, 4})) {
      std::set<std::tuple<int, int, int, int>> seen;
      for (const Term& term : terms(mode, family)) {
        EXPECT_TRUE(seen.insert({term.row, term.column, term.incident, term.reflected}).second) << to_string(mode);
        EXPECT_NE(term.weight, 0) << to_string(mode);
      }
    }
}

// A few roundings of 1/√8 and the like.
constexpr double norm_error = 1e-15;

TEST(Modes, OfGermer2017AndAnisotropicHaveNorm1InEachElementTheyFeed) {
  for (const Family family : {Family::germer2017, Family::anisotropic})
    for (const Block& block : blocks(family, {9, 5}))
      for (const Mode& mode : block.modes)
        for (const auto& [row, column] : block.elements)
          EXPECT_NEAR(squared_norm(mode, family, row, column), 1, norm_error) << to_string(mode);
}

TEST(Modes, GiveNothingToElementsOfOtherBlocks) {
  EXPECT_EQ(squared_norm({m12, 2, 2, 0, 2}, Family::germer2017, 0, 2), 0);
  EXPECT_EQ(squared_norm({g, 2, 2, 0, 2}, Family::isotropic, 1, 1), 0);
}

TEST(Modes, OfTheIsotropicFamilyHaveTheDocumentedNorms) {
  std::set<double> found;
  for (const Block& block : blocks(Family::isotropic, {9, 8}))
    for (const Mode& mode : block.modes)
      for (const auto& [row, column] : block.elements) {
        const double norm = squared_norm(mode, Family::isotropic, row, column);
        EXPECT_NEAR(norm, std::round(norm), 20 * norm_error) << to_string(mode);
        found.insert(std::round(norm));
      }
  EXPECT_EQ(found, (std::set<double>{0, 2, 4, 8, 16}));
}

TEST(Modes, OfABlockAreOrthogonalOverItsElementsTogether) {
  for (const Family family : every_family)
    for (const Block& block : blocks(family, {6, 4})) {
      std::vector<std::vector<Term>> all;
      for (const Mode& mode : block.modes) all.push_back(terms(mode, family));
      for (std::size_t a = 0; a < all.size(); ++a)
        for (std::size_t b = 0; b < a; ++b) {
          double sum = 0;
          for (const auto& [row, column] : block.elements) sum += overlap(all[a], all[b], row, column);
          EXPECT_NEAR(sum, 0, norm_error) << to_string(block.modes[a]) << " " << to_string(block.modes[b]);
        }
    }
}

// In one element alone v with k and v with −k are one and the same function up to its sign; 22, 33 and 23, 32 tell them
// apart.
TEST(Modes, OfABlockAreOrthogonalInEachElementButForVOfOppositeK) {
  for (const Family family : every_family)
    for (const Block& block : blocks(family, {6, 4})) {
      std::vector<std::vector<Term>> all;
      for (const Mode& mode : block.modes) all.push_back(terms(mode, family));
      for (std::size_t a = 0; a < all.size(); ++a)
        for (std::size_t b = 0; b < a; ++b)
          for (const auto& [row, column] : block.elements) {
            const Mode &p = block.modes[a], &q = block.modes[b];
            const bool opposite = p.function == v && q == Mode{v, p.n, p.m, -p.k, -p.l};
            const double norm = opposite ? squared_norm(p, family, row, column) : 0;
            EXPECT_NEAR(std::abs(overlap(all[a], all[b], row, column)), norm, norm_error)
                << to_string(p) << " " << to_string(q);
          }
    }
}

// ---- which are valid ------------------------------------------------------------------------------------------------

TEST(Modes, OfEveryFamilyAreValidInIt) {
  for (const Family family : every_family)
    for (const Mode& mode : modes_of(family, {7, 5})) EXPECT_NO_THROW(require_valid(mode, family)) << to_string(mode);
}

TEST(Modes, ThatBreakARuleAreRefusedWithModeFamilyAndRule) {
  struct Case {
    Family family;
    Mode mode;
    const char* rule;
  };
  using enum Family;
  const Case cases[] = {
      {germer2017, {m12, -1, 1, 1, 1}, "n must be in 0...40"},
      {germer2017, {m12, 41, 1, 1, 1}, "n must be in 0...40"},
      {isotropic, {g, 2, -2, 0, 2}, "m must be in 0...40"},
      {isotropic, {g, 2, 42, 0, 2}, "m must be in 0...40"},
      {germer2017, {m12, 1, 3, 3, 1}, "|k| must not exceed n"},
      {anisotropic, {m12, 1, 3, -3, 1}, "|k| must not exceed n"},
      {isotropic, {g, 4, 0, 0, 2}, "|l| must not exceed m"},
      {anisotropic, {m13, 4, 1, 0, -3}, "|l| must not exceed m"},
      {germer2017, {m12, 3, 2, 2, 2}, "n - k must be even"},
      {isotropic, {m14, 3, 2, -2, 2}, "n - k must be even"},
      {anisotropic, {m12, 3, 2, 1, 1}, "m - l must be even"},
      {germer2017, {m14, 3, 2, 1, 0}, "n - m must be even"},
      {germer2017, {m11, 2, 4, 0, 0}, "n must not be less than m"},
      {anisotropic, {m44, 2, 4, 0, 0}, "n must not be less than m"},
      {anisotropic, {m22, 2, 2, 0, 2}, "for n = m, k must not come before l"},
      {anisotropic, {m22, 2, 2, -2, 2}, "for n = m, k must not come before l"},
      {germer2017, {m33, 4, 4, 2, 4}, "for n = m, k must not come before l"},
      {germer2017, {m11, 4, 2, 2, 0}, "k and l must be equal and >= 0"},
      {germer2017, {m11, 4, 2, -2, -2}, "k and l must be equal and >= 0"},
      {germer2017, {g, 2, 2, 0, 2}, "only the isotropic family has the functions g, h, u and v"},
      {anisotropic, {v, 2, 2, 0, 0}, "only the isotropic family has the functions g, h, u and v"},
      {isotropic, {m22, 2, 2, 0, 0}, "the isotropic family has the functions 11, 14, 44, g, h, u and v"},
      {isotropic, {m12, 2, 2, 0, 2}, "the isotropic family has the functions 11, 14, 44, g, h, u and v"},
      {isotropic, {m11, 2, 2, 2, 2}, "k + l must be 0"},
      {isotropic, {m14, 2, 2, 2, 2}, "k + l must be 0"},
      {isotropic, {v, 2, 2, 2, 2}, "k + l must be 0"},
      {isotropic, {g, 2, 2, 2, -2}, "k + l must be 2"},
      {isotropic, {h, 2, 2, 0, 0}, "k + l must be 2"},
      {isotropic, {u, 2, 2, 0, 2}, "k + l must be 4"},
      {isotropic, {m11, 2, 4, 0, 0}, "n must not be less than m, nor k less than 0"},
      {isotropic, {m44, 4, 2, -2, 2}, "n must not be less than m, nor k less than 0"},
      {isotropic, {m14, 2, 2, 0, 0}, "k must be positive"},
      {isotropic, {m14, 2, 2, -2, 2}, "k must be positive"},
      {isotropic, {u, 2, 4, 0, 4}, "n must be greater than m, or equal with k >= l"},
      {isotropic, {u, 4, 4, 0, 4}, "n must be greater than m, or equal with k >= l"},
      {isotropic, {v, 2, 4, 2, -2}, "n must not be less than m"},
  };
  for (const Case& one : cases) {
    const Mode mode = one.mode;
    const Family family = one.family;
    const std::string expected = "mode " + to_string(mode) + " of the " + to_string(family) + " family: " + one.rule;
    EXPECT_EQ(refusal(mode, family), expected);
    EXPECT_EQ(message_of([&] { terms(mode, family); }), expected);
    EXPECT_EQ(message_of([&] { squared_norm(mode, family, 0, 0); }), expected);
    EXPECT_EQ(message_of([&] { blocks(family, std::vector{mode}); }), expected);
  }
}

TEST(Modes, WithIndicesAtTheEndOfIntegersAreRefused) {
  constexpr int lowest = std::numeric_limits<int>::min();
  EXPECT_NE(refusal({m22, 2, 2, lowest, 0}, Family::germer2017).find("|k| must not exceed n"), std::string::npos);
  EXPECT_NE(refusal({m12, 2, 2, 0, lowest}, Family::anisotropic).find("|l| must not exceed m"), std::string::npos);
  EXPECT_EQ(radial(2, lowest, 0.5), 0);
  EXPECT_EQ(zernike(2, lowest, {0.5, 0}), 0);
}

TEST(Modes, HaveTheOrderOfTheirLargerFactor) {
  EXPECT_EQ(orders(blocks(Family::germer2017, std::vector<Mode>{{m11, 2, 0, 0, 0}, {m12, 0, 4, 0, 2}})),
            (Orders{2, 4}));
}

// Of two ways to write one function, at most one is valid: else a model could hold it twice.
TEST(Modes, AreNotValidTogetherWithTheirTwins) {
  for (const Mode& mode : modes_of(Family::anisotropic, {4, 4}))
    if (const Mode twin{mode.function, mode.m, mode.n, mode.l, mode.k}; !(twin == mode))
      if (mode.function == m11 || mode.function == m22 || mode.function == m33 || mode.function == m44) {
        EXPECT_NE(refusal(twin, Family::anisotropic), "nothing was thrown") << to_string(twin);
        EXPECT_NE(refusal(twin, Family::germer2017), "nothing was thrown") << to_string(twin);
      }
  for (const Mode& mode : modes_of(Family::isotropic, {6, 6})) {
    // Z(r,i) of v enters conjugated, which turns the signs of k and l as well.
    const Mode twin = mode.function == v ? Mode{v, mode.m, mode.n, -mode.l, -mode.k}
                                         : Mode{mode.function, mode.m, mode.n, mode.l, mode.k};
    if (mode.function != u && mode.function != v) continue;
    EXPECT_EQ(refusal(twin, Family::isotropic) == "nothing was thrown", twin == mode) << to_string(twin);
  }
}

// ---- families -------------------------------------------------------------------------------------------------------

// The published sets alone hold at one azimuth, and are turned there unless they are taken as printed.
TEST(Families, AreTurnedWhereTheyHoldAtOneAzimuthAndNotAsPrinted) {
  for (const Family family : every_family) {
    EXPECT_EQ(turns(family, Rotation::covariant), family == Family::germer2017) << to_string(family);
    EXPECT_FALSE(turns(family, Rotation::as_printed)) << to_string(family);
    EXPECT_EQ(traits(family).minimum_norm, family == Family::germer2017) << to_string(family);
    EXPECT_EQ(traits(family).published_form, family != Family::anisotropic) << to_string(family);
  }
}

// ---- names ----------------------------------------------------------------------------------------------------------

TEST(Modes, AreNamedByFunctionAndIndices) {
  EXPECT_EQ(to_string(Mode{m22, 4, 2, 4, -2}), "22 (n, m, k, l) = (4, 2, 4, -2)");
  EXPECT_EQ(to_string(Mode{g, 2, 0, 2, 0}), "g (n, m, k, l) = (2, 0, 2, 0)");
}

TEST(Modes, NamesOfFamiliesRotationsFunctionsAndMappingsComeBack) {
  for (const Family family : every_family) EXPECT_EQ(family_from(to_string(family)), family);
  for (const Rotation rotation : {Rotation::covariant, Rotation::as_printed})
    EXPECT_EQ(rotation_from(to_string(rotation)), rotation);
  for (const Function function : every_function) EXPECT_EQ(function_from(to_string(function)), function);
  for (const DiscMapping mapping : {DiscMapping::lambert, DiscMapping::projected})
    EXPECT_EQ(disc_mapping_from(to_string(mapping)), mapping);
  EXPECT_EQ(to_string(Family::germer2017), "germer2017");
  EXPECT_EQ(to_string(Function::m13), "13");
  EXPECT_EQ(to_string(DiscMapping::projected), "projected");
}

TEST(Modes, NamesThatDoNotExistAreRefusedWithThoseThatDo) {
  EXPECT_EQ(message_of([] { family_from("Isotropic"); }),
            "basis 'Isotropic' is not one of isotropic, germer2017, anisotropic");
  EXPECT_EQ(message_of([] { rotation_from("printed"); }), "rotation 'printed' is not one of covariant, as_printed");
  EXPECT_EQ(message_of([] { function_from("21"); }),
            "function '21' is not one of 11, 12, 13, 14, 22, 23, 24, 33, 34, 44, g, h, u, v");
  EXPECT_EQ(message_of([] { disc_mapping_from(""); }), "mapping '' is not one of lambert, projected");
}
