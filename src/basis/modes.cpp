// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/basis/modes.hpp"

#include "basis/harmonics.hpp"
#include "text/names.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace mmbrdf {
namespace {

constexpr Named<Function> function_names[] = {
    {Function::m11, "11"}, {Function::m12, "12"}, {Function::m13, "13"}, {Function::m14, "14"}, {Function::m22, "22"},
    {Function::m23, "23"}, {Function::m24, "24"}, {Function::m33, "33"}, {Function::m34, "34"}, {Function::m44, "44"},
    {Function::g, "g"},    {Function::h, "h"},    {Function::u, "u"},    {Function::v, "v"}};

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

Element element_of(Function function) {
  const std::string name = to_string(function);
  return {name[0] - '1', name[1] - '1'};
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
