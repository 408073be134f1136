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

FunctionTables::FunctionTables(int order, DiscMapping mapping, std::size_t most)
    : order_(order),
      mapping_(mapping),
      functions_(size(zernike_count(order))),
      most_(most),
      incident_(functions_ * most),
      reflected_(functions_ * most),
      one_(functions_) {}

void FunctionTables::set(std::size_t pair, const Geometry& geometry) {
  set(incident_, pair, geometry.incident);
  set(reflected_, pair, geometry.reflected);
}

void FunctionTables::set(std::vector<double>& table, std::size_t pair, const Direction& direction) {
  zernike_table(order_, disc_point(direction, mapping_), one_.data());
  for (std::size_t f = 0; f < functions_; ++f) table[f * most_ + pair] = one_[f];
}

}  // namespace mmbrdf
