// SPDX-License-Identifier: BSD-3-Clause
#include "basis/rows.hpp"

namespace mmbrdf {
namespace {

std::size_t size(int n) { return static_cast<std::size_t>(n); }

std::vector<std::vector<Term>> terms_of(const std::vector<Mode>& modes, Family family) {
  std::vector<std::vector<Term>> result;
  for (const Mode& mode : modes) result.push_back(terms(mode, family));
  return result;
}

}  // namespace

KTable functions_at(const Direction& direction, int order, DiscMapping mapping) {
  KTable table;
  zernike_table(order, disc_point(direction, mapping), table.data());
  return table;
}

KTable over_hemisphere(DiscMapping mapping) {
  KTable table{};
  for (const int n : {0, 2}) table[size(zernike_index(n, 0))] = projected_integral(n, mapping);
  return table;
}

Rows::Rows(const std::vector<Mode>& modes, Family family) : Rows(terms_of(modes, family)) {}

Rows::Rows(std::span<const std::vector<mmbrdf::Term>> columns) : columns_(columns.size()) {
  for (std::size_t q = 0; q < columns_; ++q)
    for (const mmbrdf::Term& t : columns[q])
      terms_[t.element()].push_back({q, size(t.incident), size(t.reflected), t.weight});
}

}  // namespace mmbrdf
