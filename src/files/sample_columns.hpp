// SPDX-License-Identifier: BSD-3-Clause
// Which columns of a table are what of a sample, and what f11 is made of (docs/formats.md).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "mmbrdf/files/csv.hpp"
#include "mmbrdf/polarization/mueller.hpp"
#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf {

/// BRDFs of polarized light that together make elements.
struct Polarized;

/// f11, the divided elements or the BRDFs between linear polarizations, and their uncertainties.
class ElementColumns {
 public:
  /// Throws std::runtime_error for columns that are missing, contradict each other, or are like elements and none.
  explicit ElementColumns(const CsvReader& reader);

  /// f11 in sr⁻¹ and the divided elements of a row, and their uncertainties: of the sample, whose geometry is known.
  void read(const CsvReader& reader, Sample& sample) const;

  /// Whether no field of a row says NA or NaN, or is empty, but for elements that were not measured.
  bool complete(const CsvReader& reader) const;

  /// Whether f_ss … f_pp make the elements 11, 12, 21, 22, or f_s and f_p 11 and 12, which are those of s and p then.
  bool polarized() const { return !polarized_.empty(); }
  std::string polarized_names() const;  ///< of which: "f_ss ... f_pp"

  /// Positions of all columns that are read.
  std::vector<int> columns() const;

  /// How f11 is made of another quantity: "f11 = brf / pi". Empty: it is there.
  std::string f11_is() const;

 private:
  enum class F11 { f, brf, f_cos };

  void find_polarized(const CsvReader& reader);
  void find_polarized_uncertainties(const CsvReader& reader);
  void read_polarized(const CsvReader& reader, Sample& sample) const;

  F11 f11_ = F11::f;
  bool percent_ = false;  // f11
  int m11_ = -1;
  std::array<int, 16> elements_, uncertainties_;  // −1: none
  std::array<double, 16> scales_, uncertainty_scales_;
  const Polarized* made_of_ = nullptr;                    // what of
  std::vector<int> polarized_, polarized_uncertainties_;  // its columns; empty: none
};

}  // namespace mmbrdf
