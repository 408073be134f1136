// SPDX-License-Identifier: BSD-3-Clause
#include "fitting/undetermined.hpp"

#include <algorithm>
#include <cmath>

namespace mmbrdf {
namespace {

constexpr double involved = 1e-6;       // least part of a free combination for which a mode is named
constexpr std::size_t most_named = 24;  // modes in a message of one line

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

std::string undetermined(const Block& block, const Solution& solution, Sides sides) {
  const std::size_t n = solution.x.size(), free = n - static_cast<std::size_t>(solution.rank);
  if (free == 0) return "";
  const std::string rank =
      "; block " + block.name + ": rank " + std::to_string(solution.rank) + " of " + std::to_string(n);
  if (sides == plane_of_incidence) return rank;
  std::string names;
  std::size_t count = 0;
  for (std::size_t i = 0; i < n; ++i) {
    double part = 0;
    for (std::size_t f = 0; f < free; ++f) part = std::max(part, std::abs(solution.null_space[f * n + i]));
    if (part > involved && ++count <= most_named) names.append(" ").append(short_name(block, i, n));
  }
  if (count > most_named) names.append(" and ").append(std::to_string(count - most_named)).append(" more");
  return rank + ", " + std::to_string(free) + " combinations are free of the modes (n,m,k,l)" + names;
}

}  // namespace mmbrdf
