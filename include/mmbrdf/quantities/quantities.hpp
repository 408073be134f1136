// SPDX-License-Identifier: BSD-3-Clause
/// Every number that is derived from a Mueller matrix, said once. Columns of files, keys of JSON, functions of Python
/// and the text of --help are made from this table; docs/formats.md shows it.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "mmbrdf/polarization/mueller.hpp"

namespace mmbrdf {

struct MatricesOptions;  // analysis_batch.hpp
struct Ratios;           // analysis.hpp

/// A quantity of a matrix M in the frame sp, in sr⁻¹ as a model has it, and of incident light where it takes some: its
/// Stokes vector in the same frame, in any unit. Both functions throw std::invalid_argument where the quantity has no
/// meaning, as a ratio where M11 is not positive.
struct Quantity {
  std::string_view name;     ///< "f_ss": of a column, a key and a function
  std::string_view unit;     ///< "sr^-1"; empty for a ratio
  std::string_view meaning;  ///< a line of words
  bool first_order;  ///< its uncertainty is that of first order, even where there are draws: it is linear in M, or an
                     ///< angle, of which draws have no order
  bool takes_light;
  Elements needs;  ///< elements that it is made of, with light of all four components
  double (*value)(const Mueller& m_sp, const Stokes& light_sp);
  Mueller (*gradient)(const Mueller& m_sp, const Stokes& light_sp);  ///< derivatives with respect to M_ij
  /// The values of many matrices, as analysis_batch.hpp gives them; null where there is no such function.
  std::size_t (*values)(std::span<const Mueller> m_sp, std::span<double> out, const MatricesOptions& options) = nullptr;
  double Ratios::*ratio = nullptr;  ///< the same among those that are worked out together
};

/// In the order of the columns: first those of a matrix alone, then, if asked for, those that take light.
std::span<const Quantity> quantities(bool with_light = true);

/// Whether a matrix tells it: all elements that it needs for this light were measured.
bool is_known(const Quantity& quantity, const Mueller& m_sp, const Stokes& light_sp);

/// Throws std::invalid_argument for a name that is not in the table.
const Quantity& quantity(std::string_view name);

}  // namespace mmbrdf
