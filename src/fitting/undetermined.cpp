// SPDX-License-Identifier: BSD-3-Clause
#include "fitting/undetermined.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "basis/rows.hpp"

namespace mmbrdf {
namespace {

constexpr double involved = 1e-6;      // least part of a free combination for which a mode is named
constexpr std::size_t most_named = 6;  // modes: the names of more say nothing

/// "11(7,7,5,-5)", and the power of the wavelength where there are several.
std::string short_name(const Block& block, std::size_t coefficient, std::size_t count) {
  const Mode& mode = block.modes[coefficient % block.modes.size()];
  std::string name = to_string(mode.function);
  char separator = '(';
  for (const int order : {mode.n, mode.m, mode.k, mode.l}) {
    name += separator;
    name += std::to_string(order);
    separator = ',';
  }
  name += ')';
  if (count > block.modes.size()) name.append("p").append(std::to_string(coefficient / block.modes.size()));
  return name;
}

}  // namespace

std::string undetermined(const Block& block, const Solution& solution) {
  const std::size_t n = solution.x.size(), free = n - static_cast<std::size_t>(solution.rank);
  if (free == 0) return "";
  const std::string rank =
      "; block " + block.name + ": rank " + std::to_string(solution.rank) + " of " + std::to_string(n);
  std::string names;
  std::size_t count = 0;
  for (std::size_t i = 0; i < n; ++i) {
    double part = 0;
    for (std::size_t f = 0; f < free; ++f) part = std::max(part, std::abs(solution.null_space[f * n + i]));
    if (part > involved && ++count <= most_named) names.append(" ").append(short_name(block, i, n));
  }
  return rank + (count > most_named ? "" : ", free are the modes (n,m,k,l)" + names);
}

bool determines(const Solution& solution, const Block& block, const Basis& basis, std::size_t element) {
  constexpr double limit = 1e-8;  // theory 4.7
  constexpr int directions = 50;  // more than a function of the block has zeros in common with others
  const std::size_t n = solution.x.size(), free = n - static_cast<std::size_t>(solution.rank),
                    modes = block.modes.size();
  if (free == 0) return true;
  const Rows rows(block.modes, basis.family);
  const int order = std::max(basis.orders.f11, basis.orders.other);
  for (const auto& [i, r] : random_geometries(directions, 1)) {
    std::vector<double> row(modes);
    rows.add(element, functions_at(i, order, basis.mapping), functions_at(r, order, basis.mapping), row.data());
    const double length = std::sqrt(std::inner_product(row.begin(), row.end(), row.begin(), 0.0));
    for (std::size_t first = 0; first < free * n; first += modes)  // of each combination the part of each power
      if (std::abs(std::inner_product(row.begin(), row.end(),
                                      solution.null_space.begin() + static_cast<std::ptrdiff_t>(first), 0.0)) >
          limit * length)
        return false;
  }
  return true;
}

}  // namespace mmbrdf
