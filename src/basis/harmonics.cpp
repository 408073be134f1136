// SPDX-License-Identifier: BSD-3-Clause
#include "basis/harmonics.hpp"

#include <algorithm>
#include <cstdlib>
#include <tuple>

namespace mmbrdf {

int spin_sum(Function function) {
  if (function == Function::u) return 4;
  return function == Function::g || function == Function::h ? 2 : 0;
}

namespace {

/// All Z of a function with this k + l.
std::vector<Mode> products(Function function, int order, int sum) {
  std::vector<Mode> result;
  for (int n = 0; n <= order; ++n)
    for (int m = 0; m <= order; ++m)
      for (int k = -n; k <= n; k += 2)
        if (const int l = sum - k; std::abs(l) <= m && (m - l) % 2 == 0) result.push_back({function, n, m, k, l});
  return result;
}

auto radial_key(const Mode& z) { return std::tuple(z.n, z.m, z.k, z.l); }

/// The mode that has the same functions, or the mode itself: Z(r,i) of the real functions and of u, its conjugate of v.
Mode twin(const Mode& z) {
  switch (z.function) {
    case Function::m11:
    case Function::m44:
    case Function::u:
      return {z.function, z.m, z.n, z.l, z.k};
    case Function::v:
      return {z.function, z.m, z.n, -z.l, -z.k};
    default:
      return z;
  }
}

/// Whether cZ of the isotropic rule is mirror-odd and not 0.
bool is_odd(const Mode& z) {
  switch (z.function) {
    case Function::m11:
    case Function::m44:
      return z.k > 0 && z.n > z.m;
    case Function::m14:
      return z.k >= 0;
    case Function::v:
      return radial_key(z) > radial_key(twin(z));
    default:
      return radial_key(z) >= radial_key(twin(z));
  }
}

void add_harmonic(std::vector<FreeMode>& modes, Function function, int order, int q) {
  for (const Mode& z : products(function, order, spin_sum(function) + q)) {
    if (radial_key(z) < radial_key(twin(z))) continue;
    const bool real_alone = function == Function::v && z == twin(z);  // then iZ + conj(iZ) is 0
    for (const bool imaginary : {false, true})
      if (!imaginary || !real_alone)
        modes.push_back({FreeMode::Kind::harmonic, std::abs(q), z.n + z.m, complex_terms(z, imaginary)});
  }
}

bool is_complex(Function function) {
  return function != Function::m11 && function != Function::m44 && function != Function::m14;
}

}  // namespace

std::vector<FreeMode> free_modes(const Block& block, int order, int nonreciprocal_order) {
  std::vector<Function> functions;
  for (const Mode& mode : block.modes)
    if (std::ranges::find(functions, mode.function) == functions.end()) functions.push_back(mode.function);
  std::vector<FreeMode> result;
  for (int q = 1; q <= highest_harmonic; ++q)
    for (const Function function : functions) {
      add_harmonic(result, function, order, q);
      if (is_complex(function)) add_harmonic(result, function, order, -q);
    }
  for (const Function function : functions)
    for (const Mode& z : products(function, order, spin_sum(function)))
      if (is_odd(z)) result.push_back({FreeMode::Kind::odd, 0, z.n + z.m, complex_terms(z, true)});
  if (functions.front() == Function::m11)
    for (const Mode& z : products(Function::m11, nonreciprocal_order, 0))
      if (z.k >= 0 && z.n > z.m)
        result.push_back({FreeMode::Kind::nonreciprocal, 0, z.n + z.m, antisymmetric_terms(z)});
  return result;
}

}  // namespace mmbrdf
