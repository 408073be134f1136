// SPDX-License-Identifier: BSD-3-Clause
/// Where a term becomes a number: the rows of modes at pairs of directions, and over the hemisphere.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mmbrdf/basis/modes.hpp"

namespace mmbrdf {

/// One number for each K_n^k, at zernike_index(n, k): its value at a direction, or its integral.
using KTable = std::array<double, zernike_count(max_order)>;

/// K_n^k at a direction, n ≤ order.
KTable functions_at(const Direction& direction, int order, DiscMapping mapping);

/// ∫ K_n^k cos θ dΩ. In the place of K(reflected) it makes a row that of the directional-hemispherical integral.
KTable over_hemisphere(DiscMapping mapping);

/// Columns, each a function that gives terms to some elements: the modes of a block, say.
class Rows {
 public:
  struct Term {
    std::size_t column, incident, reflected;  // the last two as zernike_index
    double weight;
    friend bool operator==(const Term&, const Term&) = default;
  };

  Rows(const std::vector<Mode>& modes, Family family);
  explicit Rows(std::span<const std::vector<mmbrdf::Term>> columns);

  std::size_t columns() const { return columns_; }
  /// Of an element, 0 … 15 in row-major order.
  const std::vector<Term>& terms(std::size_t element) const { return terms_[element]; }

  /// Adds Σ weight K(incident) K(reflected) of each column to the row of an element.
  void add(std::size_t element, const KTable& incident, const KTable& reflected, double* row) const {
    add(terms_[element], {incident.data(), reflected.data(), 1, 1}, row, 1);
  }

  /// Tables of `count` pairs of directions: K_f of pair g is at [f × stride + g].
  struct Tables {
    const double *incident, *reflected;
    std::size_t stride, count;
  };
  /// The same at all of them: what pair g gives to column j is added to out[j × stride + g].
  static void add(std::span<const Term> terms, const Tables& tables, double* out, std::size_t stride) {
    for (const Term& t : terms) {
      double* const column = out + t.column * stride;
      const double *const k_i = tables.incident + t.incident * tables.stride, *const k_r = tables.reflected +
                                                                                           t.reflected * tables.stride;
      for (std::size_t g = 0; g < tables.count; ++g) column[g] += t.weight * k_i[g] * k_r[g];
    }
  }

 private:
  std::size_t columns_;
  std::array<std::vector<Term>, 16> terms_;
};

/// K at some pairs of directions; the values of each function stand side by side.
class FunctionTables {
 public:
  FunctionTables(int order, DiscMapping mapping, std::size_t most);
  void set(std::size_t pair, const Geometry& geometry);
  Rows::Tables of(std::size_t count) const { return {incident_.data(), reflected_.data(), most_, count}; }
  std::size_t most() const { return most_; }

 private:
  void set(std::vector<double>& table, std::size_t pair, const Direction& direction);

  int order_;
  DiscMapping mapping_;
  std::size_t functions_, most_;
  std::vector<double> incident_, reflected_, one_;
};

}  // namespace mmbrdf
