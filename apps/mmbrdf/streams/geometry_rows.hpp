// SPDX-License-Identifier: BSD-3-Clause
// Files of geometries, CSV or .npy, a piece at a time.
#pragma once

#include <functional>
#include <istream>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "mmbrdf/geometry/geometry.hpp"

namespace mmbrdf::program {

/// Bytes of a file that end with a row, and what they are.
struct Piece {
  std::string bytes;
  long before = 0;  ///< lines of the file, or rows, before it
};

struct Rows {
  std::vector<double> wavelengths;  ///< micrometres
  std::vector<Geometry> geometries;
  std::vector<long> numbers;  ///< of its line in a CSV file, else of the row, from 1

  std::string_view text(std::size_t row) const {
    const std::size_t begin = row == 0 ? 0 : text_ends[row - 1];
    return std::string_view(all_text).substr(begin, text_ends[row] - begin);
  }
  std::string all_text;  ///< the fields of the input, one row behind the other
  std::vector<std::size_t> text_ends;

  std::optional<std::runtime_error> error;  ///< of the row behind these, which cannot be read

  std::size_t size() const { return geometries.size(); }
};

/// A file that has been opened and whose header is read. All throw std::runtime_error naming file and line, or row.
struct GeometrySource {
  std::vector<std::string> columns;
  bool has_wavelengths = true;
  std::function<bool(Piece&)> next;        ///< false at the end
  std::function<Rows(const Piece&)> rows;  ///< in any thread; up to the first error
  std::function<std::runtime_error(long number, const std::string& text)> error;  ///< of a row; 0: of the file
};

/// `wavelength` is that of rows without one, in micrometres, if it is positive. Rows of a .npy file have their text
/// only if that is asked for. `in` must outlive the source.
GeometrySource open_geometries(std::istream& in, const std::string& name, double wavelength, bool with_text);

}  // namespace mmbrdf::program
